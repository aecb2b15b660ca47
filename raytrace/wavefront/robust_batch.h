// Overloads functions of robust.h for SIMD batches of floats.
#pragma once

#include "common/vec/simd.h"
#include "common/vec/vec.h"

namespace duet {

/// Returns the next float above x in each lane. All lanes must be finite.
template <typename Arch> xsimd::batch<float, Arch> next_up(xsimd::batch<float, Arch> x) {
    using Floats = xsimd::batch<float, Arch>;
    using Bits = xsimd::batch<std::int32_t, Arch>;
    const Floats zero(0.0f), positive = x + zero; // −0 becomes +0
    const Bits bits = xsimd::bitwise_cast<Bits>(positive);
    return xsimd::select(positive >= zero, xsimd::bitwise_cast<Floats>(bits + Bits(1)),
                         xsimd::bitwise_cast<Floats>(bits - Bits(1)));
}

/// Computes the scalar function rounded_away() in each lane. All lanes must be finite.
template <typename Arch>
Vec3T<xsimd::batch<float, Arch>> rounded_away(const Vec3T<xsimd::batch<float, Arch>>& sum,
                                              const Vec3T<xsimd::batch<float, Arch>>& by) {
    using Floats = xsimd::batch<float, Arch>;
    const auto one = [](Floats x, Floats d) {
        const Floats zero(0.0f);
        return xsimd::select(d > zero, next_up(x), xsimd::select(d < zero, -next_up(-x), x));
    };
    return {one(sum.x, by.x), one(sum.y, by.y), one(sum.z, by.z)};
}

} // namespace duet
