// These functions prepare text that comes from a file, or is a file's name, for a terminal or a page.
#pragma once

#include <string>
#include <string_view>

namespace duet {

/// Returns the text with `\xNN` for each byte of a control character (ASCII and C1, which U+0080 to U+009F encode) and
/// for each byte that is not part of valid UTF-8. The result is one line.
std::string escaped(std::string_view text);

/// Returns the text in double quotes, cut to 60 bytes and escaped, so that any content of a file fits on one line of an
/// error message.
std::string quoted_text(std::string_view text);

/// Returns the text with the entities of HTML and SVG for &, < and ", so that it can be an element's or an attribute's.
std::string markup_escaped(std::string_view text);

/// Returns the text if it has at most `most` characters, and otherwise its start and its end with an ellipsis between
/// them, `most` characters in all. The text must be valid UTF-8; `most` must be at least 3.
std::string shortened(std::string_view text, std::size_t most);

} // namespace duet
