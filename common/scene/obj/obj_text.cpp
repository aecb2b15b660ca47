#include "common/scene/obj/obj_text.h"

#include "common/system/error.h"
#include "common/system/file.h"

#include <algorithm>
#include <cstring>

namespace duet {

ObjText::ObjText(const std::filesystem::path& path) : path_(path), file_(open_file(path)), block_(1 << 16) {}

void ObjText::rewind() {
    file_.clear();
    file_.seekg(0);
    setg(nullptr, nullptr, nullptr);
    backslash_ = carriage_ = false;
    continued_ = 0;
}

ObjText::int_type ObjText::underflow() {
    do {
        const bool at_start = file_.tellg() == 0;
        file_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
        if (file_.bad()) throw Error(path_.string() + ": cannot be read");
        const auto count = static_cast<std::size_t>(file_.gcount());
        if (count == 0 && !backslash_) return traits_type::eof();
        char* const end = block_.data() + count;
        if (std::memchr(block_.data(), '\0', count) != nullptr)
            throw Error(path_.string() + ": holds a NUL byte, expected text");
        if (at_start && count >= 3 && std::memcmp(block_.data(), "\xEF\xBB\xBF", 3) == 0)
            std::fill_n(block_.data(), 3, ' ');
        const bool plain = !backslash_ && !carriage_ && continued_ == 0 &&
                           std::memchr(block_.data(), '\\', count) == nullptr &&
                           std::memchr(block_.data(), '\r', count) == nullptr;
        if (plain) {
            setg(block_.data(), block_.data(), end);
        } else {
            join_lines(block_.data(), count);
            setg(text_.data(), text_.data(), text_.data() + text_.size());
        }
    } while (gptr() == egptr());
    return traits_type::to_int_type(*gptr());
}

/// Sets text_ to the text of the file's next bytes. At the end of the file, where `count` is 0, text_ is the file's
/// last byte: a backslash that no line follows.
void ObjText::join_lines(const char* bytes, std::size_t count) {
    text_.clear();
    if (count == 0) {
        text_ += '\\';
        backslash_ = false;
    }
    for (const char* c = bytes; c != bytes + count; ++c) {
        const bool second_half = carriage_ && *c == '\n';
        carriage_ = *c == '\r';
        if (second_half) continue;
        if (*c != '\n' && *c != '\r') {
            if (backslash_) text_ += '\\';
            backslash_ = *c == '\\';
            if (!backslash_) text_ += *c;
        } else if (backslash_) {
            text_ += ' ';
            ++continued_;
            backslash_ = false;
        } else {
            text_.append(1 + continued_, '\n');
            continued_ = 0;
        }
    }
}

std::string trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    return first == text.npos ? "" : std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

} // namespace duet
