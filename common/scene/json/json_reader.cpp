#include "common/scene/json/json_reader.h"

#include "common/system/error.h"
#include "common/system/suggestion.h"

#include <algorithm>
#include <cstdio>

namespace duet {

namespace {

using Kind = JsonNode::Kind;

std::string number_text(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

std::string describe(const JsonNode& node) {
    switch (node.kind) {
    case Kind::kNull:
        return "null";
    case Kind::kBoolean:
        return node.boolean ? "true" : "false";
    case Kind::kNumber:
        return number_text(node.number);
    case Kind::kString:
        return "the string " + quoted_text(node.text);
    case Kind::kArray:
        return node.items.empty()       ? "an empty array"
               : node.items.size() == 1 ? "an array of 1 element"
                                        : message("an array of ", node.items.size(), " elements");
    case Kind::kObject:
        return "an object";
    }
    return "nothing";
}

std::string describe(JsonRange range) {
    if (range.low == kAnyNumber.low && range.high == kAnyNumber.high) return "between -1e18 and 1e18";
    const bool bounded = range.high < kAnyNumber.high;
    if (range.open_low) return message("above ", number_text(range.low), " and at most ", number_text(range.high));
    if (!bounded) return message("at least ", number_text(range.low), " and at most 1e18");
    return message("in [", number_text(range.low), ", ", number_text(range.high), "]");
}

bool is_identifier(std::string_view key) {
    return !key.empty() && key.size() <= 60 && std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

} // namespace

void JsonValue::fail(const std::string& what) const { throw Error(message(file_->string(), ": ", path_, ": ", what)); }

void JsonValue::expected(const std::string& what) const {
    fail(message("found ", describe(*node_), ", expected ", what));
}

double JsonValue::number(JsonRange range) const {
    if (!is(Kind::kNumber)) expected("a number");
    const double x = node_->number;
    // A positive number must also be positive when it is stored as float.
    const bool at_open_end = range.open_low && static_cast<float>(x) == static_cast<float>(range.low);
    if (!(x >= range.low && x <= range.high) || at_open_end) expected("a number " + describe(range));
    return x;
}

int JsonValue::integer(int low, int high) const {
    const double x = is(Kind::kNumber) ? node_->number : low - 1.0;
    if (!(x >= low && x <= high) || x != static_cast<double>(static_cast<int>(x)))
        expected(message("a whole number in [", low, ", ", high, "]"));
    return static_cast<int>(x);
}

bool JsonValue::boolean() const {
    if (!is(Kind::kBoolean)) expected("true or false");
    return node_->boolean;
}

const std::string& JsonValue::string() const {
    if (!is(Kind::kString)) expected("a string");
    if (node_->text.empty()) expected("a string that is not empty");
    return node_->text;
}

std::vector<double> JsonValue::numbers(std::size_t count, JsonRange range) const {
    if (!is(Kind::kArray) || node_->items.size() != count) expected(message("an array of ", count, " numbers"));
    std::vector<double> values;
    for (const JsonValue& element : elements()) values.push_back(element.number(range));
    return values;
}

Vec3d JsonValue::vec3(JsonRange range) const {
    const std::vector<double> v = numbers(3, range);
    return {v[0], v[1], v[2]};
}

Rgb JsonValue::rgb(JsonRange range) const {
    if (is(Kind::kNumber)) return Rgb(static_cast<float>(number(range)));
    if (!is(Kind::kArray) || node_->items.size() != 3) expected("a number or an array of 3 numbers");
    const Vec3d v = vec3(range);
    return Rgb(RgbT<double>(v.x, v.y, v.z));
}

std::size_t JsonValue::one_of(const std::vector<std::string_view>& names) const {
    const std::string& text = string();
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) expected("one of " + listed(names) + suggestion(text, names));
    return static_cast<std::size_t>(found - names.begin());
}

std::vector<JsonValue> JsonValue::elements() const {
    if (!is(Kind::kArray)) expected("an array");
    std::vector<JsonValue> list;
    list.reserve(node_->items.size());
    for (std::size_t i = 0; i < node_->items.size(); ++i)
        list.emplace_back(node_->items[i], *file_, message(path_, "[", i, "]"));
    return list;
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members() const {
    if (!is(Kind::kObject)) expected("an object");
    std::vector<std::pair<std::string, JsonValue>> list;
    list.reserve(node_->items.size());
    for (std::size_t i = 0; i < node_->items.size(); ++i) list.emplace_back(node_->keys[i], member(i));
    return list;
}

void JsonValue::check_keys(const JsonKeys& keys) const {
    if (!is(Kind::kObject)) expected("an object");
    std::vector<std::string_view> known = keys.required;
    known.insert(known.end(), keys.optional.begin(), keys.optional.end());
    for (const std::string& key : node_->keys)
        if (std::find(known.begin(), known.end(), key) == known.end())
            fail("unknown key " + quoted_text(key) + suggestion_or_list(key, known));
    for (const std::string_view key : keys.required) at(key);
}

JsonValue JsonValue::at(std::string_view key) const {
    if (!is(Kind::kObject)) expected("an object");
    const JsonNode* found = find(key);
    if (found == nullptr) fail(message("the key ", quoted_text(key), " is missing"));
    return member(static_cast<std::size_t>(found - node_->items.data()));
}

double JsonValue::number_or(std::string_view key, double fallback, JsonRange range) const {
    return has(key) ? at(key).number(range) : fallback;
}
bool JsonValue::boolean_or(std::string_view key, bool fallback) const {
    return has(key) ? at(key).boolean() : fallback;
}
Rgb JsonValue::rgb_or(std::string_view key, Rgb fallback, JsonRange range) const {
    return has(key) ? at(key).rgb(range) : fallback;
}

const JsonNode* JsonValue::find(std::string_view key) const {
    const auto found = std::find(node_->keys.begin(), node_->keys.end(), key);
    return found == node_->keys.end() ? nullptr : &node_->items[static_cast<std::size_t>(found - node_->keys.begin())];
}

JsonValue JsonValue::member(std::size_t index) const {
    const std::string& key = node_->keys[index];
    return {node_->items[index], *file_, is_identifier(key) ? path_ + "." + key : path_ + "[" + quoted_text(key) + "]"};
}

} // namespace duet
