// One worker: a child process with a student's code, and the calls that are made in it.
#pragma once

#include "tests/grading/channel.h"

#include <ctime>
#include <string>
#include <sys/types.h>

namespace duet::grading {

/// A call that brought no answer: what happened, in a sentence for the student.
struct CallFailed {
    std::string text;
};

/// What a worker may use.
struct Limits {
    double seconds = 2;       ///< of processor time for each call; by the clock five times that
    double item_seconds = 60; ///< of processor time for all calls of an item; by the clock five times that
    std::size_t memory_bytes = std::size_t{1} << 30; ///< address space; of trusted workers ignored
    bool sandbox = true; ///< off for the repository's own answers, which are linked with its libraries
};

/// Starts the worker with the first call. Not copyable: it owns a process and its pipes.
class Session {
public:
    Session(std::string worker, Limits limits) : worker_(std::move(worker)), limits_(limits) {}
    ~Session() { stop(); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Returns the bytes of the function's result. Throws CallFailed where the worker ended, hung, threw or answered
    /// nonsense; then it is gone, and the next call starts another.
    std::string call(const char* function, const std::string& request);
    void limit(double seconds) { limits_.seconds = seconds; }
    /// The processor time of the last call: unlike a clock on the wall it doesn't count what else the computer does.
    double last_seconds() const { return last_seconds_; }
    /// The functions, called since the start, that said not_attempted().
    const std::vector<std::string>& not_attempted() const { return not_attempted_; }
    /// What the student's code printed, at most 8 KiB.
    std::string printed();

private:
    void start();
    void stop();
    std::string exchange(const std::string& request);
    std::string read_reply();
    void add_call_time();
    std::string describe_exit();
    double processor_seconds() const;
    void wait_for(int descriptor, short events);
    void take_printed();

    std::string worker_;
    Limits limits_;
    pid_t child_ = -1;
    clockid_t clock_{}; ///< the worker's processor time
    int requests_ = -1, replies_ = -1, output_ = -1;
    bool sandboxed_ = false;
    std::vector<std::string> not_attempted_;
    std::string printed_;
    double call_began_ = 0, call_began_at_ = 0; ///< processor time of the worker, and time on the wall
    double last_seconds_ = 0, item_seconds_ = 0, item_wall_seconds_ = 0;
};

/// The session of the item that runs.
Session& session();
void set_session(Session* session);

} // namespace duet::grading
