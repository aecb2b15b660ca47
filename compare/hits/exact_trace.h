// The judge between the two pipelines: rays through the scene in double precision.
#pragma once

#include "common/geometry/hit.h"
#include "common/scene/scene.h"
#include "compare/hits/box_tree.h"

#include <vector>

namespace duet::compare {

/// What a ray hits, in double precision. No hit: object is kNoObject and t infinite.
struct ExactHit {
    std::uint32_t object = kNoObject, primitive = 0;
    double t = std::numeric_limits<double>::infinity();

    bool valid() const { return object != kNoObject; }
    /// Whether a pipeline's hit is of the same object and primitive (or both are none).
    bool same_as(const Hit& hit) const {
        return object == hit.object && (object == kNoObject || primitive == hit.primitive);
    }
};

/// Traces the scene as it stands at one moment. Vertices and transforms are the pipelines' own floats; all arithmetic
/// is double precision, so positions are 2^29 times finer than what is judged. The code is shared with neither
/// pipeline. Refers to the scene.
class ExactTracer {
public:
    /// `time` in [0, 1] of the objects' motion.
    ExactTracer(const Scene& scene, double time);

    /// The nearest hit with t in (ray.t_min, ray.t_max]; at equal t the lower (object, primitive). What the ray goes
    /// through by its opacity (common/scene/holes.h) is none.
    ExactHit nearest(const Rayd& ray) const;
    /// The nearest hit of the ray with one primitive, whatever stands before it.
    ExactHit intersect(const Rayd& ray, std::uint32_t object, std::uint32_t primitive) const;
    /// |cos θ| between the ray and the geometric normal of a primitive; on a sphere at the distance t. 0 for a triangle
    /// without area.
    double cosine(const Rayd& ray, std::uint32_t object, std::uint32_t primitive, double t) const;
    /// The corners of a triangle (3) or quad (4) in the world; none for a sphere.
    std::vector<Vec3d> corners(std::uint32_t object, std::uint32_t primitive) const;

private:
    struct Placed {
        const Shape* shape;
        Mat4d to_world, to_object;
    };
    Rayd to_object_space(const Rayd& ray, const Placed& placed) const;
    bool goes_through(const Rayd& ray, const Rayd& local, const ExactHit& hit) const;

    const Scene& scene_;
    float time_;
    std::vector<Placed> objects_;
    std::vector<BoxTree> shape_trees_;  ///< one a shape of the scene, in the shape's own space
    std::vector<const BoxTree*> trees_; ///< one an object
    BoxTree object_tree_;
};

/// How far two hits of one ray are apart: |Δt|·|cos θ| / t, the steeper of the two surfaces and the nearer of the two
/// distances taken. Measured along the surface's normal, or a grazing ray would be asked for more than its rounded
/// direction can give.
double distance_apart(const ExactTracer& tracer, const Rayd& ray, const ExactHit& a, const ExactHit& b);

} // namespace duet::compare
