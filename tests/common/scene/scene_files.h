// Files for tests of readers: written to a folder of their own that goes with them.
#pragma once

#include "common/system/error.h"
#include "common/system/file.h"

#include <atomic>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace duet::test {

class ScratchFolder {
public:
    ScratchFolder() {
        static std::atomic<int> count{0};
        path_ = std::filesystem::temp_directory_path() / message("duet-scene-test-", ::getpid(), "-", count++);
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        write_file(path_ / name, text);
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

/// The message of the Error that the call throws; "no error" where it throws none.
template <typename Call> std::string error_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.exit_code() == 2 ? error.what() : message("exit code ", error.exit_code(), ": ", error.what());
    }
    return "no error";
}

/// Whether a message is one line that holds the text.
inline bool says(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos && text.find('\n') == std::string::npos;
}

} // namespace duet::test
