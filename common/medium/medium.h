// A medium is matter that fills a part of space, such as fog: light that passes through it is absorbed and scattered,
// and it may glow.
#pragma once

#include "common/image/rgb.h"
#include "common/vec/box.h"
#include "common/vec/ray.h"

#include <cmath>
#include <span>

namespace duet {

/// A Medium fills an axis-aligned box evenly; a box without bounds is all of space. Where several overlap, their
/// coefficients add up. Glass and other dielectrics displace it: it is not inside of them.
struct Medium {
    Box3 box = unbounded();
    Rgb scattering; ///< σs: the fraction of light that is scattered per meter, 1/m
    Rgb absorption; ///< σa: the fraction of light that is absorbed per meter, 1/m
    /// The radiance that a layer which is thick beyond measure and scatters nothing emits, W/(m² sr). Over a short
    /// distance d the medium adds σa·d times that (Kirchhoff's law).
    Rgb radiance;
    float asymmetry = 0; ///< g, the mean cosine of the angle by which light is scattered, in (−1, 1)

    static constexpr Box3 unbounded() {
        Box3 box;
        std::swap(box.low, box.high);
        return box;
    }
};

/// An Interval holds all t with begin < t < end. It is empty where begin >= end.
template <typename T> struct IntervalT {
    T begin = T(0), end = T(0);
    MaskOf<T> empty() const { return !(begin < end); }
};
using Interval = IntervalT<float>;
/// Returns the part of [0, t_end] in which a ray is inside of the box (Kay and Kajiya 1986, "Ray Tracing Complex
/// Scenes"). t_end may be infinite. T is float or a batch of floats.
template <typename T>
IntervalT<T> overlap(const Box3& box, const Vec3T<T>& origin, const Vec3T<T>& direction, T t_end) {
    IntervalT<T> interval{T(0), t_end};
    const auto clip = [&](float Vec3::*axis, T o, T d) {
        const T low = T(box.low.*axis), high = T(box.high.*axis);
        const MaskOf<T> parallel = d == T(0), outside = (o < low) | (high < o);
        const T a = (low - o) / d, b = (high - o) / d; // both unused where the ray is parallel to the planes
        const T end = select(outside, interval.begin, interval.end);
        interval.begin = select(parallel, interval.begin, max(interval.begin, min(a, b)));
        interval.end = select(parallel, end, min(interval.end, max(a, b)));
    };
    clip(&Vec3::x, origin.x, direction.x);
    clip(&Vec3::y, origin.y, direction.y);
    clip(&Vec3::z, origin.z, direction.z);
    return interval;
}
inline Interval overlap(const Box3& box, const Ray& ray, float t_end) {
    return overlap(box, ray.origin, ray.direction, t_end);
}

/// A MediumStretch is a piece of a ray on which the coefficients of all media together do not change.
struct MediumStretch {
    float end = 0; ///< where it ends, at most at the end of the ray
    Rgb scattering, absorption;
    Rgb emission; ///< the sum of absorption times radiance, W/(m³ sr)
};
/// Returns the stretch of the ray that begins at t < t_end.
MediumStretch stretch_at(std::span<const Medium> media, const Ray& ray, float t, float t_end);

/// Returns ∫(σs + σa) over [0, t_end] of a ray. T is float or a batch of floats.
template <typename T>
RgbT<T> optical_depth(std::span<const Medium> media, const Vec3T<T>& origin, const Vec3T<T>& direction, T t_end) {
    RgbT<T> depth(T(0));
    for (const Medium& medium : media) {
        const IntervalT<T> inside = overlap(medium.box, origin, direction, t_end);
        const T distance = select(inside.empty(), T(0), inside.end - inside.begin);
        // The distance may be infinite and the coefficient 0.
        const auto channel = [&](float coefficient) { return coefficient > 0 ? T(coefficient) * distance : T(0); };
        const Rgb extinction = medium.scattering + medium.absorption;
        depth += RgbT<T>(channel(extinction.r), channel(extinction.g), channel(extinction.b));
    }
    return depth;
}

/// Returns the fraction of light that passes an optical depth: the law of Beer and Lambert.
template <typename T> RgbT<T> transmittance(const RgbT<T>& depth) {
    using std::exp;
    return {exp(-depth.r), exp(-depth.g), exp(-depth.b)};
}
/// Returns the fraction of light that the media let through on [0, t_end] of the ray.
inline Rgb transmittance(std::span<const Medium> media, const Ray& ray, float t_end) {
    return transmittance(optical_depth(media, ray.origin, ray.direction, t_end));
}

} // namespace duet
