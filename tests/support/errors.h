// Checks that a call throws the Error that it should.
#pragma once

#include "common/system/error.h"

#include <ostream>
#include <string>
#include <utility>

namespace duet::test {

/// The message of the Error that the call throws, after its exit code where that is not 2 («exit code 1: …»); "no error"
/// where it throws none.
template <typename Call> std::string error_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.exit_code() == 2 ? error.what() : message("exit code ", error.exit_code(), ": ", error.what());
    }
    return "no error";
}

/// CHECK(text == Containing("part")) prints both where it fails.
struct Containing {
    explicit Containing(std::string part_) : part(std::move(part_)) {}
    std::string part;
    friend bool operator==(const std::string& text, const Containing& wanted) {
        return text.find(wanted.part) != std::string::npos;
    }
    friend std::ostream& operator<<(std::ostream& out, const Containing& wanted) {
        return out << "… " << wanted.part << " …";
    }
};

/// Whether a message is one line that holds the text.
inline bool says(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos && text.find('\n') == std::string::npos;
}

} // namespace duet::test
