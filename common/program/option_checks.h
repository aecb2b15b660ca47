// Which numbers options take, in words that a user understands: CLI11's own checks spell out the largest double, and let NaN and
// the wrapped value of a negative seed pass.
#pragma once

#include <CLI/CLI.hpp>

#include <cmath>
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
/// Of an unsigned option: what is no number its conversion refuses.
inline CLI::Validator no_minus() {
    return {[](std::string& text) -> std::string {
                if (!text.starts_with('-')) return {};
                return "found " + text + ", expected a whole number of at least 0";
            },
            ""};
}

} // namespace duet
