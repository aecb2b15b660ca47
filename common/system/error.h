// This file defines how the project reports errors. Bad input throws an Error, which the programs print. A broken
// invariant fails a check, which prints a message (with both values of a comparison) and aborts.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace duet {

/// An Error reports bad input or a failed file operation. Its message names the file, the line or JSON path, what was
/// found and what was expected. A program that catches it exits with `exit_code`: 2 for unusable input, 1 for a failure
/// during its work.
class Error : public std::runtime_error {
public:
    explicit Error(const std::string& message, int exit_code = 2) : std::runtime_error(message), code_(exit_code) {}
    int exit_code() const { return code_; }

private:
    int code_;
};

/// Concatenates the printed forms of its arguments. Example: `message(path, ": row ", 3, " is empty")`.
template <typename... Parts> std::string message(const Parts&... parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

/// Prints the file, the line and the failed condition to stderr and aborts the program.
[[noreturn]] void check_failed(const char* file, int line, const std::string& what);

} // namespace duet

/// The DUET_CHECK macros test invariants and abort on failure. They are active in release builds, too, so do not use
/// them in inner loops.
#define DUET_CHECK(condition)                                                                                          \
    do {                                                                                                               \
        if (!(condition)) ::duet::check_failed(__FILE__, __LINE__, #condition);                                        \
    } while (false)
#define DUET_CHECK_BINARY_(a, op, b)                                                                                   \
    do {                                                                                                               \
        const auto& duet_a_ = (a);                                                                                     \
        const auto& duet_b_ = (b);                                                                                     \
        if (!(duet_a_ op duet_b_))                                                                                     \
            ::duet::check_failed(__FILE__, __LINE__,                                                                   \
                                 ::duet::message(#a " " #op " " #b ", with ", duet_a_, " and ", duet_b_));             \
    } while (false)
#define DUET_CHECK_EQ(a, b) DUET_CHECK_BINARY_(a, ==, b)
#define DUET_CHECK_LT(a, b) DUET_CHECK_BINARY_(a, <, b)
#define DUET_CHECK_LE(a, b) DUET_CHECK_BINARY_(a, <=, b)
