// Defines the diffusion profile of subsurface scattering: at which distance from its point of entry light leaves a
// solid.
#pragma once

#include "common/scene/scene.h"
#include "raster/geometry/packet.h"

#include <vector>

namespace duet::raster {

/// This is the normalized diffusion profile of Christensen and Burley 2015, "Approximate Reflectance Profiles for
/// Efficient Subsurface Scattering". Of the light that leaves, the fraction b / (8π r)·(exp(−b r) + exp(−b r / 3)) per
/// area leaves at the distance r. The parameter b, 1/m, determines its scale; the mean distance is 2.5 / b.
namespace diffusion_profile {

/// Returns b times the mean free path inside a solid whose thick layers have this albedo, in [0, 1]. It is fitted to
/// random walks (raytrace/integrator/random_walk.h) in a half space, and reproduces their mean distances to within 5 %
/// (tested). T is float or a batch of floats.
template <typename T> T scale(const T& albedo) {
    using std::sqrt;
    const T s = similarity_parameter(albedo);
    return T(0.45f) + sqrt(s) + T(2.7f) * s;
}

/// The profile is cut off at this distance along an axis, in units of 1 / b; less than 2 % of the light travels
/// farther.
inline constexpr float kReach = 10;
/// Returns the fraction of light that leaves within the distance x / b along one axis, in either direction, relative to
/// the light within kReach. It is 1 for x ≥ kReach.
Floats fraction_within(const Floats& x);

} // namespace diffusion_profile

/// Holds the parameters of the materials with subsurface scattering (solids). The arrays have one element for the
/// background, followed by one for each material.
struct SolidMaterials {
    explicit SolidMaterials(const Scene& scene);

    std::vector<float> fraction;   ///< fraction of the diffuse lobe that is subsurface scattering; 0: none
    std::vector<float> solid_part; ///< fraction of the surface that is a solid; the rest is metal or diffuse
    std::vector<float> internal_reflectance;
    std::vector<float> mean_free_path[3]; ///< by channel, in meters
};

} // namespace duet::raster
