// These helpers check that a call throws the expected Error.
#pragma once

#include "common/system/error.h"

#include <ostream>
#include <string>
#include <utility>

namespace duet::test {

/// Returns the message of the Error that the call throws, prefixed with its exit code if that is not 2 ("exit code 1:
/// …"). Returns "no error" if the call throws none.
template <typename Call> std::string error_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.exit_code() == 2 ? error.what() : message("exit code ", error.exit_code(), ": ", error.what());
    }
    return "no error";
}

/// A failing CHECK(text == Containing("part")) prints both the text and the part.
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

/// Returns whether a message is a single line that contains the text.
inline bool says(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos && text.find('\n') == std::string::npos;
}

} // namespace duet::test
