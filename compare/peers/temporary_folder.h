// This file defines a temporary folder.
#pragma once

#include "common/system/error.h"

#include <filesystem>
#include <stdlib.h>
#include <string>

namespace duet::compare {

/// A TemporaryFolder is a folder that is deleted with the object, unless keep() is called.
class TemporaryFolder {
public:
    /// Makes a folder whose name begins with `prefix`. Throws Error if that is impossible.
    explicit TemporaryFolder(const std::string& prefix) {
        std::string name = (std::filesystem::temp_directory_path() / (prefix + "-XXXXXX")).string();
        if (::mkdtemp(name.data()) == nullptr) throw Error(message(name, ": cannot be made"), 1);
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        if (!kept_) std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    void keep() { kept_ = true; }

private:
    std::filesystem::path path_;
    bool kept_ = false;
};

} // namespace duet::compare
