// This header declares the reflection of area lights on rough metal, by linearly transformed cosines.
#pragma once

#include "common/light/light.h"
#include "common/material/metal.h"
#include "raster/lighting/direct_lighting.h"

namespace duet::raster {

/// Returns the unoccluded radiance that a rough metal reflects from a surface light toward the viewer. The GGX lobe
/// is approximated by a linearly transformed cosine of the same total energy (raster/lighting/ggx_table.h). A polygon
/// is integrated in closed form: it is transformed to the cosine's space and integrated there by Lambert's formula
/// (Heitz et al. 2016, §4). A sphere is integrated by the cone that it subtends (Heitz and Hill 2017). Fresnel's term
/// is averaged over the lobe. The result is 0 on the light's own primitive and where the light does not emit toward
/// the point.
Rgb area_reflection(const SurfaceLight& light, const MetalBsdf& bsdf, const ShadingPoint& point);

} // namespace duet::raster
