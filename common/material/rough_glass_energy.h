// This file provides the energy compensation for multiple scattering between the microfacets of rough glass.
#pragma once

#include "common/material/rough_glass_table.h"

namespace duet {

/// RoughGlassEnergy is the multiple-scattering compensation of one boundary. A single microfacet reflects the
/// fraction R(w) and transmits T(w) of white light from direction w. The rest, 1 − R − T, hits further
/// microfacets.
///
/// The thin side is that of the smaller index. There the rest is divided in the proportion R : T. Transmitted light
/// is therefore multiplied by gain(w) = 1/(R + T), where w is the direction on the thin side, be it wo or wi. The
/// reflected part of the rest, (1 − R − T) R/(R + T), is `energy_loss` and returns by a lobe.
///
/// The energy that light from the dense side still lacks returns by a lobe inside the dense medium: little light
/// leaves from there, and reciprocity allows no larger gain. The lobes follow Kulla and Conty 2017, "Revisiting
/// Physically Based Shading at Imageworks". The scaling by the albedo follows Turquin 2019, "Practical Multiple
/// Scattering Compensation for Microfacet Models", §3; here the factor depends on only one of the two directions,
/// which makes it reciprocal.
///
/// White glass returns all light from each side (tested). Glass that hardly refracts does not blur: light passes
/// straight through any number of facets. All values come from tables that are generated when the project is built.
class RoughGlassEnergy {
public:
    /// eta is the index beyond the boundary over the index on the side of +z, in [1/4, 4]; its inverse describes the
    /// same boundary. alpha is in [0, 1].
    RoughGlassEnergy(float eta, float alpha);

    /// Returns the factor of transmitted light. cosine is between the normal and the direction on the thin side, in
    /// [0, 1].
    float gain(float cosine) const;

    /// A Lobe is the reflection lobe energy_loss(wo) energy_loss(wi) / (π mean_energy_loss) on one side. There is no
    /// lobe where it returns less than 0.03 % in the mean: sampling it would add more noise than energy.
    struct Lobe {
        const RoughGlassTables::Surface* table = nullptr; ///< null: no lobe
        float mean_energy_loss = 0;
    };
    /// Returns the lobe on the dense or on the thin side.
    Lobe lobe(bool dense) const;
    /// Returns a lobe's energy_loss; 0 where there is no lobe. The cosine is in [0, 1].
    float energy_loss(const Lobe& lobe, float cosine) const;

private:
    float look_up(const RoughGlassTables::Surface& surface, float cosine) const;

    float alpha_;
    RoughGlassTables::TableIndex index_, row_;
};

} // namespace duet
