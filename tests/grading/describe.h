// Values as text for messages, and as numbers for comparisons.
#pragma once

#include "tests/grading/wire.h"

#include "common/image/rgb.h"
#include "common/vec/matrix.h"

#include <cmath>
#include <sstream>

namespace duet::grading {

/// A number with as many digits as tell it from its neighbors in what a student looks at.
inline std::string describe_number(double value) {
    std::ostringstream out;
    out.precision(7);
    out << value;
    return out.str();
}

/// The value's numbers, one after the other; of an optional that is empty, none.
template <typename T> void append_components(const T& value, std::vector<double>& out) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
        out.push_back(static_cast<double>(value));
    } else if constexpr (detail::kIsOptional<T>) {
        if (value) append_components(*value, out);
    } else if constexpr (detail::kIsVector<T> || detail::kIsArray<T>) {
        for (const auto& element : value) append_components(element, out);
    } else if constexpr (requires { value.m[0][0]; }) {
        for (const auto& row : value.m) append_components(row, out);
    } else if constexpr (requires { value.x; }) {
        out.push_back(static_cast<double>(value.x)), out.push_back(static_cast<double>(value.y));
        if constexpr (requires { value.z; }) out.push_back(static_cast<double>(value.z));
        if constexpr (requires { value.w; }) out.push_back(static_cast<double>(value.w));
    } else if constexpr (requires { value.r; }) {
        for (const auto channel : {value.r, value.g, value.b}) out.push_back(static_cast<double>(channel));
    } else {
        detail::for_each_member(value, [&out](const auto& member) { append_components(member, out); });
    }
}

/// "3.5", "(1, 2, 3)", "nothing", "\"text\"", a list's first elements.
template <typename T> std::string describe(const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
        return value ? "true" : "false";
    } else if constexpr (std::is_same_v<T, std::string>) {
        return '"' + (value.size() > 400 ? value.substr(0, 400) + " …" : value) + '"';
    } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
        return describe_number(static_cast<double>(value));
    } else if constexpr (detail::kIsOptional<T>) {
        return value ? describe(*value) : "nothing";
    } else if constexpr (detail::kIsVector<T> || detail::kIsArray<T>) {
        std::string text = "[";
        for (std::size_t i = 0; i < value.size() && i < 12; ++i) text += (i ? ", " : "") + describe(value[i]);
        return text + (value.size() > 12 ? message(", … ", value.size(), " in all]") : "]");
    } else {
        std::vector<double> components;
        append_components(value, components);
        std::string text = "(";
        for (std::size_t i = 0; i < components.size(); ++i) text += (i ? ", " : "") + describe_number(components[i]);
        return text + ")";
    }
}

/// As many components, and each within the tolerance; two that are not numbers, or equally infinite, count as near.
template <typename T> bool is_near(const T& a, const T& b, double tolerance) {
    std::vector<double> left, right;
    append_components(a, left), append_components(b, right);
    if (left.size() != right.size()) return false;
    for (std::size_t i = 0; i < left.size(); ++i) {
        const bool same = left[i] == right[i] || (std::isnan(left[i]) && std::isnan(right[i]));
        if (!same && !(std::abs(left[i] - right[i]) <= tolerance)) return false;
    }
    return true;
}

} // namespace duet::grading
