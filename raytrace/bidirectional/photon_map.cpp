#include "raytrace/bidirectional/photon_map.h"

#include "common/sampling/hash.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace duet::raytrace {

namespace {

// Photons are sorted by slot in two steps: into buckets of adjacent slots, and within each bucket. Threads work on
// chunks of photons, and then on buckets.
constexpr int kBucketBits = 6;
constexpr std::size_t kBuckets = std::size_t{1} << kBucketBits, kChunks = 64;

struct Chunk {
    std::size_t begin, end;
};
Chunk chunk(std::size_t i, std::size_t size) { return {size * i / kChunks, size * (i + 1) / kChunks}; }

} // namespace

PhotonMap::Cell PhotonMap::cell(Vec3 p) const {
    const auto index = [&](float x) {
        const double scaled = std::floor(static_cast<double>(x) * cells_per_meter_);
        return static_cast<std::int64_t>(std::clamp(scaled, -0x1p60, 0x1p60));
    };
    return {index(p.x), index(p.y), index(p.z)};
}

std::size_t PhotonMap::slot_of(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t index : cell) hash = hash_combine(hash, static_cast<std::uint64_t>(index));
    return static_cast<std::size_t>(hash >> (64 - slot_bits_));
}

PhotonMap::PhotonMap(std::vector<Photon> photons, float radius, int threads)
    : radius_(radius), cells_per_meter_(0.5 / static_cast<double>(radius)) {
    const std::size_t size = photons.size();
    slot_bits_ = kBucketBits;
    while ((std::size_t{1} << slot_bits_) < size) ++slot_bits_;
    const int bits_in_bucket = slot_bits_ - kBucketBits;
    std::vector<std::uint32_t> slots(size), sorted(size);
    std::vector<std::array<std::uint32_t, kBuckets>> next(kChunks);
    parallel_for(kChunks, threads, [&](std::size_t i) {
        for (auto [k, end] = chunk(i, size); k < end; ++k) {
            slots[k] = static_cast<std::uint32_t>(slot_of(cell(photons[k].p)));
            ++next[i][slots[k] >> bits_in_bucket];
        }
    });
    std::array<std::uint32_t, kBuckets + 1> bucket_starts{};
    std::uint32_t sum = 0;
    for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
        bucket_starts[bucket] = sum;
        for (auto& counts : next) sum += std::exchange(counts[bucket], sum);
    }
    bucket_starts[kBuckets] = sum;
    parallel_for(kChunks, threads, [&](std::size_t i) {
        for (auto [k, end] = chunk(i, size); k < end; ++k)
            sorted[next[i][slots[k] >> bits_in_bucket]++] = static_cast<std::uint32_t>(k);
    });
    photons_.resize(size);
    starts_.resize((std::size_t{1} << slot_bits_) + 1, sum);
    parallel_for(kBuckets, threads, [&](std::size_t bucket) {
        const auto begin = sorted.begin() + bucket_starts[bucket], end = sorted.begin() + bucket_starts[bucket + 1];
        std::sort(begin, end,
                  [&](std::uint32_t a, std::uint32_t b) { return std::pair(slots[a], a) < std::pair(slots[b], b); });
        std::uint32_t k = bucket_starts[bucket];
        for (std::size_t slot = bucket << bits_in_bucket; slot < (bucket + 1) << bits_in_bucket; ++slot) {
            starts_[slot] = k;
            for (; k < bucket_starts[bucket + 1] && slots[sorted[k]] == slot; ++k) photons_[k] = photons[sorted[k]];
        }
    });
}

} // namespace duet::raytrace
