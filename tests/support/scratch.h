// This header provides a temporary folder for the files that a test writes.
#pragma once

#include "common/system/error.h"
#include "common/system/file.h"

#include <atomic>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace duet::test {

/// The folder starts empty, is shared with no other test, and is deleted with this object.
class ScratchFolder {
public:
    ScratchFolder() {
        static std::atomic<int> count{0};
        path_ = std::filesystem::temp_directory_path() / message("duet-test-", ::getpid(), "-", count++);
        std::filesystem::remove_all(path_); // left over from a killed process
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }
    /// Writes a file, creates its parent folders, and returns its path.
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        write_file(path_ / name, text);
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

} // namespace duet::test
