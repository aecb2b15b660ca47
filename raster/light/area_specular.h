// Light of surfaces on rough metal: linearly transformed cosines.
#pragma once

#include "common/light/light.h"
#include "common/material/metal.h"
#include "raster/light/direct.h"

namespace duet::raster {

/// Radiance that a rough metal reflects towards the viewer from a surface light, nothing in between. The lobe is taken
/// for a linearly transformed cosine of the same light in all (raster/light/ggx_table.h), of which a polygon is integrated
/// in closed form: it is taken back to the cosine's directions and measured there by Lambert's formula (Heitz et al.
/// 2016, §4), a sphere by the cone that it fills (Heitz and Hill 2017). Fresnel's term is averaged over the lobe. 0 on
/// the light's own primitive, and where the light does not shine to the point.
Rgb area_reflection(const SurfaceLight& light, const MetalBsdf& bsdf, const ShadingPoint& point);

} // namespace duet::raster
