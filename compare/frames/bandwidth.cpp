#include "compare/frames/bandwidth.h"

#include "common/system/huge_pages.h"
#include "common/system/parallel.h"
#include "common/system/stopwatch.h"

#include <algorithm>
#include <vector>

namespace duet::compare {

double copy_bandwidth(int threads) {
    constexpr std::size_t kChunk = std::size_t{1} << 18, kChunks = 128; // 128 MB each way
    constexpr int kCopies = 6;
    std::vector<float, HugePageAllocator<float>> from(kChunk * kChunks), to(kChunk * kChunks);
    std::ranges::fill(from, 1.0f), std::ranges::fill(to, 0.0f);
    double least = 0;
    for (int i = 0; i < kCopies; ++i) {
        const Stopwatch watch;
        parallel_for(kChunks, threads, [&](std::size_t chunk) {
            const auto first = static_cast<std::ptrdiff_t>(chunk * kChunk), last = first + std::ptrdiff_t{kChunk};
            // The multiplication keeps compilers from calling memcpy, whose stores may bypass the caches.
            std::transform(from.begin() + first, from.begin() + last, to.begin() + first,
                           [&](float x) { return x * 0.5f; });
        });
        const double seconds = watch.seconds();
        least = i == 0 ? seconds : std::min(least, seconds);
    }
    return 2 * static_cast<double>(from.size() * sizeof(float)) / least;
}

} // namespace duet::compare
