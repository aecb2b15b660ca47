// Which numbers options take, in words that a user understands: CLI11's own checks spell out the largest double, and let NaN and
// the wrapped value of a negative seed pass.
#pragma once

#include <CLI/CLI.hpp>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace duet {

/// A finite number that accepts() takes; `expected` says which those are.
template <typename Accepts> CLI::Validator number_check(const char* name, const char* expected, const Accepts& accepts) {
    return {[=](std::string& text) -> std::string {
                char* end = nullptr;
                const double value = std::strtod(text.c_str(), &end);
                if (end != text.c_str() && *end == '\0' && std::isfinite(value) && accepts(value)) return {};
                return "found " + text + ", expected " + expected;
            },
            name};
}

inline CLI::Validator positive_number() {
    return number_check("POSITIVE", "a finite number above 0", [](double x) { return x > 0; });
}
inline CLI::Validator nonnegative_number() {
    return number_check("NONNEGATIVE", "a finite number of at least 0", [](double x) { return x >= 0; });
}
/// From `low` to `high`; `expected` says so.
inline CLI::Validator number_within(double low, double high, const char* expected) {
    return number_check("", expected, [=](double x) { return x >= low && x <= high; });
}
/// Decimal digits alone: what conversion to an unsigned number would skip, wrap or cut off is refused.
inline CLI::Validator whole_number() {
    return {[](std::string& text) -> std::string {
                std::uint64_t value = 0;
                const char *const begin = text.data(), *const end = begin + text.size();
                if (const auto [rest, error] = std::from_chars(begin, end, value); error == std::errc() && rest == end) return {};
                return "found " + text + ", expected a whole number from 0 to 2^64 - 1";
            },
            ""};
}

} // namespace duet
