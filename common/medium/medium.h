// A medium is matter that fills a part of space, such as fog: light that passes through it is absorbed and scattered,
// and it may glow.
#pragma once

#include "common/image/rgb.h"
#include "common/vec/box.h"
#include "common/vec/ray.h"

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
struct Interval {
    float begin = 0, end = 0;
    bool empty() const { return !(begin < end); }
};
/// Returns the part of [0, t_end] in which the ray is inside of the box (Kay and Kajiya 1986, "Ray Tracing Complex
/// Scenes"). t_end may be infinite.
Interval overlap(const Box3& box, const Ray& ray, float t_end);

/// A MediumStretch is a piece of a ray on which the coefficients of all media together do not change.
struct MediumStretch {
    float end = 0; ///< where it ends, at most at the end of the ray
    Rgb scattering, absorption;
    Rgb emission; ///< the sum of absorption times radiance, W/(m³ sr)
};
/// Returns the stretch of the ray that begins at t < t_end.
MediumStretch stretch_at(std::span<const Medium> media, const Ray& ray, float t, float t_end);

/// Returns the fraction of light that the media let through on [0, t_end] of the ray: exp(−∫(σs + σa)), the law of
/// Beer and Lambert.
Rgb transmittance(std::span<const Medium> media, const Ray& ray, float t_end);

} // namespace duet
