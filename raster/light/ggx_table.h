// The linearly transformed cosine that looks most like the light that GGX microfacets reflect, by roughness and angle:
// what lights with an area need of a rough metal.
#pragma once

#include "common/vec/vec.h"

namespace duet::raster {

/// The map that takes a clamped cosine's directions to the lobe's, in the frame of the normal, the viewer in the plane
/// y = 0: columns of [m11 0 m13; 0 m22 0; m31 0 m33] (Heitz et al. 2016, «Real-Time Polygonal-Light Shading with
/// Linearly Transformed Cosines», §3).
struct LobeMatrix {
    float m11 = 1, m13 = 0, m22 = 1, m31 = 0, m33 = 1;

    /// The lobe's directions back to the cosine's.
    Vec3 to_cosine(Vec3 w) const {
        const float over = 1 / (m11 * m33 - m13 * m31);
        return {(m33 * w.x - m13 * w.z) * over, w.y / m22, (m11 * w.z - m31 * w.x) * over};
    }
};

/// Of a table that is computed when the project is built (raster/light/ggx_fit.h). alpha in (0, 1]; below (1/20)² that stands
/// in. cosine: between normal and viewer, in (0, 1].
LobeMatrix ggx_lobe(float alpha, float cosine);

} // namespace duet::raster
