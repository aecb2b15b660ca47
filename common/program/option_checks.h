// This file defines validators for numeric options, with messages that a user understands. CLI11's own checks print
// the largest double as a bound, and accept NaN and the wrapped value of a negative seed.
#pragma once

#include <CLI/CLI.hpp>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace duet {

/// Returns a validator for finite numbers for which accepts() is true. `expected` describes those numbers in the
/// message.
template <typename Accepts>
CLI::Validator number_validator(const char* name, const char* expected, const Accepts& accepts) {
    return {[=](std::string& text) -> std::string {
                char* end = nullptr;
                const double value = std::strtod(text.c_str(), &end);
                if (end != text.c_str() && *end == '\0' && std::isfinite(value) && accepts(value)) return {};
                return "found " + text + ", expected " + expected;
            },
            name};
}

inline CLI::Validator positive_number() {
    return number_validator("POSITIVE", "a finite number above 0", [](double x) { return x > 0; });
}
inline CLI::Validator nonnegative_number() {
    return number_validator("NONNEGATIVE", "a finite number of at least 0", [](double x) { return x >= 0; });
}
/// Returns a validator for finite numbers from `low` to `high`. `expected` describes the range in the message.
inline CLI::Validator number_in_range(double low, double high, const char* expected) {
    return number_validator("", expected, [=](double x) { return x >= low && x <= high; });
}
/// Returns a validator for whole numbers from 0 to 2^64 − 1. It accepts decimal digits only, and refuses text that
/// a conversion to unsigned would skip, wrap or truncate.
inline CLI::Validator unsigned_integer() {
    return {[](std::string& text) -> std::string {
                std::uint64_t value = 0;
                const char *const begin = text.data(), *const end = begin + text.size();
                if (const auto [rest, error] = std::from_chars(begin, end, value); error == std::errc() && rest == end)
                    return {};
                return "found " + text + ", expected a whole number from 0 to 2^64 - 1";
            },
            ""};
}

} // namespace duet
