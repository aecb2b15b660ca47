// This file reads JSON values with validation. Each error names the JSON path, what was found and what was expected.
#pragma once

#include "common/image/rgb.h"
#include "common/system/escape.h"

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace duet {

/// A JsonNode is a parsed value. Members of an object keep the order of the file, and keys are unique.
struct JsonNode {
    enum class Kind { kNull, kBoolean, kNumber, kString, kArray, kObject };

    Kind kind = Kind::kNull;
    bool boolean = false;
    double number = 0; ///< value of a number, finite
    std::string text{};
    std::vector<JsonNode> items{};   ///< elements of an array, or member values of an object
    std::vector<std::string> keys{}; ///< member keys of an object, parallel to items
};

/// Parses a JSON text. Throws Error with line and column for a syntax error or a number too large for a double, and
/// with a description for a key that occurs twice in one object and for values nested deeper than kMaxJsonDepth. The
/// depth is limited because the input is untrusted and recursion must not overflow the stack.
JsonNode parse_json(const std::filesystem::path& file, std::string_view text);
inline constexpr std::size_t kMaxJsonDepth = 256;

/// A JsonRange is a closed interval of allowed numbers; `open_low` excludes the lower end. All numbers are finally
/// stored as float, and their squares must not overflow, so no number of a scene may exceed 1e18.
struct JsonRange {
    double low = -1e18, high = 1e18;
    bool open_low = false;
};
inline constexpr JsonRange kAnyNumber{};
inline constexpr JsonRange kPositive{0, 1e18, true};
inline constexpr JsonRange kNotNegative{0, 1e18, false};
inline constexpr JsonRange kUnit{0, 1, false};
/// Radiance, intensity and irradiance have this range, so that sums and squares of many values stay far from
/// overflow.
inline constexpr JsonRange kLightRange{0, 1e12, false};

/// JsonKeys lists the keys that a kind of object may have. The readers and the test of scene.schema.json share the
/// list.
struct JsonKeys {
    std::string_view kind; ///< name of the definition in the schema, for example "camera" or "quad"
    std::vector<std::string_view> required, optional;
};

/// A JsonValue is a value together with its JSON path. It is cheap to copy. It refers to the node and to the file's
/// name, which must outlive it.
class JsonValue {
public:
    JsonValue(const JsonNode& node, const std::filesystem::path& file, std::string path = "$")
        : node_(&node), file_(&file), path_(std::move(path)) {}

    const JsonNode& node() const { return *node_; }
    const std::filesystem::path& file() const { return *file_; }
    const std::string& path() const { return path_; }
    /// Throws Error with the message "FILE: PATH: what".
    [[noreturn]] void fail(const std::string& what) const;
    /// Throws Error with the message "FILE: PATH: found …, expected `what`".
    [[noreturn]] void expected(const std::string& what) const;

    bool is(JsonNode::Kind kind) const { return node_->kind == kind; }

    /// Returns a number. Throws Error if the value is none, or outside of the range.
    double number(JsonRange range = kAnyNumber) const;
    /// Returns a whole number in [low, high]. Throws Error for anything else.
    int integer(int low, int high) const;
    bool boolean() const;
    const std::string& string() const; ///< throws Error for an empty string
    /// Returns an array of exactly `count` numbers.
    std::vector<double> numbers(std::size_t count, JsonRange range = kAnyNumber) const;
    /// Returns an array of exactly three numbers of the range as a vector.
    Vec3d vec3(JsonRange range = kAnyNumber) const;
    /// Returns a color given as one number (gray) or as three.
    Rgb rgb(JsonRange range = kUnit) const;
    /// Returns the index in `names` of a string that must be one of them.
    std::size_t one_of(const std::vector<std::string_view>& names) const;

    /// Returns the elements of an array.
    std::vector<JsonValue> elements() const;
    /// Returns the members of an object whose keys are chosen by the user. Objects with fixed keys use check_keys and
    /// at.
    std::vector<std::pair<std::string, JsonValue>> members() const;

    /// Throws Error unless the value is an object with the required keys and no unknown ones. For an unknown key the
    /// message suggests the nearest known one.
    void check_keys(const JsonKeys& keys) const;
    bool has(std::string_view key) const { return find(key) != nullptr; }
    /// Returns a member. Throws Error where there is none.
    JsonValue at(std::string_view key) const;
    /// Returns the member `key` as number() does, or the fallback where there is none.
    double number_or(std::string_view key, double fallback, JsonRange range = kAnyNumber) const;
    /// Returns the member `key` as boolean() does, or the fallback where there is none.
    bool boolean_or(std::string_view key, bool fallback) const;
    /// Returns the member `key` as rgb() does, or the fallback where there is none.
    Rgb rgb_or(std::string_view key, Rgb fallback, JsonRange range = kUnit) const;

private:
    const JsonNode* find(std::string_view key) const;
    JsonValue member(std::size_t index) const;

    const JsonNode* node_;
    const std::filesystem::path* file_;
    std::string path_;
};

} // namespace duet
