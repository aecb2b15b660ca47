// This file defines a lock that keeps two processes from working on one file.
#pragma once

#include <filesystem>

namespace duet {

/// A FileLock reserves a file for this process. It locks a file `PATH.lock` beside it, since the file itself may be
/// replaced by another. The operating system releases the lock of a process that is killed; its lock file stays and
/// does no harm.
class FileLock {
public:
    /// Throws Error if another process holds the file, and Error with exit code 1 if the lock file cannot be made.
    explicit FileLock(const std::filesystem::path& path);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    std::filesystem::path lock_path_;
    int file_ = -1;
};

} // namespace duet
