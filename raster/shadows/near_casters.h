// What casters close to a spherical light hide of it. Depths seen from the light's center do not tell that: the center
// does not see what lies behind such a caster, but other points of the light may, such as those of a bulb that looks
// over the rim of a bowl.
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
    std::optional<CubeMap> distant; ///< shows what is beyond `reach`; none if no near casters surround the light
    OctahedralMap near_visibility;  ///< what the function near_visibility() returns; empty if `distant` is none
    float reach = 0;
};

/// Returns whether surfaces whose depth is below `reach` meters fill more than half of the cube about a light's center,
/// as a shade does, and a floor alone cannot.
bool near_casters_surround(const CubeMap& cube, float reach);

/// Returns the fraction of a sphere that is visible past the casters nearer than `reach`, in channel 0, by direction in
/// the frame of its cubes. It is exact at three times the reach. `draw` returns the cube about the sphere's
/// center moved by a vector.
OctahedralMap near_visibility(double radius, float reach, const std::function<CubeMap(Vec3d)>& draw);

} // namespace duet::raster
