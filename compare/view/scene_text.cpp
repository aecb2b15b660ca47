#include "compare/view/scene_text.h"

#include "common/system/error.h"

#include <nlohmann/json.hpp>

namespace duet::compare {

using nlohmann::ordered_json;

namespace {

/// A Span is a part of the text, from its first character to the one after its last.
struct Span {
    std::size_t begin = 0, end = 0;
};

/// A Child is a member of an object or an element of an array.
struct Child {
    std::string key;
    Span whole, value; ///< `whole` includes the key
};

std::size_t skip_space(std::string_view text, std::size_t at) { return text.find_first_not_of(" \t\r\n", at); }

/// Returns the position after the string that begins at `at`.
std::size_t skip_string(std::string_view text, std::size_t at) {
    for (++at; text[at] != '"'; ++at)
        if (text[at] == '\\') ++at;
    return at + 1;
}

/// Returns the position after the value that begins at `at`.
std::size_t skip_value(std::string_view text, std::size_t at) {
    if (text[at] == '"') return skip_string(text, at);
    if (text[at] != '{' && text[at] != '[') return std::min(text.find_first_of(",]} \t\r\n", at), text.size());
    for (int depth = 0;;) {
        const char c = text[at];
        if (c == '"') {
            at = skip_string(text, at);
            continue;
        }
        if (c == '{' || c == '[') ++depth;
        if (c == '}' || c == ']') --depth;
        ++at;
        if (depth == 0) return at;
    }
}

/// Returns the members of an object or the elements of an array, and nothing for other values.
std::vector<Child> children(std::string_view text, Span parent) {
    std::vector<Child> found;
    const bool object = text[parent.begin] == '{';
    if (!object && text[parent.begin] != '[') return found;
    for (std::size_t at = skip_space(text, parent.begin + 1); at + 1 < parent.end;) {
        Child child{std::to_string(found.size()), {at, 0}, {at, 0}};
        if (object) {
            const std::size_t key_end = skip_string(text, at);
            child.key = ordered_json::parse(text.substr(at, key_end - at)).get<std::string>();
            child.value.begin = skip_space(text, text.find(':', key_end) + 1);
        }
        child.whole.end = child.value.end = skip_value(text, child.value.begin);
        at = skip_space(text, child.value.end);
        if (text[at] == ',') at = skip_space(text, at + 1);
        found.push_back(std::move(child));
    }
    return found;
}

std::string joined(const JsonPath& path) {
    std::string text;
    for (const std::string& key : path) text += "/" + key;
    return text;
}

Span root(std::string_view text) {
    const std::size_t begin = text.find_first_of("{["); // after a byte order mark, if there is one
    return {begin, skip_value(text, begin)};
}

const Child* child_of(const std::vector<Child>& all, const std::string& key) {
    for (const Child& child : all)
        if (child.key == key) return &child;
    return nullptr;
}

/// Returns the object or array that holds the value at the path.
Span parent_of(std::string_view text, const JsonPath& path) {
    if (path.empty()) throw Error("a path without keys: expected at least one");
    Span span = root(text);
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const std::vector<Child> all = children(text, span);
        const Child* child = child_of(all, path[i]);
        if (!child) throw Error(message("the scene file has no ", joined(path)));
        span = child->value;
    }
    return span;
}

std::string replaced(std::string_view text, Span span, std::string_view with) {
    return std::string(text.substr(0, span.begin)).append(with).append(text.substr(span.end));
}

} // namespace

std::string_view value_text(std::string_view text, const JsonPath& path) {
    const std::vector<Child> all = children(text, parent_of(text, path));
    const Child* child = child_of(all, path.back());
    if (!child) throw Error(message("the scene file has no ", joined(path)));
    return text.substr(child->value.begin, child->value.end - child->value.begin);
}

std::string with_value(std::string_view text, const JsonPath& path, const ordered_json& value) {
    const Span parent = parent_of(text, path);
    const std::vector<Child> all = children(text, parent);
    if (const Child* child = child_of(all, path.back())) return replaced(text, child->value, typed_json(value));
    const bool object = text[parent.begin] == '{';
    if (!object && text[parent.begin] != '[') throw Error(message("nothing can be added at ", joined(path)));
    const std::string member = object ? ordered_json(path.back()).dump() + ": " + typed_json(value) : typed_json(value);
    if (all.empty()) return replaced(text, {parent.begin + 1, parent.end - 1}, member);
    // The new child is separated as the last one is: on a line of its own, or not.
    const std::size_t before = all.size() > 1 ? text.find(',', all[all.size() - 2].whole.end) : parent.begin;
    std::string gap(text.substr(before + 1, all.back().whole.begin - before - 1));
    if (all.size() == 1 && gap.empty()) gap = " "; // the gap after a bracket differs from the one after a comma
    const std::size_t end = all.back().whole.end;
    return replaced(text, {end, end}, message(",", gap, member));
}

std::string without_value(std::string_view text, const JsonPath& path) {
    const std::vector<Child> all = children(text, parent_of(text, path));
    const Child* child = child_of(all, path.back());
    if (!child) throw Error(message("the scene file has no ", joined(path)));
    const auto i = static_cast<std::size_t>(child - all.data());
    if (i > 0) return replaced(text, {all[i - 1].whole.end, child->whole.end}, "");
    return replaced(text, {child->whole.begin, i + 1 < all.size() ? all[i + 1].whole.begin : child->whole.end}, "");
}

std::string typed_json(const ordered_json& value) {
    if (!value.is_structured()) return value.dump();
    std::string text;
    for (const auto& [key, child] : value.items()) {
        if (!text.empty()) text += ", ";
        if (value.is_object()) text += ordered_json(key).dump() + ": ";
        text += typed_json(child);
    }
    return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

} // namespace duet::compare
