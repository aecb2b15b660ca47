// A JSON file read with suspicion: every access names the path of the value it dislikes, what it found and what it
// expected.
#pragma once

#include "common/image/rgb.h"

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace duet {

/// A parsed value. Members of an object keep the order of the file; a key occurs once.
struct JsonNode {
    enum class Kind { kNull, kBoolean, kNumber, kString, kArray, kObject };

    Kind kind = Kind::kNull;
    bool boolean = false;
    double number = 0; ///< finite
    std::string text{};
    std::vector<JsonNode> items{};   ///< of an array, or of an object
    std::vector<std::string> keys{}; ///< of an object, parallel to items
};

/// Parses a JSON text. Throws Error with line and column for a syntax error, a number too large for a double, a key
/// given twice in one object, and values nested more than kMaxJsonDepth deep (the text comes from anywhere; recursion
/// must not).
JsonNode parse_json(const std::filesystem::path& file, std::string_view text);
inline constexpr std::size_t kMaxJsonDepth = 256;

/// Closed interval of the numbers allowed; `open_low` leaves out the lower end. Everything is stored as float in the
/// end, whose squares must not overflow: no number of a scene is beyond 1e18.
struct JsonRange {
    double low = -1e18, high = 1e18;
    bool open_low = false;
};
inline constexpr JsonRange kAnyNumber{};
inline constexpr JsonRange kPositive{0, 1e18, true};
inline constexpr JsonRange kNotNegative{0, 1e18, false};
inline constexpr JsonRange kUnit{0, 1, false};
/// Radiance, intensity and irradiance: sums and squares of many stay far from overflow.
inline constexpr JsonRange kLightRange{0, 1e12, false};

/// The keys an object of some kind may have: the readers and the test of scene.schema.json share the list.
struct JsonKeys {
    std::string_view kind; ///< "camera", "quad" …: the name of its definition in the schema
    std::vector<std::string_view> required, optional;
};

/// A value and where it stands. Cheap to copy; refers to the node and to the file's name, which must outlive it.
class JsonValue {
public:
    JsonValue(const JsonNode& node, const std::filesystem::path& file, std::string path = "$")
        : node_(&node), file_(&file), path_(std::move(path)) {}

    const JsonNode& node() const { return *node_; }
    const std::filesystem::path& file() const { return *file_; }
    const std::string& path() const { return path_; }
    /// Throws Error "FILE: PATH: what".
    [[noreturn]] void fail(const std::string& what) const;
    /// Throws Error "FILE: PATH: found …, expected `what`".
    [[noreturn]] void expected(const std::string& what) const;

    bool is(JsonNode::Kind kind) const { return node_->kind == kind; }

    double number(JsonRange range = kAnyNumber) const;
    int integer(int low, int high) const;
    bool boolean() const;
    const std::string& string() const; ///< not empty
    /// An array of `count` numbers.
    std::vector<double> numbers(std::size_t count, JsonRange range = kAnyNumber) const;
    Vec3d vec3(JsonRange range = kAnyNumber) const;
    /// A number (grey) or three.
    Rgb rgb(JsonRange range = kUnit) const;
    /// One of the names; its index.
    std::size_t one_of(const std::vector<std::string_view>& names) const;

    /// The elements of an array.
    std::vector<JsonValue> elements() const;
    /// The members of an object whose keys are names given by the user; not for objects with fixed keys.
    std::vector<std::pair<std::string, JsonValue>> members() const;

    /// Refuses anything but an object with these keys; suggests the nearest one for a key that is not known.
    void check_keys(const JsonKeys& keys) const;
    bool has(std::string_view key) const { return find(key) != nullptr; }
    /// A member; Error where there is none.
    JsonValue at(std::string_view key) const;
    double number_or(std::string_view key, double fallback, JsonRange range = kAnyNumber) const;
    bool boolean_or(std::string_view key, bool fallback) const;
    Rgb rgb_or(std::string_view key, Rgb fallback, JsonRange range = kUnit) const;

private:
    const JsonNode* find(std::string_view key) const;
    JsonValue member(std::size_t index) const;

    const JsonNode* node_;
    const std::filesystem::path* file_;
    std::string path_;
};

/// The text in double quotes, cut to 60 bytes, with control characters and bytes that are not ASCII-printable or UTF-8
/// letters escaped: fit for one line of an error message, whatever a file held.
std::string in_quotes(std::string_view text);
/// ", did you mean "X"?" for the known name nearest to `name`, or nothing where none is near.
std::string suggestion(std::string_view name, const std::vector<std::string_view>& known);

} // namespace duet
