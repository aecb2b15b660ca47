// Where the jitter of an effect's taps comes from.
#pragma once

#include "common/sampling/hash.h"
#include "common/vec/vec.h"

#include <bit>

namespace duet::raster {

/// A hash of a place: the same for any number of threads, another for each sample of a pixel.
inline std::uint64_t point_key(Vec3 p, std::uint64_t purpose) {
    const auto bits = [](float x) { return std::uint64_t{std::bit_cast<std::uint32_t>(x)}; };
    return hash_combine(hash_combine(bits(p.x) << 32 | bits(p.y), bits(p.z)), purpose);
}

} // namespace duet::raster
