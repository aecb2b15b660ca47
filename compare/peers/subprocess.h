// Another program that is spoken to line by line.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace duet::compare {

/// Runs while it lives; ended by its destructor (SIGTERM, after two seconds SIGKILL).
class Subprocess {
public:
    /// Starts the program, found in PATH; its standard error is joined to its standard output. Throws Error where it
    /// cannot be started.
    explicit Subprocess(const std::vector<std::string>& command);
    ~Subprocess();
    Subprocess(const Subprocess&) = delete;
    Subprocess& operator=(const Subprocess&) = delete;

    /// A line to its standard input. False where it no longer listens.
    bool write_line(const std::string& line);

    enum class Status { kLine, kTimeout, kEnd };
    struct Read {
        Status status = Status::kEnd;
        std::string line{}; ///< without its end
    };
    /// The next line it wrote; kTimeout where none came within `wait`, kEnd where none will come.
    Read read_line(std::chrono::milliseconds wait);

private:
    pid_t pid_ = -1;
    int to_ = -1, from_ = -1;
    std::string buffer_;
};

} // namespace duet::compare
