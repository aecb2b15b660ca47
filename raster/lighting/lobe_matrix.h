// Defines the matrix of a linearly transformed cosine.
#pragma once

namespace duet::raster {

/// Maps the directions of a clamped cosine to those of the lobe. In the frame, z is the normal and the viewer lies in
/// the plane y = 0. The matrix is [m11 0 m13; 0 m22 0; m31 0 m33] (Heitz et al. 2016, "Real-Time Polygonal-Light
/// Shading with Linearly Transformed Cosines", §3).
struct LobeMatrix {
    float m11 = 1, m13 = 0, m22 = 1, m31 = 0, m33 = 1;
};

} // namespace duet::raster
