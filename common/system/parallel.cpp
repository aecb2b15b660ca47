#include "common/system/parallel.h"

#include <algorithm>
#include <thread>

// ThreadSanitizer does not see the synchronization inside an uninstrumented oneTBB and reports dozens of false races.
// Suppressing these reports would hide real races, so the ThreadSanitizer build runs the same loops on std::thread.
#if defined(DUET_STD_THREADS)
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>
#else
#include <map>
#include <optional>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <utility>
#endif

namespace duet {

#if defined(DUET_STD_THREADS)

int available_threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr first_error;
    std::mutex error_mutex;
    const auto work = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            try {
                body(i);
            } catch (...) {
                const std::lock_guard lock(error_mutex);
                if (!first_error) first_error = std::current_exception();
                next = count;
            }
        }
    };
#if defined(__EMSCRIPTEN__) // the web page's build has no threads
    constexpr int workers = 1;
#else
    const int workers = threads > 0 ? threads : available_threads();
#endif
    std::vector<std::thread> others;
    for (int i = 1; i < workers; ++i) others.emplace_back(work);
    work();
    for (std::thread& other : others) other.join();
    if (first_error) std::rethrow_exception(first_error);
}

#else

int available_threads() { return std::max(1, tbb::info::default_concurrency()); }

namespace {

/// A task arena is cached for each number of threads and reused by later loops of the same thread. Worker threads that
/// left an arena rejoin it at once. On a computer that also runs other programs, they join a new arena only after some
/// milliseconds, and a frame may end before that. Threads do not share arenas: an arena holds as many threads as its
/// loops may use, and one more would wait until a loop of another thread has ended.
struct Arena {
    // A caller may request more threads than there are cores, as a test of determinism does. The limit raises oneTBB's
    // own maximum for this case.
    std::optional<tbb::global_control> limit;
    tbb::task_arena arena;

    explicit Arena(int workers) : arena(workers) {
        if (workers > available_threads())
            limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(workers));
    }
};

tbb::task_arena& arena_of(int workers) {
    thread_local std::map<int, Arena> arenas; // key: number of threads
    return arenas.try_emplace(workers, workers).first->second.arena;
}

/// It is true while this thread runs the body of a loop. Loops within use the arena of that loop.
thread_local bool in_loop = false;

struct LoopScope {
    const bool outer = std::exchange(in_loop, true);
    LoopScope() = default;
    LoopScope(const LoopScope&) = delete;
    LoopScope& operator=(const LoopScope&) = delete;
    ~LoopScope() { in_loop = outer; }
};

} // namespace

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
    const int workers = threads > 0 ? threads : available_threads();
    if (workers == 1 || count <= 1) {
        for (std::size_t i = 0; i < count; ++i) body(i);
        return;
    }
    const auto loop = [&] {
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
            const LoopScope scope;
            body(i);
        });
    };
    // A thread that waits for the end of an inner loop must not begin another iteration of the outer loop meanwhile.
    if (in_loop) return tbb::this_task_arena::isolate(loop);
    arena_of(workers).execute(loop);
}

#endif

} // namespace duet
