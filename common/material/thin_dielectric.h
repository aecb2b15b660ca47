// Window panes, soap films, plastic wrap: two parallel boundaries with nothing worth mention in between.
#pragma once

#include "common/image/rgb.h"
#include "common/material/bsdf.h"

namespace duet {

/// A sheet of glass as one surface: light goes straight on, or is mirrored, after any number of reflections between its
/// sides, in closed form (Stokes 1862, «On the intensity of the light reflected from or transmitted through a pile of
/// plates»). Both sides are alike.
struct ThinDielectricBsdf {
    float eta; ///< index of refraction of the sheet over that around it
    Rgb tint;  ///< of what is left of light that crosses it once, straight

    struct Parts {
        Rgb reflected, transmitted;
    };
    /// Of light at an angle of incidence's cosine, in (0, 1]: with F at each boundary and t for each way across, slanted
    /// ways being longer, F + (1 − F)² F t²/(1 − F² t²) is reflected and (1 − F)² t/(1 − F² t²) goes on.
    Parts parts(float cosine) const;

    Rgb eval(Vec3, Vec3, TransportMode) const { return Rgb(); }
    float pdf(Vec3, Vec3, TransportMode) const { return 0; }
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
};

} // namespace duet
