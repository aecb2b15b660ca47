// Spheres, drawn exactly: bounded in the picture, then their equation solved at each sample.
#pragma once

#include "raster/geometry/camera_rays.h"
#include "raster/geometry/setup.h"

#include "common/scene/scene.h"

#include <optional>
#include <vector>

namespace duet::raster {

/// A sphere, or under an instance's transform an ellipsoid, that may be seen.
struct DrawSphere {
    std::uint32_t object = 0;
    std::uint32_t id = 0; ///< its number among the pass's triangles
    PixelRect bounds; ///< pixels that may see it, within the picture
    Sphere sphere;    ///< in its object's space
    bool identity = true;
    bool far_side = false; ///< where a ray leaves it is drawn, not where that enters
    Mat4 to_world, to_object;

    /// Where a camera ray meets it: intersect_sphere in its object's space, as the ray tracer does it.
    std::optional<float> intersect(const Ray& ray) const;
    /// The same of rays side by side, all at the pass's moment: each t, infinity where there is none.
    Doubles intersect(const CameraRays& rays) const;
    /// Where the ray passes its centre, as the sphere's own space measures it.
    float nearest(const Ray& ray) const;
};

/// The pixels that may see the part beyond the near plane of an affinely mapped sphere: conservative by a pixel, empty
/// where it can't be seen. `to_pixel` takes the sphere's space to homogeneous pixels. Exact extremes of the projected
/// ellipsoid by the dual quadric (Sigg et al. 2006, «GPU-Based Ray-Casting of Quadratic Surfaces», §3.1), cut at the
/// near plane as Mara and McGuire (2013, «2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D Sphere») do for
/// spheres.
PixelRect sphere_bounds(const Sphere& sphere, const Mat4d& to_pixel, const Viewport& viewport);

/// The spheres of the listed objects that touch the picture, in order of objects.
std::vector<DrawSphere> set_up_spheres(const Scene& scene, const std::vector<std::uint32_t>& objects,
                                       const Pinhole& pinhole, float time, const Viewport& viewport);

} // namespace duet::raster
