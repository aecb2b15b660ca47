#include "tests/grading/sandbox.h"

#include <array>
#include <csignal>
#include <cstddef>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <vector>

namespace duet::grading {

namespace {

/// The system calls of a static program that computes, reads and writes its pipes, and takes memory. execve is among
/// them since the filter stands before the worker itself is loaded; a program that it could run would have the same
/// filter. Files can't be opened, so what is not on this list and might matter to a student's code simply fails.
constexpr std::array kAllowed{
    SYS_read,
    SYS_write,
    SYS_writev,
    SYS_close,
    SYS_mmap,
    SYS_munmap,
    SYS_mremap,
    SYS_mprotect,
    SYS_madvise,
    SYS_brk,
    SYS_exit,
    SYS_exit_group,
    SYS_futex,
    SYS_rt_sigreturn,
    SYS_rt_sigaction,
    SYS_rt_sigprocmask,
    SYS_sigaltstack,
    SYS_clock_gettime,
    SYS_gettimeofday,
    SYS_getrandom,
    SYS_fstat,
    SYS_newfstatat,
    SYS_lseek,
    SYS_execve,
    SYS_arch_prctl,
    SYS_set_tid_address,
    SYS_set_robust_list,
    SYS_rseq,
    SYS_sched_yield,
    SYS_getpid,
    SYS_gettid,
    SYS_tgkill,
    SYS_sched_getaffinity,
};

/// The filter: another architecture is ended at once, calls on the list are let through, all others fail with EPERM.
/// tgkill, which abort() needs, reaches only the process itself: the filter compares its first argument.
std::vector<sock_filter> filter_program(pid_t self) {
    std::vector<sock_filter> program{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AUDIT_ARCH_X86_64, 1, 0),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
    };
    for (const auto number : kAllowed) {
        if (number == SYS_tgkill) continue;
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(number), 0, 1));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
    }
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(SYS_tgkill), 0, 3));
    program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[0])));
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(self), 0, 1));
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM));
    return program;
}

bool install_filter(pid_t self) {
#if defined(__x86_64__)
    auto program = filter_program(self);
    const sock_fprog description{static_cast<unsigned short>(program.size()), program.data()};
    return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &description, 0, 0) == 0;
#else
    (void)self;
    return false;
#endif
}

void set_limit(int resource, rlim_t value) {
    const rlimit limit{value, value};
    ::setrlimit(static_cast<__rlimit_resource_t>(resource), &limit);
}

} // namespace

bool sandbox_available() {
#if defined(__x86_64__)
    return ::prctl(PR_GET_SECCOMP, 0, 0, 0, 0) >= 0;
#else
    return false;
#endif
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
    set_limit(RLIMIT_CPU, 120);
    if (limits.sandbox) {
        set_limit(RLIMIT_AS, limits.memory_bytes);
        set_limit(RLIMIT_STACK, std::size_t{8} << 20);
    }
    std::array<char*, 2> arguments{const_cast<char*>(worker.c_str()), nullptr};
    std::array<char*, 1> environment{nullptr};
    if (limits.sandbox && sandbox_available() && !install_filter(::getpid())) ::_exit(126);
    ::execve(worker.c_str(), arguments.data(), environment.data());
    ::_exit(127);
}

} // namespace duet::grading
