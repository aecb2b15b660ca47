// These functions convert between SIMD batches of floats and of doubles with the same number of lanes. They require
// AVX, because half as many floats as fill a register must be a batch, too.
#pragma once

#include "common/vec/simd.h"
#include "common/vec/vec.h"

namespace duet {

#if XSIMD_WITH_AVX

/// A narrow batch has as many float lanes as a DoubleBatch has lanes.
using NarrowBatch = FloatBatch<kDoubleLanes>;

inline DoubleBatch to_doubles(NarrowBatch floats) {
#if XSIMD_WITH_AVX512F
    return _mm512_cvtps_pd(floats);
#else
    alignas(sizeof(DoubleBatch)) std::array<float, sizeof(NarrowBatch) / sizeof(float)> lanes;
    floats.store_aligned(lanes.data());
    return load_doubles(lanes.data());
#endif
}
/// Rounds each lane to float.
inline NarrowBatch to_floats(DoubleBatch doubles) {
#if XSIMD_WITH_AVX512F
    return _mm512_cvtpd_ps(doubles);
#else
    alignas(sizeof(DoubleBatch)) std::array<float, sizeof(NarrowBatch) / sizeof(float)> lanes{};
    store_floats(doubles, lanes.data());
    return NarrowBatch::load_aligned(lanes.data());
#endif
}
inline Vec3T<NarrowBatch> to_floats(const Vec3T<DoubleBatch>& v) {
    return {to_floats(v.x), to_floats(v.y), to_floats(v.z)};
}
inline Vec3T<DoubleBatch> to_doubles(const Vec3T<NarrowBatch>& v) {
    return {to_doubles(v.x), to_doubles(v.y), to_doubles(v.z)};
}

#endif

} // namespace duet
