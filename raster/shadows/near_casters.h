// Computes how much of a spherical light is hidden by casters close to it. Depths seen from the light's center do not
// suffice: points behind such a caster do not see the center, but may see other points of the light, such as those of a
// bulb that stands out over the rim of a bowl.
#pragma once

#include "raster/shader/octahedral_map.h"
#include "raster/shadows/cube_map.h"

#include <functional>
#include <optional>

namespace duet::raster {

/// Holds the maps of an area light, or of one cell of it. Casters whose depth in the cube about its center is below
/// `reach` meters are near.
struct CellMaps {
    CubeMap all;                    ///< shows all casters
    std::optional<CubeMap> distant; ///< shows casters beyond `reach`; none if no near casters surround the light
    OctahedralMap near_visibility;  ///< result of near_visibility(); empty if `distant` is none
    float reach = 0;
};

/// Returns whether surfaces whose depth is below `reach` meters fill more than half of the cube about a light's center,
/// as a lampshade does. A floor alone does not.
bool near_casters_surround(const CubeMap& cube, float reach);

/// Returns, in channel 0, the fraction of a sphere that is visible past the casters nearer than `reach`, by direction
/// in the frame of its cubes. It is exact for points at three times the reach. `draw` returns the cube about a point,
/// given relative to the sphere's center.
OctahedralMap near_visibility(double radius, float reach, const std::function<CubeMap(Vec3d)>& draw);

} // namespace duet::raster
