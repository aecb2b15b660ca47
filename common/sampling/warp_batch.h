// This file overloads functions of warp.h for SIMD batches of floats.
#pragma once

#include "common/sampling/warp.h"
#include "common/vec/simd.h"

namespace duet {

/// Computes unit_circle() in each lane. The results equal those of the scalar function bit for bit.
template <typename Arch> Vec2T<xsimd::batch<float, Arch>> unit_circle(xsimd::batch<float, Arch> u) {
    using Floats = xsimd::batch<float, Arch>;
    const Floats minus(-0.0f), quarter = xsimd::trunc(Floats(4.0f) * u + Floats(0.5f)); // 0 to 4
    const Vec2T<Floats> p = cos_sin_near_zero((Floats(4.0f) * u - quarter) * Floats(static_cast<float>(kPiDouble / 2)));
    const auto third = quarter == Floats(3.0f), odd = third | (quarter == Floats(1.0f)),
               upper_half = third | (quarter == Floats(2.0f));
    const Vec2T<Floats> rotated{xsimd::select(odd, p.y ^ minus, p.x), xsimd::select(odd, p.x, p.y)};
    return {xsimd::select(upper_half, rotated.x ^ minus, rotated.x),
            xsimd::select(upper_half, rotated.y ^ minus, rotated.y)};
}

} // namespace duet
