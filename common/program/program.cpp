#include "common/program/program.h"

#include "common/system/error.h"
#include "common/system/escape.h"
#include "common/system/huge_pages.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <malloc.h>
#include <new>
#include <unistd.h>

namespace duet {

namespace {

/// Makes memory cheap to allocate again: glibc keeps what is freed. By default it returns large blocks to the system,
/// which then clears each page anew, a quarter of the time of a rasterized frame, whose images are allocated for each
/// frame. The main thread's heap begins with huge pages. They save page faults and TLB misses of blocks that are too
/// small for HugePageAllocator, such as shadow maps.
void configure_heap() {
#if defined(__GLIBC__) && !defined(DUET_SANITIZED) // the sanitizers have a heap of their own
    mallopt(M_MMAP_THRESHOLD, std::numeric_limits<int>::max()); // no block has a mapping of its own,
    mallopt(M_TRIM_THRESHOLD, -1);                              // and the heap does not shrink
    // A large block, freed again, stays part of the heap. It has addresses but no memory until something writes there.
    constexpr std::size_t kReserved = std::size_t{1} << 30;
    void* heap = std::malloc(kReserved);
    request_huge_pages(heap, kReserved);
    std::free(heap);
#endif
}

/// Prints an error on one line of at most 300 characters after the program's name. Control characters, which may
/// come from a file or its name, do not reach the terminal.
void print_error(const std::string& name, std::string_view text) {
    std::cerr << name << ": " << shortened(escaped(text), 300) << '\n';
}

} // namespace

int run_program(const std::string& name, const std::function<int()>& body) {
    configure_heap();
    try {
        const int code = body();
        std::cout.flush();
        if (!std::cout) throw Error("standard output cannot be written", kExitFailed);
        return code;
    } catch (const Error& error) {
        print_error(name, error.what());
        return error.exit_code();
    } catch (const std::bad_alloc&) {
        std::cerr << name << ": not enough memory for this image and scene\n";
        return kExitFailed;
    } catch (const std::exception& error) {
        print_error(name, error.what());
        return kExitFailed;
    }
}

namespace {

// A signal handler may only access a lock-free atomic of static storage duration.
std::atomic<bool>& interrupted() {
    static std::atomic<bool> flag{false};
    static_assert(std::atomic<bool>::is_always_lock_free);
    return flag;
}
extern "C" void raise_interrupt_flag(int) { interrupted().store(true); }

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

} // namespace

InterruptFlag::InterruptFlag() {
    interrupted().store(false);
    struct sigaction action {};
    action.sa_handler = raise_interrupt_flag;
    action.sa_flags = static_cast<int>(SA_RESETHAND); // a second signal gets the default action
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

InterruptFlag::~InterruptFlag() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

const std::atomic<bool>& InterruptFlag::flag() const { return interrupted(); }

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)), visible_(!quiet && ::isatty(STDERR_FILENO) == 1), start_(now()) {}

ProgressBar::~ProgressBar() { finish(); }

void ProgressBar::update(double fraction) {
    const double time = now();
    if (!visible_ || time - last_drawn_ < 0.1) return;
    last_drawn_ = time;
    constexpr int kWidth = 30;
    const double done = std::clamp(fraction, 0.0, 1.0), elapsed = time - start_;
    const int filled = static_cast<int>(done * kWidth);
    std::string bar(static_cast<std::size_t>(filled), '#');
    bar.resize(kWidth, '.');
    const std::string left = done > 0.01 ? format_duration(elapsed * (1 - done) / done) + " left" : "";
    std::fprintf(stderr, "\r%s [%s] %3.0f %%  %s, %s\033[K", label_.c_str(), bar.c_str(), 100 * done,
                 format_duration(elapsed).c_str(), left.c_str());
    std::fflush(stderr);
}

Control ProgressBar::control(const InterruptFlag& interrupt, std::size_t step, std::size_t steps) {
    return {&interrupt.flag(), [this, step, steps](double fraction) {
                update((static_cast<double>(step) + fraction) / static_cast<double>(steps));
            }};
}

void ProgressBar::finish() {
    if (visible_ && last_drawn_ >= 0) std::fputs("\r\033[K", stderr);
    last_drawn_ = -1;
}

std::string format_duration(double seconds) {
    char text[64];
    const long whole = std::lround(seconds);
    if (seconds < 0.9995)
        std::snprintf(text, sizeof text, "%.0f ms", seconds * 1000);
    else if (seconds < 59.95)
        std::snprintf(text, sizeof text, "%.1f s", seconds);
    else if (whole < 3600)
        std::snprintf(text, sizeof text, "%ld min %02ld s", whole / 60, whole % 60);
    else
        std::snprintf(text, sizeof text, "%ld h %02ld min", whole / 3600, whole / 60 % 60);
    return text;
}

} // namespace duet
