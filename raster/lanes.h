// SIMD batches as wide as the machine has them, by xsimd: the rasterizer works through arrays of 16 samples, of which
// every width is a part.
#pragma once

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized" // GCC 12 says so, wrongly, of its own AVX-512 header
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <xsimd/xsimd.hpp>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include <array>
#include <cstddef>
#include <cstdint>

namespace duet::raster {

using Floats = xsimd::batch<float>;
using Ints = xsimd::batch<std::int32_t>;
using Doubles = xsimd::batch<double>;

/// Samples that are worked on together: two rows of a block of 8 × 8 (raster/depth_tile.h).
inline constexpr std::size_t kStrip = 16, kStripWidth = 8;
static_assert(kStrip % Floats::size == 0 && Floats::size == Ints::size);

/// One number a sample of a strip.
template <typename T> struct alignas(64) StripOf {
    std::array<T, kStrip> v{};

    T& operator[](std::size_t i) { return v[i]; }
    const T& operator[](std::size_t i) const { return v[i]; }
    void fill(T x) { v.fill(x); }
    T* at(std::size_t i) { return v.data() + i; }
    const T* at(std::size_t i) const { return v.data() + i; }
};

template <typename T> xsimd::batch<T> load(const StripOf<T>& strip, std::size_t i) {
    return xsimd::batch<T>::load_aligned(strip.at(i));
}
template <typename T> void store(StripOf<T>& strip, std::size_t i, const xsimd::batch<T>& value) {
    value.store_aligned(strip.at(i));
}

} // namespace duet::raster
