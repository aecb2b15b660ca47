#include "common/system/escape.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>

namespace duet {

namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0u) == 0x80; }

/// Returns the length of the printable character at the start of the text, or 0 if it begins with a control character
/// or with bytes that are not valid UTF-8 (The Unicode Standard, table 3-7).
std::size_t printable_length(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
    std::uint32_t code = first & (0x7fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if (!continues(text[i])) return 0;
        code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3fu);
    }
    constexpr std::uint32_t kLeast[] = {0, 0, 0xa0, 0x800, 0x10000}; // U+0080 to U+009F are the C1 control characters
    const bool surrogate = code >= 0xd800 && code <= 0xdfff;
    return code >= kLeast[length] && code <= 0x10ffff && !surrogate ? length : 0;
}

} // namespace

std::string escaped(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t length = printable_length(text);
        if (length > 0) {
            out += text.substr(0, length);
        } else {
            char code[8];
            std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned char>(text[0]));
            out += code;
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return out;
}

std::string quoted_text(std::string_view text) {
    return '"' + escaped(text.substr(0, 60)) + (text.size() > 60 ? "…\"" : "\"");
}

std::string markup_escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

std::string shortened(std::string_view text, std::size_t most) {
    const auto starts = [](char c) { return !continues(c); };
    if (static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts)) <= most) return std::string(text);
    // The head ends before the first byte of character head + 1. The tail begins at the first byte of its first
    // character.
    const std::size_t head = (most - 1) / 2, tail = most - 1 - head;
    std::size_t begin = 0, end = text.size();
    for (std::size_t left = head + 1; left > 0; ++begin) left -= starts(text[begin]) ? 1 : 0;
    for (std::size_t left = tail; left > 0; --end) left -= starts(text[end - 1]) ? 1 : 0;
    return std::string(text.substr(0, begin - 1)) + "…" + std::string(text.substr(end));
}

} // namespace duet
