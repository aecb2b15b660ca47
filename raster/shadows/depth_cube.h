// This header declares a lookup of the depths in a cube of shadow maps.
#pragma once

#include "raster/geometry/packet.h"
#include "raster/shadows/cube_map.h"

#include <vector>

namespace duet::raster {

/// Holds a cube of depths around a point, face after face, so that each lane may read another face.
class DepthCube {
public:
    explicit DepthCube(const CubeMap& cube);

    /// Returns the surface point that the texel in direction w sees at its center, in the cube's frame about its
    /// center. The point is exact, so points of a flat surface lie in its plane. It is very far away if the texel sees
    /// nothing. `texel` receives the texel's width there.
    Vec3T<Floats> surface(const Vec3T<Floats>& w, Floats& texel) const;
    std::size_t memory_bytes() const { return depths_.size() * sizeof(float); }

    FrameT<double> frame;
    Vec3d center;

private:
    std::vector<float> depths_; ///< very large where nothing is seen
    int side_;
    float near_, middle_, scale_; ///< as in CubeMap
};

} // namespace duet::raster
