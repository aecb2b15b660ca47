#include "compare/peers/subprocess.h"

#include "common/system/error.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char** environ;

namespace duet::compare {

namespace {

/// Holds the actions of the new process before it runs the program: the ends of the pipes become its standard streams.
class FileActions {
public:
    FileActions(int in, int out) {
        ::posix_spawn_file_actions_init(&actions_);
        ::posix_spawn_file_actions_adddup2(&actions_, in, STDIN_FILENO);
        ::posix_spawn_file_actions_adddup2(&actions_, out, STDOUT_FILENO);
        ::posix_spawn_file_actions_adddup2(&actions_, out, STDERR_FILENO);
    }
    ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }
    FileActions(const FileActions&) = delete;
    FileActions& operator=(const FileActions&) = delete;
    const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_{};
};

} // namespace

Subprocess::Subprocess(const std::vector<std::string>& command) {
    // The input is a socket instead of a pipe, because writing to a closed socket can be kept from raising SIGPIPE.
    std::array<int, 2> in{}, out{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in.data()) != 0 || ::pipe2(out.data(), O_CLOEXEC) != 0)
        throw Error(message(command.front(), ": cannot be started: ", std::strerror(errno)), 1);
    std::vector<char*> arguments;
    for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    const FileActions actions(in[1], out[1]);
    posix_spawnattr_t group{}; // its own process group, so that it ends together with the processes that it starts
    ::posix_spawnattr_init(&group);
    ::posix_spawnattr_setflags(&group, POSIX_SPAWN_SETPGROUP);
    const int error = ::posix_spawnp(&pid_, arguments[0], actions.get(), &group, arguments.data(), environ);
    ::posix_spawnattr_destroy(&group);
    ::close(in[1]);
    ::close(out[1]);
    to_ = in[0];
    from_ = out[0];
    if (error == 0) return;
    ::close(to_);
    ::close(from_);
    throw Error(message(command.front(), ": cannot be started (is it installed?): ", std::strerror(error)));
}

Subprocess::~Subprocess() {
    ::close(to_);
    ::close(from_);
    const auto ends = [&] {
        for (int i = 0; i < 200; ++i) {
            if (::waitpid(pid_, nullptr, WNOHANG) != 0) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    };
    // A shell such as xvfb-run clears up after the program that it runs, unless a signal ends the shell.
    if (!ends()) {
        ::kill(-pid_, SIGTERM);
        if (!ends()) ::kill(-pid_, SIGKILL), ::waitpid(pid_, nullptr, 0);
    }
    ::kill(-pid_, SIGTERM); // ends processes that the program left behind
}

bool is_installed(const std::string& program) {
    const char* const variable = std::getenv("PATH");
    std::string_view folders = variable != nullptr ? variable : "";
    while (!folders.empty()) {
        const std::string_view folder = folders.substr(0, folders.find(':'));
        folders.remove_prefix(std::min(folders.size(), folder.size() + 1));
        if (::access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
    }
    return false;
}

bool Subprocess::write_line(const std::string& line) {
    const std::string text = line + '\n';
    for (std::size_t at = 0; at < text.size();) {
        const ssize_t written = ::send(to_, text.data() + at, text.size() - at, MSG_NOSIGNAL);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        at += static_cast<std::size_t>(written);
    }
    return true;
}

Subprocess::Read Subprocess::read_line(std::chrono::milliseconds wait) {
    const auto deadline = std::chrono::steady_clock::now() + wait;
    for (;;) {
        const std::size_t end = buffer_.find('\n');
        if (end != std::string::npos) {
            Read read{Status::kLine, buffer_.substr(0, end)};
            buffer_.erase(0, end + 1);
            return read;
        }
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
        pollfd watched{from_, POLLIN, 0};
        const int ready = ::poll(&watched, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
        if (ready == 0) return {Status::kTimeout};
        if (ready < 0 && errno == EINTR) continue; // a signal does not shorten the wait
        std::array<char, 4096> bytes{};
        const ssize_t count = ::read(from_, bytes.data(), bytes.size());
        if (count <= 0) return {Status::kEnd};
        buffer_.append(bytes.data(), static_cast<std::size_t>(count));
    }
}

std::chrono::nanoseconds Subprocess::processor_time() const {
    clockid_t clock{};
    timespec time{};
    // A process that has ended has no clock, and takes no more time.
    if (::clock_getcpuclockid(pid_, &clock) == 0) ::clock_gettime(clock, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

} // namespace duet::compare
