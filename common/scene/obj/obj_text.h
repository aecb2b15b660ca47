// This file reads the text of OBJ and MTL files in blocks, so that a file of any size needs little memory.
#pragma once

#include <filesystem>
#include <fstream>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

namespace duet {

/// An ObjText is the buffer of a stream that delivers the text of a file as tinyobjloader needs it. Every line ends
/// with \n. Lines that a backslash continues are joined, which tinyobjloader does not support: the backslash becomes a
/// blank, and an empty line after the joined line preserves the line numbers. A byte order mark becomes blanks, because
/// it would hide the first line's key.
///
/// Reading throws Error where the file cannot be read, or holds a NUL byte, which is not text. A std::istream rethrows
/// this Error only if exceptions(std::ios::badbit) has been called.
class ObjText : public std::streambuf {
public:
    /// Opens a file of at most 4 GiB. Throws Error.
    explicit ObjText(const std::filesystem::path& path);
    /// Continues at the start of the file.
    void rewind();

private:
    int_type underflow() override;
    void join_lines(const char* bytes, std::size_t count);

    std::filesystem::path path_;
    std::ifstream file_;
    std::vector<char> block_; ///< bytes of the file
    std::string text_;        ///< text of the block where it differs from its bytes
    bool backslash_ = false;  ///< whether the last byte was a backslash that may continue its line
    bool carriage_ = false;   ///< whether the last byte was a carriage return, which a line end may follow
    std::size_t continued_ = 0; ///< number of lines joined into the current one
};

/// Returns the text without blanks and tabs at its ends.
std::string trimmed(std::string_view text);

} // namespace duet
