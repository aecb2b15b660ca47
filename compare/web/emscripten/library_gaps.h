// Emscripten 3.1, which Debian 12 has, comes with libc++ 13. This file is included first in every file of its build
// (-include) and adds the few names of C++20's library that Duet uses and libc++ 13 lacks.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <memory>
#include <string>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000

namespace std {

template <typename To, typename From> constexpr To bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}

template <typename T> unique_ptr<T> make_unique_for_overwrite() { return unique_ptr<T>(new T); }
template <typename T> enable_if_t<is_array_v<T>, unique_ptr<T>> make_unique_for_overwrite(size_t size) {
    return unique_ptr<T>(new remove_extent_t<T>[size]);
}

/// Replaces std::atomic_ref. Without threads, every access is atomic.
template <typename T> class atomic_ref {
public:
    explicit atomic_ref(T& value) : value_(value) {}
    void store(T value, memory_order) const { value_ = value; }

private:
    T& value_;
};

/// Reads a number as std::from_chars does: no space, no plus sign, no hexadecimal digits.
template <typename Number>
enable_if_t<is_floating_point_v<Number>, from_chars_result> from_chars(const char* first, const char* last,
                                                                       Number& value) {
    const string text(first, find_if(first, last, [](char c) {
                          return string_view("0123456789+-.eEinfatyINFATY").find(c) == string_view::npos;
                      }));
    char* end = nullptr;
    errno = 0;
    double number = 0;
    if (!text.empty() && text[0] != '+')
        number = is_same_v<Number, float> ? strtof(text.c_str(), &end) : strtod(text.c_str(), &end);
    if (end == nullptr || end == text.c_str()) return {first, errc::invalid_argument};
    const char* const next = first + (end - text.c_str());
    if (errno == ERANGE) return {next, errc::result_out_of_range};
    value = static_cast<Number>(number);
    return {next, errc()};
}

namespace ranges {

template <typename Range, typename Is> constexpr bool any_of(const Range& range, Is is) {
    return std::any_of(begin(range), end(range), is);
}
template <typename Range, typename Is> constexpr bool all_of(const Range& range, Is is) {
    return std::all_of(begin(range), end(range), is);
}
template <typename Range, typename Is> constexpr bool none_of(const Range& range, Is is) {
    return std::none_of(begin(range), end(range), is);
}
template <typename Range, typename T> constexpr auto count(const Range& range, const T& value) {
    return std::count(begin(range), end(range), value);
}
template <typename Range, typename Is> constexpr auto count_if(const Range& range, Is is) {
    return std::count_if(begin(range), end(range), is);
}
template <typename Range, typename Is> constexpr auto find_if_not(const Range& range, Is is) {
    return std::find_if_not(begin(range), end(range), is);
}
template <typename Range, typename Value, typename Less = std::less<>, typename Projection = identity>
constexpr auto lower_bound(const Range& range, const Value& value, Less less = {}, Projection projection = {}) {
    return std::lower_bound(begin(range), end(range), value,
                            [&](const auto& x, const Value& v) { return invoke(less, invoke(projection, x), v); });
}
template <typename Range, typename Value, typename Less = std::less<>, typename Projection = identity>
constexpr auto upper_bound(const Range& range, const Value& value, Less less = {}, Projection projection = {}) {
    return std::upper_bound(begin(range), end(range), value,
                            [&](const Value& v, const auto& x) { return invoke(less, v, invoke(projection, x)); });
}
template <typename Range, typename T> constexpr bool binary_search(const Range& range, const T& value) {
    return std::binary_search(begin(range), end(range), value);
}
template <typename Range, typename Value, typename Projection = identity>
constexpr auto find(Range&& range, const Value& value, Projection projection = {}) {
    return std::find_if(begin(range), end(range), [&](const auto& x) { return invoke(projection, x) == value; });
}
template <typename Range, typename Less = std::less<>, typename Projection = identity>
constexpr auto max_element(Range&& range, Less less = {}, Projection projection = {}) {
    return std::max_element(begin(range), end(range), [&](const auto& a, const auto& b) {
        return invoke(less, invoke(projection, a), invoke(projection, b));
    });
}
template <typename Range, typename Less = std::less<>, typename Projection = identity>
void sort(Range&& range, Less less = {}, Projection projection = {}) {
    std::sort(begin(range), end(range),
              [&](const auto& a, const auto& b) { return invoke(less, invoke(projection, a), invoke(projection, b)); });
}
template <typename Range, typename Less = std::less<>, typename Projection = identity>
void stable_sort(Range&& range, Less less = {}, Projection projection = {}) {
    std::stable_sort(begin(range), end(range), [&](const auto& a, const auto& b) {
        return invoke(less, invoke(projection, a), invoke(projection, b));
    });
}
template <typename A, typename B> bool equal(const A& a, const B& b) {
    return std::equal(begin(a), end(a), begin(b), end(b));
}

} // namespace ranges
} // namespace std

#endif
