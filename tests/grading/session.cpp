#include "tests/grading/session.h"

#include "common/system/error.h"
#include "tests/grading/sandbox.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>

namespace duet::grading {

namespace {

constexpr std::size_t kMaxPrinted = 8192;
constexpr int kPollMilliseconds = 20; ///< how often the worker's processor time is looked at
constexpr double kWallFactor = 5;     ///< a worker that waits for nothing uses no processor time
Session* g_session = nullptr;

/// Thrown inside where the worker is gone or late.
struct WorkerLost {
    bool late;
};

double wall_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void close_if_open(int& descriptor) {
    if (descriptor >= 0) ::close(descriptor);
    descriptor = -1;
}

std::string describe_signal(int signal) {
    switch (signal) {
    case SIGSEGV:
    case SIGBUS:
        return "crashed (segmentation fault): an index out of range, a null pointer, or endless recursion?";
    case SIGABRT:
        return "aborted: a failed assertion, or an exception where none is allowed.";
    case SIGFPE:
        return "crashed: a whole number was divided by zero.";
    case SIGILL:
    case SIGTRAP:
        return "crashed (illegal instruction): does the function end without a return?";
    case SIGKILL:
        return "was ended by the computer: it used too much memory or processor time.";
    case SIGXCPU:
        return "used more processor time than is allowed: an endless loop?";
    case SIGXFSZ:
        return "tried to write a file, which a submission may not.";
    case SIGSYS:
        return "asked the system for something that a submission may not do.";
    default:
        return message("was ended by signal ", signal, " (", ::strsignal(signal), ").");
    }
}

} // namespace

Session& session() { return *g_session; }
void set_session(Session* session) { g_session = session; }

void Session::start() {
    sandboxed_ = limits_.sandbox && sandbox_available();
    int requests[2], replies[2], output[2];
    if (::pipe2(requests, O_CLOEXEC) != 0 || ::pipe2(replies, O_CLOEXEC) != 0 || ::pipe2(output, O_CLOEXEC) != 0)
        throw Error(message("the grader can't make a pipe: ", std::strerror(errno)), 1);
    child_ = ::fork();
    if (child_ < 0) throw Error(message("the grader can't start a process: ", std::strerror(errno)), 1);
    if (child_ == 0) run_sandboxed(worker_, limits_, requests[0], replies[1], output[1]);
    ::close(requests[0]), ::close(replies[1]), ::close(output[1]);
    requests_ = requests[1], replies_ = replies[0], output_ = output[0];
    for (const int descriptor : {requests_, replies_, output_}) ::fcntl(descriptor, F_SETFL, O_NONBLOCK);
    if (sandboxed_ && !let_execute_once(child_)) {
        child_ = -1;
        throw Error("the grader can't start the program of the submission: " + worker_, 1);
    }
    if (::clock_getcpuclockid(child_, &clock_) != 0) throw Error("the grader can't read the worker's clock", 1);
    call_began_ = processor_seconds();
}

void Session::stop() {
    if (child_ > 0) {
        ::kill(-child_, SIGKILL);
        ::kill(child_, SIGKILL);
        ::waitpid(child_, nullptr, 0);
    }
    child_ = -1;
    take_printed();
    close_if_open(requests_), close_if_open(replies_), close_if_open(output_);
}

/// 0 where the worker has ended.
double Session::processor_seconds() const {
    timespec time{};
    if (::clock_gettime(clock_, &time) != 0) return 0;
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Takes what the student's code has printed, so that it never blocks, and drops what is too much.
void Session::take_printed() {
    char buffer[4096];
    for (ssize_t got = 0; output_ >= 0 && (got = ::read(output_, buffer, sizeof buffer)) != 0;) {
        if (got < 0) return; // nothing there now
        printed_.append(buffer, std::min(static_cast<std::size_t>(got), kMaxPrinted - printed_.size()));
        if (wall_seconds() - call_began_at_ > kWallFactor * limits_.seconds) return; // it prints without end
    }
    close_if_open(output_);
}

/// Waits until the descriptor is ready.
void Session::wait_for(int descriptor, short events) {
    for (;;) {
        pollfd fds[2] = {{descriptor, events, 0}, {output_, POLLIN, 0}};
        if (::poll(fds, output_ >= 0 ? 2 : 1, kPollMilliseconds) < 0 && errno != EINTR) throw WorkerLost{false};
        if (output_ >= 0 && fds[1].revents) take_printed();
        if (fds[0].revents & (events | POLLHUP | POLLERR)) return;
        if (processor_seconds() - call_began_ > limits_.seconds) throw WorkerLost{true};
        if (wall_seconds() - call_began_at_ > kWallFactor * limits_.seconds) throw WorkerLost{true};
    }
}

std::string Session::exchange(const std::string& request) {
    const std::string bytes = with_length_prefix(request);
    for (std::size_t sent = 0; sent < bytes.size();) {
        const ssize_t written = ::write(requests_, bytes.data() + sent, bytes.size() - sent);
        if (written > 0)
            sent += static_cast<std::size_t>(written);
        else if (written < 0 && errno == EAGAIN)
            wait_for(requests_, POLLOUT);
        else if (!(written < 0 && errno == EINTR))
            throw WorkerLost{false};
    }
    return read_reply();
}

/// Reads as much at a time as there is: a lab makes many thousands of small calls.
std::string Session::read_reply() {
    std::string bytes;
    std::size_t size = 0;
    char buffer[1 << 16];
    do {
        wait_for(replies_, POLLIN);
        const ssize_t got = ::read(replies_, buffer, sizeof buffer);
        if (got < 0 && (errno == EAGAIN || errno == EINTR)) continue;
        if (got <= 0) throw WorkerLost{false};
        bytes.append(buffer, static_cast<std::size_t>(got));
        if (bytes.size() < sizeof size) continue;
        std::memcpy(&size, bytes.data(), sizeof size);
        if (size > kMaxMessage) throw WireError(message("it claims to be larger than ", kMaxMessage >> 20, " MiB"));
    } while (bytes.size() < sizeof size + size);
    if (bytes.size() > sizeof size + size) throw WireError("there is more than one answer");
    return bytes.substr(sizeof size);
}

/// What became of a worker whose pipes are closed.
std::string Session::describe_exit() {
    int status = 0;
    const double deadline = wall_seconds() + 0.5;
    pid_t ended = 0;
    while ((ended = ::waitpid(child_, &status, WNOHANG)) == 0 && wall_seconds() < deadline) ::usleep(2000);
    if (ended != child_) return "closed its connection to the grader and went on running.";
    child_ = -1;
    if (!WIFEXITED(status)) return describe_signal(WTERMSIG(status));
    return message("ended the program by itself (exit code ", WEXITSTATUS(status),
                   "): a function must return its result.");
}

/// Adds up the time of the call that ended. The next one counts from here, so that what a worker does between two calls
/// is counted, too.
void Session::add_call_time() {
    const double now = processor_seconds();
    last_seconds_ = now - call_began_;
    call_began_ = now;
    item_seconds_ += last_seconds_;
    item_wall_seconds_ += wall_seconds() - call_began_at_;
}

std::string Session::call(const char* function, const std::string& request) {
    if (child_ < 0) start();
    call_began_at_ = wall_seconds();
    try {
        const std::string reply = exchange(request);
        add_call_time();
        const double most = std::max(limits_.item_seconds, 3 * limits_.seconds);
        if (item_seconds_ > most || item_wall_seconds_ > kWallFactor * most)
            throw CallFailed{
                message(function, " is far too slow: the calls of this item took more than ", most, " s together.")};
        Reader in(reply);
        const auto outcome = in.get<Outcome>();
        if (in.get<bool>() && std::count(not_attempted_.begin(), not_attempted_.end(), function) == 0)
            not_attempted_.emplace_back(function);
        const auto text = in.get<std::string>();
        if (outcome == Outcome::kReturned) return text;
        if (outcome == Outcome::kOutOfMemory)
            throw CallFailed{message(function, " requested more memory than the ", limits_.memory_bytes >> 20,
                                     " MiB that it may have.")};
        throw CallFailed{message(function, " threw an exception: ", text)};
    } catch (const WorkerLost& silence) {
        const std::string text =
            silence.late ? message("gave no answer within ", limits_.seconds, " s: an endless loop, or far too slow.")
                         : describe_exit();
        stop();
        throw CallFailed{message(function, " ", text)};
    } catch (const WireError& error) {
        stop();
        throw CallFailed{message(function, " gave a malformed answer: ", error.what(), ".")};
    }
}

std::string Session::printed() {
    take_printed();
    return printed_;
}

} // namespace duet::grading
