#include "tests/grading/sandbox.h"

#include <array>
#include <csignal>
#include <cstddef>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <vector>

namespace duet::grading {

namespace {

#if defined(__x86_64__)

/// The system calls of a static program that computes, reads and writes its pipes, and takes memory. Files can't be
/// opened, so what is not on this list and might matter to a student's code simply fails. A line holds calls of a kind.
// clang-format off
constexpr std::array kAllowed{
    SYS_read, SYS_write, SYS_writev, SYS_close, SYS_fstat, SYS_lseek,
    SYS_mmap, SYS_munmap, SYS_mremap, SYS_mprotect, SYS_madvise, SYS_brk,
    SYS_exit, SYS_exit_group, SYS_rt_sigreturn, SYS_rt_sigaction, SYS_rt_sigprocmask, SYS_sigaltstack,
    SYS_futex, SYS_sched_yield, SYS_sched_getaffinity, SYS_getpid, SYS_gettid,
    SYS_clock_gettime, SYS_gettimeofday, SYS_getrandom,
    SYS_arch_prctl, SYS_set_tid_address, SYS_set_robust_list, SYS_rseq,
};
// clang-format on

/// The filter: another architecture is ended at once, calls on the list are let through, all others fail with EPERM.
/// execve needs the tracer's consent (let_execute_once). tgkill, which abort() needs, reaches only the process itself:
/// the filter compares its first argument.
std::vector<sock_filter> filter_program(pid_t self) {
    std::vector<sock_filter> program{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AUDIT_ARCH_X86_64, 1, 0),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
    };
    const auto answer = [&](long number, unsigned action) {
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(number), 0, 1));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, action));
    };
    for (const auto number : kAllowed) answer(number, SECCOMP_RET_ALLOW);
    answer(SYS_execve, SECCOMP_RET_TRACE);
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(SYS_tgkill), 0, 3));
    program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[0])));
    answer(self, SECCOMP_RET_ALLOW);
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM));
    return program;
}

bool install_filter(pid_t self) {
    auto program = filter_program(self);
    const sock_fprog description{static_cast<unsigned short>(program.size()), program.data()};
    return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &description, 0, 0) == 0;
}

#else

bool install_filter(pid_t) { return false; } // the list above knows one architecture

#endif

void set_limit(int resource, rlim_t value) {
    const rlimit limit{value, value};
    ::setrlimit(static_cast<__rlimit_resource_t>(resource), &limit);
}

} // namespace

bool sandbox_available() {
    static const bool available = [] {
        const pid_t child = ::fork();
        if (child == 0)
            ::_exit(::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0 && install_filter(::getpid()) ? 0 : 1);
        int status = 1;
        return child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }();
    return available;
}

void run_sandboxed(const std::string& worker, const Limits& limits, int requests, int replies, int output) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    // The five descriptors are moved above all that are used, then down to their places.
    const int null = ::open("/dev/null", O_RDONLY);
    std::array<int, 5> sources{null, output, output, requests, replies};
    for (int& source : sources) source = ::fcntl(source, F_DUPFD, 64);
    for (int i = 0; i < 5; ++i) ::dup2(sources[static_cast<std::size_t>(i)], i);
    ::close_range(5, ~0u, 0);
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_FSIZE, 0); // pipes have no size
    set_limit(RLIMIT_CPU, static_cast<rlim_t>(limits.item_seconds) + 10);
    if (limits.sandbox) {
        set_limit(RLIMIT_AS, limits.memory_bytes);
        set_limit(RLIMIT_STACK, std::size_t{8} << 20);
        set_limit(RLIMIT_NPROC, 0); // holds without the filter, too, but not for root
    }
    std::array<char*, 2> arguments{const_cast<char*>(worker.c_str()), nullptr};
    std::array<char*, 1> environment{nullptr};
    if (limits.sandbox && sandbox_available()) {
        ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
        ::raise(SIGSTOP);
        if (!install_filter(::getpid())) ::_exit(126);
    }
    ::execve(worker.c_str(), arguments.data(), environment.data());
    ::_exit(127);
}

bool let_execute_once(pid_t child) {
    const auto stopped = [child] {
        int status = 0;
        while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
        }
        return WIFSTOPPED(status);
    };
    if (!stopped()) return false;
    const long options = PTRACE_O_TRACESECCOMP | PTRACE_O_TRACEEXEC | PTRACE_O_EXITKILL;
    ::ptrace(PTRACE_SETOPTIONS, child, nullptr, options);
    for (int i = 0; i < 2; ++i) { // it stops where the filter meets execve, and before the worker's first instruction
        ::ptrace(PTRACE_CONT, child, nullptr, nullptr);
        if (!stopped()) return false;
    }
    return ::ptrace(PTRACE_DETACH, child, nullptr, nullptr) == 0;
}

} // namespace duet::grading
