#include "common/scene/obj/obj_check.h"

#include "common/system/error.h"
#include "common/system/escape.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <istream>

namespace duet {

namespace {

/// Tokenizer splits a line at blanks and tabs, as tinyobjloader does.
class Tokenizer {
public:
    explicit Tokenizer(std::string_view line) : rest_(line) {}
    /// Returns the next word, or an empty one at the end of the line. The loops are written by hand, because
    /// find_first_of calls memchr for each byte.
    std::string_view next() {
        std::size_t begin = 0, end = 0;
        while (begin < rest_.size() && is_blank(rest_[begin])) ++begin;
        for (end = begin; end < rest_.size() && !is_blank(rest_[end]);) ++end;
        const std::string_view word = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return word;
    }
    std::string_view rest() const { return rest_; }

private:
    static bool is_blank(char c) { return c == ' ' || c == '\t'; }
    std::string_view rest_;
};

[[noreturn]] void fail(const std::filesystem::path& path, std::size_t line, const std::string& what) {
    throw Error(message(path.string(), ": line ", line, ": ", what));
}

void check_number(const std::filesystem::path& path, std::size_t line, std::string_view word) {
    if (word.empty()) fail(path, line, "ends too early, expected another number");
    const std::string_view digits = word.substr(word.starts_with('+') ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (end != digits.data() + digits.size() || error == std::errc::invalid_argument || std::isnan(value))
        fail(path, line, "found " + quoted_text(word) + ", expected a number");
    // from_chars also reports numbers too small for a double as out of range. tinyobjloader reads those as 0, and
    // they are accepted here.
    const bool tiny = error == std::errc::result_out_of_range &&
                      (digits.find("e-") != digits.npos || digits.find("E-") != digits.npos);
    if ((error == std::errc::result_out_of_range && !tiny) || !(std::abs(value) <= kMaxMeshNumber))
        fail(path, line, "found " + quoted_text(word) + ", expected a number between -1e18 and 1e18");
}

/// Checks that a line has at least `least` numbers. At most `most` numbers are checked; any others are ignored.
void check_numbers(const std::filesystem::path& path, std::size_t line, Tokenizer tokens, std::size_t least,
                   std::size_t most) {
    for (std::size_t i = 0; i < most; ++i) {
        const std::string_view word = tokens.next();
        if (word.empty() && i >= least) return;
        check_number(path, line, word);
    }
}

/// An IndexCheck compares the indices of face corners with the counts so far. It stores the largest index and
/// compares it with the final counts, because a positive index may refer to a later line.
class IndexCheck {
public:
    IndexCheck(const std::filesystem::path& path, const char* what) : path_(&path), what_(what) {}

    void add(std::string_view text, std::size_t count, std::size_t line) {
        std::int64_t index = 0;
        const std::string_view digits = text.substr(text.starts_with('+') ? 1 : 0);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        if (end != digits.data() + digits.size() || error == std::errc::invalid_argument)
            fail(*path_, line, "found " + quoted_text(text) + ", expected a " + what_ + " index");
        if (error == std::errc::result_out_of_range || index == 0 || index < -static_cast<std::int64_t>(count))
            refuse(text, count, line);
        if (index > largest_) {
            largest_ = index;
            line_ = line;
        }
    }
    void finish(std::size_t count) const {
        if (largest_ > static_cast<std::int64_t>(count)) refuse(std::to_string(largest_), count, line_);
    }

private:
    [[noreturn]] void refuse(std::string_view text, std::size_t count, std::size_t line) const {
        fail(*path_, line,
             message("the ", what_, " index ", text.substr(0, 30), " is out of range: there are ", count));
    }

    const std::filesystem::path* path_;
    const char* what_;
    std::int64_t largest_ = 0;
    std::size_t line_ = 0;
};

/// A FaceCheck checks f lines, such as "f 1 2 3", "f 1/1 …", "f 1//1 …" and "f 1/1/1 …".
class FaceCheck {
public:
    explicit FaceCheck(const std::filesystem::path& path)
        : path_(&path), index_{IndexCheck(path, "vertex"), IndexCheck(path, "texture coordinate"),
                               IndexCheck(path, "normal")} {}

    void line(Tokenizer tokens, std::size_t number, ObjCounts& counts) {
        std::size_t corners = 0;
        for (std::string_view word = tokens.next(); !word.empty(); word = tokens.next(), ++corners)
            corner(word, number, counts);
        if (corners < 3)
            fail(*path_, number,
                 message("a face of ", corners, corners == 1 ? " corner" : " corners", ", expected at least 3"));
        ++counts.faces;
        counts.corners += corners;
    }
    void finish(const ObjCounts& counts) const {
        index_[0].finish(counts.positions);
        index_[1].finish(counts.texture_coordinates);
        index_[2].finish(counts.normals);
    }

private:
    void corner(std::string_view word, std::size_t line, const ObjCounts& counts) {
        const std::array<std::size_t, 3> counts_so_far = {counts.positions, counts.texture_coordinates, counts.normals};
        std::string_view rest = word;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string_view token = rest.substr(0, rest.find('/'));
            if (!token.empty() || i == 0) index_[i].add(token, counts_so_far[i], line);
            if (token.size() == rest.size()) return;
            rest.remove_prefix(token.size() + 1);
        }
        fail(*path_, line, "found " + quoted_text(word) + ", expected at most three indices");
    }

    const std::filesystem::path* path_;
    std::array<IndexCheck, 3> index_;
};

} // namespace

ObjCounts check_obj(const std::filesystem::path& path, std::istream& text) {
    ObjCounts counts;
    FaceCheck faces(path);
    std::size_t number = 0;
    for (std::string line; std::getline(text, line);) {
        ++number;
        Tokenizer tokens(line);
        const std::string_view key = tokens.next();
        if (key == "v") {
            check_numbers(path, number, tokens, 3, 3);
            ++counts.positions;
        } else if (key == "vt") {
            check_numbers(path, number, tokens, 1, 2);
            ++counts.texture_coordinates;
        } else if (key == "vn") {
            check_numbers(path, number, tokens, 3, 3);
            ++counts.normals;
        } else if (key == "f") {
            faces.line(tokens, number, counts);
        } else if (key == "mtllib") {
            counts.material_files.emplace_back(tokens.rest());
        }
    }
    faces.finish(counts);
    if (counts.faces == 0) throw Error(path.string() + ": has no faces");
    return counts;
}

void check_mtl(const std::filesystem::path& path, std::istream& text) {
    std::size_t number = 0;
    for (std::string line; std::getline(text, line);) {
        ++number;
        Tokenizer tokens(line);
        const std::string_view key = tokens.next();
        // tinyobjloader does not read "Kd spectral FILE" and "Kd xyz X Y Z", so they are not accepted here.
        if (key == "Kd" || key == "Ks" || key == "Ke" || key == "Tf" || key == "Kt")
            check_numbers(path, number, tokens, 3, 3);
        else if (key == "Ns" || key == "Ni" || key == "d" || key == "Tr" || key == "Pr" || key == "Pm" ||
                 key == "Pc" || key == "Pcr" || key == "illum")
            check_numbers(path, number, tokens, 1, 1);
    }
}

} // namespace duet
