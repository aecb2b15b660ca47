// This file holds the types and helpers that all BSDFs share.
//
// All BSDFs follow these conventions, and tests check each of them. wo (to the viewer) and wi (to the light) are unit
// vectors in the local shading frame, where the normal is n = +z. Both point away from the surface. eval returns the
// BSDF without the cosine factor. sample returns weight = f·|cos θᵢ| / pdf, where pdf is the density of wi by
// solid angle. For a specular lobe (a delta distribution) eval and pdf return 0, and only sample finds the lobe.
//
// The BSDFs that are templates over the number type T evaluate one surface (T = float) or a SIMD batch of surfaces, one
// per lane. All lanes of a batch have the same kind of lobes: either all are specular or none is.
#pragma once

#include "common/image/rgb.h"

#include <cmath>
#include <optional>
#include <type_traits>

namespace duet {

/// TransportMode is the quantity that a path from wo transports: radiance to the camera, or importance to a light.
/// Refraction scales radiance by η² and leaves importance unchanged (Veach 1997, §5.2).
enum class TransportMode { kRadiance, kImportance };

/// Holds a sampled direction wi and its weight.
template <typename T> struct BsdfSampleT {
    Vec3T<T> wi;
    RgbT<T> weight;        ///< f·|cos θᵢ| / pdf
    T pdf{};               ///< density by solid angle; for a specular lobe, the probability of choosing it
    bool specular = false; ///< whether the lobe is a delta distribution, which light sampling cannot find
    MaskOf<T> transmitted = MaskOf<T>(false);
};
using BsdfSample = BsdfSampleT<float>;

/// Holds a BSDF sample in each lane of a batch, or none: the counterpart of std::optional for batches.
template <typename T> struct BsdfSampleLanes {
    MaskOf<T> valid = MaskOf<T>(false); ///< which lanes have a sample
    BsdfSampleT<T> sample;

    const BsdfSampleT<T>& operator*() const { return sample; }
    const BsdfSampleT<T>* operator->() const { return &sample; }
};
/// This is the return type of a BSDF's sample(): std::optional for a single surface, BsdfSampleLanes for a batch.
template <typename T>
using OptionalBsdfSample = std::conditional_t<Arithmetic<T>, std::optional<BsdfSampleT<T>>, BsdfSampleLanes<T>>;
/// Returns the sample where it is valid, else nothing.
template <typename T> OptionalBsdfSample<T> sample_where(MaskOf<T> valid, const BsdfSampleT<T>& sample) {
    if constexpr (Arithmetic<T>)
        return valid ? std::optional(sample) : std::nullopt;
    else
        return {valid, sample};
}
/// Returns whether there is a sample; for a batch, in which lanes.
inline bool has_sample(const std::optional<BsdfSample>& sample) { return sample.has_value(); }
template <typename T> MaskOf<T> has_sample(const BsdfSampleLanes<T>& lanes) { return lanes.valid; }

/// Returns the cosine between the normal and w, negative below the surface.
template <typename T> T cos_theta(Vec3T<T> w) { return w.z; }
/// Returns the absolute cosine between the normal and w.
template <typename T> T abs_cos_theta(Vec3T<T> w) { return abs(w.z); }
/// Returns whether a and b are on the same side of the surface. It is false where one of them is parallel to it.
template <typename T> MaskOf<T> same_hemisphere(Vec3T<T> a, Vec3T<T> b) { return a.z * b.z > T(0); }
/// Mirrors w about the normal.
template <typename T> Vec3T<T> mirrored(Vec3T<T> w) { return {-w.x, -w.y, w.z}; }

/// Builds the sample record for a direction wi that a Bsdf without delta lobes has drawn. Density and weight are
/// evaluated for the wi that was rounded to float.
template <typename BsdfType> BsdfSample sample_of(const BsdfType& bsdf, Vec3 wo, Vec3 wi, TransportMode mode) {
    const float density = bsdf.pdf(wo, wi, mode);
    return {wi, bsdf.eval(wo, wi, mode) * (abs_cos_theta(wi) / density), density};
}

/// Returns wo, the viewer's direction in the shading frame, moved to the side of the shading normal that the viewer
/// sees. Near a silhouette an interpolated normal may face away from a viewer who sees the surface, and the material
/// would then show its other side as a dark rim. Such a wo keeps its azimuth, but its |cos θ| becomes 1e-4. `side` is
/// the sign of the cosine between the geometric normal and the direction to the viewer.
template <typename T> Vec3T<T> clamp_to_visible_side(Vec3T<T> wo, T side) {
    constexpr float kMinCosine = 1e-4f;
    const auto is_visible = wo.z * side >= T(kMinCosine);
    if constexpr (Arithmetic<T>)
        if (is_visible) return wo; // almost every call returns here
    const T zero(0.0f), tangential = sqrt(wo.x * wo.x + wo.y * wo.y),
                        scale = T(std::sqrt(1 - kMinCosine * kMinCosine)) / tangential;
    const Vec3T<T> clamped = select(tangential == zero, Vec3T<T>(zero, zero, side),
                                    Vec3T<T>(wo.x * scale, wo.y * scale, T(kMinCosine) * side));
    return select(is_visible, wo, clamped);
}

} // namespace duet
