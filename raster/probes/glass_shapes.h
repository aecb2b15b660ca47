// Stores the shapes of glass objects as seen from within: the distance and normal of the surface in each direction from
// the object's center. They tell where a refracted ray leaves the object.
#pragma once

#include "raster/raster_scene.h"
#include "raster/shader/octahedral_map.h"

#include <optional>

namespace duet::raster {

/// Holds the shapes of a scene's glass objects. Spheres at rest are exact. Other shapes are exact up to the resolution
/// of a map, if each ray from the center leaves them once. A ring, or another mesh whose center lies outside of it, is
/// replaced by a sphere that touches it from within wherever a ray enters. The sphere has the radius of a tube with the
/// mesh's volume and surface. A sphere that moves away from the center of its bounds is replaced by a sphere of its own
/// radius. Surfaces that enclose nothing have no shape.
class GlassShapes {
public:
    GlassShapes(const RasterSceneData& data, const RasterSettings& settings);

    struct Exit {
        Vec3T<Floats> p;  ///< point where the ray leaves, relative to the eye
        Vec3T<Floats> n;  ///< unit outward normal at p
        Floats length;    ///< length of the ray inside the object, in meters
    };
    /// Returns where a ray that enters an object leaves it; nothing for objects without a shape. The ray starts at the
    /// surface point p, relative to the eye at `eye`, with the unit outward normal n, in the unit direction w.
    std::optional<Exit> exit(std::int32_t object, const Vec3d& eye, const Vec3T<Floats>& p, const Vec3T<Floats>& n,
                             const Vec3T<Floats>& w) const;
    std::size_t memory_bytes() const;

    static constexpr int kSide = 128;       ///< texels along a side of a map
    static constexpr std::size_t kMost = 24; ///< number of objects with a map; smaller objects have no shape

private:
    struct Shape {
        Vec3d center;
        std::optional<OctahedralMap> map; ///< outward normal and distance; a sphere needs none
        std::optional<float> local_radius; ///< radius of the replacing sphere, in meters
    };
    std::vector<Shape> shapes_;
    std::vector<std::size_t> of_object_; ///< index into shapes_ by object; shapes_.size() if it has none
};

} // namespace duet::raster
