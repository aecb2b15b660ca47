// This file declares a double-precision ray tracer that serves as the reference for both pipelines' hits.
#pragma once

#include "common/geometry/hit.h"
#include "common/scene/scene.h"
#include "compare/hits/reference_bvh.h"

#include <vector>

namespace duet::compare {

/// A ReferenceHit is a ray's hit in double precision. On a miss, object is kNoObject and t is infinite.
struct ReferenceHit {
    std::uint32_t object = kNoObject, primitive = 0;
    double t = std::numeric_limits<double>::infinity();

    bool valid() const { return object != kNoObject; }
    /// Returns whether a pipeline's hit is the same object and primitive (or both are misses).
    bool same_as(const Hit& hit) const {
        return object == hit.object && (object == kNoObject || primitive == hit.primitive);
    }
};

/// Traces the scene at one moment in time. Vertices and transforms are the floats that the pipelines use, but all
/// arithmetic is in double precision, whose roundoff is 2^29 times smaller than that of the hits to judge. The tracer
/// shares no code with either pipeline. It holds a reference to the scene.
class ReferenceTracer {
public:
    /// `time` in [0, 1] is the time of the objects' motion.
    ReferenceTracer(const Scene& scene, double time);

    /// Returns the closest hit with t in (ray.t_min, ray.t_max]; at equal t, the lower (object, primitive).
    /// Hits that the alpha test discards (common/scene/alpha_mask.h) do not count.
    ReferenceHit nearest(const Rayd& ray) const;
    /// Returns the closest hit of the ray with one primitive, ignoring all occluders.
    ReferenceHit intersect(const Rayd& ray, std::uint32_t object, std::uint32_t primitive) const;
    /// Returns |cos θ| between the ray and the geometric normal of a primitive; for a sphere, the normal at
    /// distance t. Returns 0 for a triangle without area.
    double cosine(const Rayd& ray, std::uint32_t object, std::uint32_t primitive, double t) const;
    /// Returns a bound on the displacement, by rounding, of the point at distance t of a ray that is traced in float.
    /// It covers the rounding of the ray's origin and direction, of the transform to the object's space, and of the
    /// result (Higham 2002, "Accuracy and Stability of Numerical Algorithms", §3.1). It is large for an instance whose
    /// own coordinates are large compared with t.
    double ray_rounding(const Rayd& ray, std::uint32_t object, double t) const;
    /// Returns the corners of a triangle (3) or quad (4) in world space; none for a sphere.
    std::vector<Vec3d> corners(std::uint32_t object, std::uint32_t primitive) const;

private:
    struct PlacedShape {
        const Shape* shape;
        Mat4d to_world, to_object;
    };
    Rayd to_object_space(const Rayd& ray, const PlacedShape& placed) const;
    bool passes_alpha_test(const Rayd& ray, const Rayd& local, const ReferenceHit& hit) const;

    const Scene& scene_;
    float time_;
    std::vector<PlacedShape> objects_;
    std::vector<ReferenceBvh> shape_trees_;  ///< one per shape of the scene, in the shape's own space
    std::vector<const ReferenceBvh*> trees_; ///< one per object
    ReferenceBvh object_tree_;
};

/// Returns the distance of a point from the plane of a polygon's corners, in meters; infinity if they span no plane or
/// there are none.
double plane_distance(const std::vector<Vec3d>& corners, Vec3d point);

/// Returns the relative distance between two hits of one ray: |Δt|·|cos θ| / t, with the larger cosine of the
/// two surfaces and the smaller of the two distances. It is measured along the surface normal, because at
/// grazing angles the rounding of the ray direction alone causes large differences in t.
double relative_distance(const ReferenceTracer& tracer, const Rayd& ray, const ReferenceHit& a, const ReferenceHit& b);

} // namespace duet::compare
