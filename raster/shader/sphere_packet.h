// Computes the positions of sixteen samples on a sphere with SIMD.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/geometry/sphere.h"
#include "raster/visibility/sample_packet.h"

namespace duet::raster {

/// Computes the same results as find_hit() and surface_point() for one sample, in object space. Values of samples that
/// do not see the sphere are unspecified.
struct SpherePacket {
    using Vectors = std::array<PacketOf<float>, 3>;

    Vectors n; ///< unit normal of the sphere at each sample
    /// These are the normals below the points where the rays through the next pixels to the right and down meet the
    /// tangent plane. They are set only if requested.
    Vectors n_right, n_down;
    PacketOf<float> side;  ///< 1 if seen from outside, -1 from inside
    PacketOf<float> depth; ///< camera-space −z, meters

    SpherePacket(const PassView& view, const SamplePacket& packet, const DrawSphere& sphere, bool steps);
};

} // namespace duet::raster
