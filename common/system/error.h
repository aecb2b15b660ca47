// How the project reports trouble: bad input is an Error (an exception the programs print), a broken invariant is a
// failed check (a message with both values, then abort).
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace duet {

/// Bad input or a failed file operation. The message names the file, line or JSON path, what was found and what was
/// expected. `exit_code` is what a program returns for it: 2 for unusable input, 1 for a failure while working.
class Error : public std::runtime_error {
public:
    explicit Error(const std::string& message, int exit_code = 2) : std::runtime_error(message), code_(exit_code) {}
    int exit_code() const { return code_; }

private:
    int code_;
};

/// The parts printed one after the other: `message(path, ": row ", 3, " is empty")`.
template <typename... Parts> std::string message(const Parts&... parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

[[noreturn]] void check_failed(const char* file, int line, const std::string& what);

} // namespace duet

/// Invariants: always on, also in release builds; they stand outside inner loops.
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
