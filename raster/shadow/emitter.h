// What a light with an area looks like to its shadows.
#pragma once

#include "common/light/light.h"

#include <span>

namespace duet::raster {

/// A light's outline as its shadows know it: a parallelogram, a triangle, or a ball, which to each receiver is the disk
/// that faces it.
struct Emitter {
    enum class Kind { kParallelogram, kTriangle, kBall };
    Kind kind = Kind::kBall;
    Vec3d center; ///< from which its maps are drawn
    Vec3d u, v;   ///< edges (not of a ball)
    Vec3d normal; ///< of its plane, on the side that emits (not of a ball)
    double radius = 0;

    /// Of one surface light.
    static Emitter of(const SurfaceLight& light);
    /// Of one, or of several triangles and quads at once: the smallest rectangle around them along one of the first one's
    /// edges where they lie in one plane and face the same way; else a ball around them.
    static Emitter of(std::span<const SurfaceLight> lights);
};

} // namespace duet::raster
