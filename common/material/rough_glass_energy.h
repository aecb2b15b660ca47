// What becomes of the light that meets further microfacets of rough glass.
#pragma once

#include "common/material/rough_glass_table.h"

namespace duet {

/// Of one boundary. A single microfacet reflects R(w) and lets through T(w) of white light that comes from w; the rest, 1 − R − T,
/// meets others. On the thin side, that of the smaller index, it is shared out as what left at once: so what goes through is
/// multiplied by gain(w) = 1/(R + T), w the direction on the thin side, whichever of the two it is; and `lost`, the reflected
/// part of the rest, (1 − R − T) R/(R + T), returns by a lobe. What the dense side then still lacks returns inside by a lobe of
/// its own: from there little light comes out, and reciprocity allows no more. (The lobes: Kulla and Conty 2017, «Revisiting
/// Physically Based Shading at Imageworks»; scaling by the albedo: Turquin 2019, «Practical Multiple Scattering Compensation for
/// Microfacet Models», §3, here by a function of one of both directions, and so reciprocal.) White glass returns all from
/// each side (tested); glass that hardly refracts does not blur: light goes straight on through however many facets it meets.
///
/// Looked up in tables that are computed when the project is built.
class RoughGlassEnergy {
public:
    /// eta: index beyond over that on the side of +z, in [1/4, 4], or its inverse: the same boundary. alpha in [0, 1].
    RoughGlassEnergy(float eta, float alpha);

    /// cosine: with the normal, on the thin side, in [0, 1].
    float gain(float cosine) const;

    /// The light that a lobe lost(wo) lost(wi) / (π mean_lost) brings back, on one side: 0 where it is less than 0.03 % in
    /// the mean, and to look for it would be noise.
    struct Lobe {
        const RoughGlassTables::Surface* table = nullptr; ///< null: no lobe
        float mean_lost = 0;
    };
    Lobe lobe(bool dense) const;
    float lost(const Lobe& lobe, float cosine) const;

private:
    float look_up(const RoughGlassTables::Surface& surface, float cosine) const;

    float alpha_;
    RoughGlassTables::Place index_, row_;
};

} // namespace duet
