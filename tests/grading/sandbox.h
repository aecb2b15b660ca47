// What keeps a submission to itself: limits, no files, no other processes.
#pragma once

#include "tests/grading/session.h"

namespace duet::grading {

/// Whether this kernel can shut a process off from system calls (seccomp, Linux on x86-64).
bool sandbox_available();

/// In the child after a fork: gives it the three descriptors, the limits and the filter, and runs the worker. Returns
/// never; ends with exit code 127 where the worker can't be run.
[[noreturn]] void run_sandboxed(const std::string& worker, const Limits& limits, int requests, int replies, int output);

} // namespace duet::grading
