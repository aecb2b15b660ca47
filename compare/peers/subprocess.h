// This file declares a subprocess with a line-based text protocol.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace duet::compare {

/// Returns whether a program is in PATH.
bool is_installed(const std::string& program);

/// A Subprocess is a process that runs during the object's lifetime, with those that it starts. The destructor closes
/// its input, ends it after two seconds with SIGTERM, and after two more with SIGKILL.
class Subprocess {
public:
    /// Starts the program, which must be in PATH. Its standard error is merged into its standard output. Throws Error
    /// if the program cannot be started.
    explicit Subprocess(const std::vector<std::string>& command);
    ~Subprocess();
    Subprocess(const Subprocess&) = delete;
    Subprocess& operator=(const Subprocess&) = delete;

    /// Writes a line to the process's standard input. Returns false if the process no longer reads it.
    bool write_line(const std::string& line);

    enum class Status { kLine, kTimeout, kEnd };
    struct Read {
        Status status = Status::kEnd;
        std::string line{}; ///< without the line end
    };
    /// Reads the next line of output. The status is kTimeout if none came within `wait`, kEnd if no more will come.
    Read read_line(std::chrono::milliseconds wait);

    /// Returns the processor time of all threads of the process so far, without that of processes that it started.
    std::chrono::nanoseconds processor_time() const;

private:
    pid_t pid_ = -1;
    int to_ = -1, from_ = -1;
    std::string buffer_;
};

} // namespace duet::compare
