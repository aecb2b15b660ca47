// What keeps a submission to itself: limits, no files, no other processes.
#pragma once

#include "tests/grading/session.h"

namespace duet::grading {

/// Whether this computer can shut a process off from system calls: seccomp and ptrace, on Linux on x86-64. It is tried
/// once, in a process of its own.
bool sandbox_available();

/// In the child after a fork: gives it the descriptors, the limits and the filter, and runs the worker. Returns never;
/// ends with exit code 127 where the worker can't be run.
[[noreturn]] void run_sandboxed(const std::string& worker, const Limits& limits, int requests, int replies, int output);

/// In the parent: lets the child execute the worker. It is the only program that the child can ever execute: the filter
/// hands execve to a tracer, and afterwards there is none. False where the child ended; it is reaped then.
bool let_execute_once(pid_t child);

} // namespace duet::grading
