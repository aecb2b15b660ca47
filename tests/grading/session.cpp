#include "tests/grading/session.h"

#include "common/system/error.h"
#include "tests/grading/sandbox.h"

#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>

namespace duet::grading {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostPrinted = 8192;
Session* g_session = nullptr;

/// Thrown inside where the worker is gone or late.
struct Silence {
    bool late;
};

/// Waits until the descriptor is ready; while waiting takes what the student's code prints, so that it never blocks.
void wait_for(int descriptor, short events, int output, std::string& printed, Clock::time_point deadline) {
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        if (left <= 0) throw Silence{true};
        pollfd fds[2] = {{descriptor, events, 0}, {output, POLLIN, 0}};
        if (::poll(fds, output >= 0 ? 2 : 1, static_cast<int>(left)) < 0 && errno != EINTR) throw Silence{false};
        if (output >= 0 && fds[1].revents) {
            char buffer[4096];
            const ssize_t got = ::read(output, buffer, sizeof buffer);
            if (got > 0 && printed.size() < kMostPrinted)
                printed.append(buffer, std::min(static_cast<std::size_t>(got), kMostPrinted - printed.size()));
            else if (got == 0 && !(fds[0].revents))
                output = -1; // closed; poll would report it again and again
        }
        if (fds[0].revents & (events | POLLHUP | POLLERR)) return;
    }
}

void close_if_open(int& descriptor) {
    if (descriptor >= 0) ::close(descriptor);
    descriptor = -1;
}

} // namespace

Session& session() { return *g_session; }
void set_session(Session* session) { g_session = session; }

void Session::start() {
    int requests[2], replies[2], output[2];
    if (::pipe2(requests, O_CLOEXEC) != 0 || ::pipe2(replies, O_CLOEXEC) != 0 || ::pipe2(output, O_CLOEXEC) != 0)
        throw Error(message("the grader can't make a pipe: ", std::strerror(errno)), 1);
    child_ = ::fork();
    if (child_ < 0) throw Error(message("the grader can't start a process: ", std::strerror(errno)), 1);
    if (child_ == 0) run_sandboxed(worker_, limits_, requests[0], replies[1], output[1]);
    ::close(requests[0]), ::close(replies[1]), ::close(output[1]);
    requests_ = requests[1], replies_ = replies[0], output_ = output[0];
    ::fcntl(requests_, F_SETFL, O_NONBLOCK);
    ::fcntl(replies_, F_SETFL, O_NONBLOCK);
    ::fcntl(output_, F_SETFL, O_NONBLOCK);
    guarded_ = limits_.sandbox && sandbox_available();
}

void Session::stop() {
    if (child_ > 0) {
        ::kill(-child_, SIGKILL);
        ::kill(child_, SIGKILL);
        ::waitpid(child_, nullptr, 0);
    }
    child_ = -1;
    close_if_open(requests_), close_if_open(replies_), close_if_open(output_);
}

std::string Session::exchange(const std::string& request) {
    const auto deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits_.seconds));
    const auto write_all = [&](const char* bytes, std::size_t size) {
        while (size > 0) {
            wait_for(requests_, POLLOUT, output_, printed_, deadline);
            const ssize_t written = ::write(requests_, bytes, size);
            if (written < 0 && (errno == EAGAIN || errno == EINTR)) continue;
            if (written <= 0) throw Silence{false};
            bytes += written, size -= static_cast<std::size_t>(written);
        }
    };
    const auto read_all = [&](char* bytes, std::size_t size) {
        while (size > 0) {
            wait_for(replies_, POLLIN, output_, printed_, deadline);
            const ssize_t got = ::read(replies_, bytes, size);
            if (got < 0 && (errno == EAGAIN || errno == EINTR)) continue;
            if (got <= 0) throw Silence{false};
            bytes += got, size -= static_cast<std::size_t>(got);
        }
    };
    std::uint64_t size = request.size();
    write_all(reinterpret_cast<const char*>(&size), sizeof size);
    write_all(request.data(), request.size());
    read_all(reinterpret_cast<char*>(&size), sizeof size);
    if (size > kMaxMessage) throw CallFailed{"The answer is malformed: it claims to be larger than 256 MiB."};
    std::string reply(size, '\0');
    read_all(reply.data(), reply.size());
    return reply;
}

/// What became of a worker whose pipes are closed.
std::string Session::how_it_ended() {
    int status = 0;
    const auto deadline = Clock::now() + std::chrono::milliseconds(500);
    pid_t ended = 0;
    while ((ended = ::waitpid(child_, &status, WNOHANG)) == 0 && Clock::now() < deadline) ::usleep(2000);
    if (ended != child_) return "closed its connection to the grader and went on running.";
    child_ = -1;
    if (WIFEXITED(status))
        return message("ended the program (exit code ", WEXITSTATUS(status), "): a function must return its result.");
    switch (const int signal = WTERMSIG(status)) {
    case SIGSEGV:
        return "crashed (segmentation fault): an index out of range, a null pointer, or endless recursion?";
    case SIGABRT:
        return "aborted: a failed assertion, or an exception where none is allowed.";
    case SIGFPE:
        return "crashed (a division of a whole number by zero).";
    case SIGXCPU:
        return "used more processor time than is allowed: an endless loop?";
    case SIGSYS:
        return "asked the system for something that a submission may not do.";
    default:
        return message("was ended by signal ", signal, " (", ::strsignal(signal), ").");
    }
}

std::string Session::call(const char* function, const std::string& request) {
    if (child_ < 0) start();
    try {
        const std::string reply = exchange(request);
        Reader in(reply);
        const auto outcome = in.get<Outcome>();
        not_attempted_ = in.get<bool>() || not_attempted_;
        const auto text = in.get<std::string>();
        if (outcome == Outcome::kReturned) return text;
        if (outcome == Outcome::kOutOfMemory)
            throw CallFailed{message(function, " asked for more memory than the ", limits_.memory_bytes >> 20,
                                     " MiB that it may have.")};
        throw CallFailed{message(function, " threw an exception: ", text)};
    } catch (const Silence& silence) {
        const std::string text =
            silence.late ? message("gave no answer within ", limits_.seconds, " s: an endless loop, or far too slow.")
                         : how_it_ended();
        stop();
        throw CallFailed{message(function, " ", text)};
    } catch (const WireError& error) {
        stop();
        throw CallFailed{message(function, " gave a malformed answer: ", error.what(), ".")};
    }
}

std::string Session::printed() {
    if (output_ >= 0) {
        char buffer[4096];
        for (ssize_t got = 0; printed_.size() < kMostPrinted && (got = ::read(output_, buffer, sizeof buffer)) > 0;)
            printed_.append(buffer, static_cast<std::size_t>(got));
    }
    if (printed_.size() > kMostPrinted) printed_.resize(kMostPrinted);
    return printed_;
}

} // namespace duet::grading
