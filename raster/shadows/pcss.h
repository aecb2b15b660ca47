// Soft shadows of area lights in lanes: percentage-closer soft shadows (Fernando 2005, "Percentage-Closer Soft
// Shadows") in a cube of depths seen from the light's center, with few taps that neighboring pixels share.
#pragma once

#include "raster/gbuffer/screen_projection.h"
#include "raster/geometry/packet.h"
#include "raster/shadows/cube_map.h"
#include "raster/shadows/emitter.h"

#include <vector>

namespace duet::raster {

/// Holds a cube of depths around a point, face after face, so that each lane may look at another face.
class DepthCube {
public:
    explicit DepthCube(const CubeMap& cube);

    /// Returns the surface point seen at the center of the texel in direction w, in the cube's frame about its center.
    /// It is exact, so points of a flat surface lie in its plane. It is very far away if nothing is seen. `texel`
    /// receives the texel's width there.
    Vec3T<Floats> surface(const Vec3T<Floats>& w, Floats& texel) const;
    FrameT<double> frame;
    Vec3d center;

private:
    std::vector<float> depths_; ///< very large where nothing is seen
    int side_;
    float near_, middle_, scale_; ///< as in CubeMap
};

/// Holds the map of one area light, or of one cell of it.
class SoftShadowMap {
public:
    SoftShadowMap(const CubeMap& cube, const Emitter& emitter);

    /// Returns the visible fraction of the light at points relative to the eye at `eye`, with unit normals. `pattern`
    /// in [0, 16) selects the taps of each lane: those of all sixteen patterns together cover the light evenly.
    Floats visibility(const Vec3d& eye, const Vec3T<Floats>& p, const Vec3T<Floats>& n, const Ints& pattern) const;

    /// Returns 1 where points see the light's center, else 0.
    Floats visibility(const Vec3d& eye, const Vec3T<Floats>& p) const;

    static constexpr int kSearchTaps = 8, kFilterTaps = 8;

private:
    struct Receiver;
    /// The light as seen from a receiver: points corner + a·u + b·v with a, b in [0, 1], or a disk.
    struct Outline;

    Outline outline_from(const Vec3T<Floats>& p) const;
    Vec3T<Floats> local(const Vec3T<Floats>& w) const;

    DepthCube cube_;
    Emitter::Kind kind_;
    float radius_ = 0;
    Vec3 corner_, u_, v_, dual_u_, dual_v_; ///< of a flat light, in the cube's frame; its normal is +z
};

} // namespace duet::raster
