// The shapes of glass objects as seen from within: how far the surface is and which way it faces, in each direction
// from the object's center. A refracted ray finds there where it leaves.
#pragma once

#include "raster/raster_scene.h"
#include "raster/shader/octahedral_map.h"

#include <optional>

namespace duet::raster {

/// Holds the shapes of a scene's glass objects. Spheres at rest are exact. Other shapes are exact up to the resolution
/// of a map, if each ray from the center leaves them once. A ring, or another mesh whose center lies outside of it, is
/// taken for a ball that touches it wherever a ray enters, of the radius of a tube with its volume and surface. A ball
/// that moves away from the center of its bounds is taken for itself.
/// Surfaces that enclose nothing have no shape.
class GlassShapes {
public:
    GlassShapes(const RasterSceneData& data, const RasterSettings& settings);

    struct Exit {
        Vec3T<Floats> p;  ///< where the ray leaves, relative to the eye
        Vec3T<Floats> n;  ///< unit outward normal there
        Floats length;    ///< of the ray inside, in meters
    };
    /// Returns where a ray from the surface point p, relative to the eye at `eye`, with the unit outward normal n, in
    /// the unit direction w leaves an object; nothing for objects without a shape.
    std::optional<Exit> exit(std::int32_t object, const Vec3d& eye, const Vec3T<Floats>& p, const Vec3T<Floats>& n,
                             const Vec3T<Floats>& w) const;
    std::size_t memory_bytes() const;

    static constexpr int kSide = 128;       ///< texels of a map
    static constexpr std::size_t kMost = 24; ///< objects with a map; the largest. Smaller ones have no shape

private:
    struct Shape {
        Vec3d center;
        std::optional<OctahedralMap> map; ///< outward normal and distance; a sphere needs none
        std::optional<float> local_radius; ///< of the balls that touch it from within, in meters
    };
    std::vector<Shape> shapes_;
    std::vector<std::size_t> of_object_; ///< shapes_.size() if it has none
};

} // namespace duet::raster
