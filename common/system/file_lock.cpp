#include "common/system/file_lock.h"

#include "common/system/error.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace duet {

namespace {

/// Returns whether the path still names the open file. A process that ends removes its lock file, perhaps just after
/// another one opened it.
bool names(const std::string& path, int file) {
    struct stat of_path {}, of_file {};
    return ::stat(path.c_str(), &of_path) == 0 && ::fstat(file, &of_file) == 0 && of_path.st_ino == of_file.st_ino &&
           of_path.st_dev == of_file.st_dev;
}

/// Returns the path without symbolic links, so that two names of one file have one lock.
std::filesystem::path target(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path found = std::filesystem::weakly_canonical(path, error);
    return error ? path : found;
}

} // namespace

FileLock::FileLock(const std::filesystem::path& path) : lock_path_(target(path).string() + ".lock") {
    for (;;) {
        file_ = ::open(lock_path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file_ < 0)
            throw Error(message(lock_path_.string(), ": cannot be written: ", std::strerror(errno)), 1);
        if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
            const int error = errno;
            ::close(file_);
            if (error == EWOULDBLOCK)
                throw Error(message(path.string(), ": another process works on it; wait for its end, or name another "
                                                   "file"));
            throw Error(message(lock_path_.string(), ": cannot be locked: ", std::strerror(error)), 1);
        }
        if (names(lock_path_, file_)) return;
        ::close(file_);
    }
}

FileLock::~FileLock() {
    ::unlink(lock_path_.c_str()); // before the lock is released: afterwards it may be another process's
    ::close(file_);
}

} // namespace duet
