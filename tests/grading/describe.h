// Values as text for messages, and as numbers for comparisons.
#pragma once

#include "tests/grading/wire.h"

#include "common/image/rgb.h"
#include "common/vec/matrix.h"

#include <algorithm>
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

/// Returns the value's numbers, one after the other; of an optional that is empty, none.
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

/// Two that are not numbers, or equally infinite, count as near.
inline bool is_near(double a, double b, double tolerance) {
    return a == b || (std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= tolerance;
}
/// As many components, and each within the tolerance.
template <typename T> bool is_near(const T& a, const T& b, double tolerance) {
    std::vector<double> left, right;
    append_components(a, left), append_components(b, right);
    return std::equal(left.begin(), left.end(), right.begin(), right.end(),
                      [tolerance](double x, double y) { return is_near(x, y, tolerance); });
}

/// What can be said of the difference when no typical mistake explains it; may be empty.
std::string explain_components(const std::vector<double>& found, const std::vector<double>& expected, double tolerance);
template <typename T> std::string explain_difference(const T& found, const T& expected, double tolerance) {
    std::vector<double> left, right;
    append_components(found, left), append_components(expected, right);
    return explain_components(left, right, tolerance);
}

} // namespace duet::grading
