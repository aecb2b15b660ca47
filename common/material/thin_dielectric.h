// This file defines thin dielectric sheets (window panes, soap films, plastic wrap): two parallel boundaries with a
// negligible distance between them.
#pragma once

#include "common/image/rgb.h"
#include "common/material/bsdf.h"

namespace duet {

/// Holds the fractions of light that a thin sheet of glass reflects and transmits, after any number of reflections
/// inside.
template <typename T> struct SheetFractions {
    T reflected, transmitted;
};
/// Returns the fractions where each boundary reflects f and each pass through the sheet leaves t: f + (1 − f)² f t² /
/// (1 − f² t²) and (1 − f)² t / (1 − f² t²). T is float or a SIMD batch.
template <typename T> SheetFractions<T> sheet_fractions(const T& f, const T& t) {
    const T one(1.0f), through = one - f;
    // The denominator is (1 − f t)(1 + f t), with 1 − f t written as (1 − f) + f (1 − t), which does not cancel at
    // grazing angles. It is 0 where all light is reflected.
    const T all = through * through * t / max((through + f * (one - t)) * (one + f * t), T(1e-30f));
    return {f + all * f * t, all};
}

/// A ThinDielectricBsdf is a sheet of glass as a single surface. Light passes straight through or is mirrored, after
/// any number of reflections between the two boundaries, in closed form (Stokes 1862, "On the intensity of the light
/// reflected from or transmitted through a pile of plates"). Both sides are alike.
struct ThinDielectricBsdf {
    float eta; ///< index of refraction of the sheet over that of its surroundings
    Rgb tint;  ///< transmittance of one perpendicular pass through the sheet

    struct Fractions {
        Rgb reflected, transmitted;
    };
    /// Returns the reflected and transmitted fractions at an angle of incidence whose cosine is in (0, 1]. Slanted
    /// passes through the sheet are longer.
    Fractions fractions(float cosine) const;

    Rgb eval(Vec3, Vec3, TransportMode) const { return Rgb(); }
    float pdf(Vec3, Vec3, TransportMode) const { return 0; }
    /// Chooses between the mirrored and the straight direction, in proportion to their fractions.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
};

} // namespace duet
