// Defines the matrix of a linearly transformed cosine.
#pragma once

#include "common/vec/vec.h"

namespace duet::raster {

/// A lobe matrix maps the directions of a clamped cosine to those of the lobe. The frame is that of the normal, with
/// the viewer in the plane y = 0. The matrix is [m11 0 m13; 0 m22 0; m31 0 m33] (Heitz et al. 2016, "Real-Time
/// Polygonal-Light Shading with Linearly Transformed Cosines", §3).
struct LobeMatrix {
    float m11 = 1, m13 = 0, m22 = 1, m31 = 0, m33 = 1;

    /// Maps a direction of the lobe back to the cosine's space; the result is not normalized.
    Vec3 to_cosine(Vec3 w) const {
        const float over = 1 / (m11 * m33 - m13 * m31);
        return {(m33 * w.x - m13 * w.z) * over, w.y / m22, (m11 * w.z - m31 * w.x) * over};
    }
};

} // namespace duet::raster
