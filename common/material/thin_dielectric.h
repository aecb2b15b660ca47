// This file defines thin dielectric sheets (window panes, soap films, plastic wrap): two parallel boundaries with a
// negligible distance between them.
#pragma once

#include "common/image/rgb.h"
#include "common/material/bsdf.h"

namespace duet {

/// A ThinDielectricBsdf is a sheet of glass as a single surface. Light passes straight through or is mirrored, after
/// any number of reflections between the two boundaries, in closed form (Stokes 1862, "On the intensity of the light
/// reflected from or transmitted through a pile of plates"). Both sides are alike.
struct ThinDielectricBsdf {
    float eta; ///< index of refraction of the sheet over that of its surroundings
    Rgb tint;  ///< transmittance of one perpendicular pass through the sheet

    struct Fractions {
        Rgb reflected, transmitted;
    };
    /// Returns the reflected and transmitted fractions at an angle of incidence whose cosine is in (0, 1]. With F at
    /// each boundary and t for each pass through the sheet (slanted passes are longer), the sheet reflects
    /// F + (1 − F)² F t²/(1 − F² t²) and transmits (1 − F)² t/(1 − F² t²).
    Fractions fractions(float cosine) const;

    Rgb eval(Vec3, Vec3, TransportMode) const { return Rgb(); }
    float pdf(Vec3, Vec3, TransportMode) const { return 0; }
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
};

} // namespace duet
