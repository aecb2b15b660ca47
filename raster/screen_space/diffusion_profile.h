// The diffusion profile of subsurface scattering: how far from where it has entered light leaves a solid.
#pragma once

#include "common/scene/scene.h"
#include "raster/geometry/packet.h"

#include <vector>

namespace duet::raster {

/// The normalized diffusion profile of Christensen and Burley 2015, "Approximate Reflectance Profiles for Efficient
/// Subsurface Scattering": of the light that leaves, the fraction b / (8π r)·(exp(−b r) + exp(−b r / 3)) per area
/// leaves at the distance r. The parameter b, 1/m, determines its scale; the mean distance is 2.5 / b.
namespace diffusion_profile {

/// Returns b times the mean free path in the interior of a solid, whose thick layers have this albedo in [0, 1]. It is
/// fitted to random walks (raytrace/integrator/random_walk.h) in a half space, whose mean distances it has within 5 %
/// (tested). T is float or a batch of floats.
template <typename T> T scale(const T& albedo) {
    using std::sqrt;
    const T s = similarity_parameter(albedo);
    return T(0.45f) + sqrt(s) + T(2.7f) * s;
}

/// Distances along an axis are cut off here, in units of 1 / b; less than 2 % of the light comes farther.
inline constexpr float kReach = 10;
/// Returns the fraction of the light that leaves within the distance x / b along one axis, before or behind, of all
/// within kReach; 1 beyond that.
Floats fraction_within(const Floats& x);

} // namespace diffusion_profile

/// What screen space needs to know about the solids among the materials, as arrays with an element for the background
/// and one for each material.
struct SolidMaterials {
    explicit SolidMaterials(const Scene& scene);

    std::vector<float> fraction;   ///< of the diffuse lobe that is subsurface scattering, texture left out; 0: no solid
    std::vector<float> solid_part; ///< of the surface that is a solid: the rest of it is metal, or diffuse
    std::vector<float> internal_reflectance;
    std::vector<float> mean_free_path[3]; ///< by channel, in meters
};

} // namespace duet::raster
