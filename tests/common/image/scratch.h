// A folder for the files a test writes, and the check that a call throws the Error that it should.
#pragma once

#include "common/system/error.h"
#include "common/system/file.h"

#include <filesystem>
#include <ostream>
#include <string>
#include <utility>

namespace duet::test {

#if defined(DUET_BINARY_DIR)
constexpr const char* kBinaryFolder = DUET_BINARY_DIR;
#else
constexpr const char* kBinaryFolder = "."; // where a header is compiled alone
#endif

/// A fresh folder under the build folder, of that name.
inline std::filesystem::path scratch_folder(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path(kBinaryFolder) / "tests/scratch" / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

/// The message of the Error that call() throws, after its exit code: "2: a.png: truncated …"; "no Error" where it
/// returns.
template <typename Call> std::string error_of(Call call) {
    try {
        call();
    } catch (const Error& error) {
        return message(error.exit_code(), ": ", error.what());
    }
    return "no Error";
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

} // namespace duet::test
