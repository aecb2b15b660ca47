// Draws spheres exactly: each is bounded in the image and then intersected with the camera ray of each sample.
#pragma once

#include "raster/geometry/camera_rays.h"
#include "raster/geometry/tiles.h"
#include "raster/geometry/transform.h"

#include "common/scene/scene.h"

#include <optional>
#include <vector>

namespace duet::raster {

/// Represents a potentially visible sphere, or ellipsoid under an instance's transform.
struct DrawSphere {
    std::uint32_t object = 0;
    std::uint32_t id = 0; ///< id among the pass's triangles
    PixelRect bounds; ///< pixels it may cover, within the image
    Sphere sphere;    ///< in object space
    bool identity = true;

    Mat4 to_world, to_object;

    /// Returns the ray parameter of the hit, by intersect_sphere in object space as in the ray tracer; none on a
    /// miss.
    std::optional<float> intersect(const Ray& ray) const;
    /// Intersects one ray per SIMD lane, all at the pass's time. Returns each t, infinity on a miss.
    Doubles intersect(const CameraRays& rays) const;
    /// Returns the ray parameter t of the point closest to the sphere's center, measured in object space.
    float nearest(const Ray& ray) const;
};

/// Returns the pixels that may see the part of an affinely transformed sphere beyond the near plane. The bound is
/// conservative by a pixel and empty if the sphere is invisible. `to_pixel` maps the sphere's space to homogeneous
/// pixel coordinates. The extremes of the projected ellipsoid are exact, by the dual quadric (Sigg et al. 2006,
/// "GPU-Based Ray-Casting of Quadratic Surfaces", §3.1), clipped at the near plane as Mara and McGuire (2013, "2D
/// Polyhedral Bounds of a Clipped, Perspective-Projected 3D Sphere") do for spheres.
PixelRect sphere_bounds(const Sphere& sphere, const Mat4d& to_pixel, const Viewport& viewport);

/// Returns the listed objects' spheres that overlap the image, in the order of objects.
std::vector<DrawSphere> set_up_spheres(const Scene& scene, const std::vector<std::uint32_t>& objects,
                                       const Pinhole& pinhole, float time, const Viewport& viewport);

} // namespace duet::raster
