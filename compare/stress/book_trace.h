// The ray tracer of the books, for the naive columns: Möller and Trumbore's triangle (1997) with its customary epsilon,
// Ray Tracing in One Weekend's sphere and t > 0.001, in float.
#pragma once

#include "common/scene/scene.h"

#include <vector>

namespace duet::compare {

/// Tries every primitive, in world space. Refers to the scene.
class BookTracer {
public:
    explicit BookTracer(const Scene& scene);

    /// object and primitive of the nearest hit, and its t; not u and v.
    Hit nearest(const Ray& ray) const;

private:
    struct Triangle {
        std::uint32_t object, primitive;
        Vec3 a, edge1, edge2;
    };
    struct Ball {
        std::uint32_t object;
        Sphere sphere;
        Mat4 to_object;
    };
    std::vector<Triangle> triangles_;
    std::vector<Ball> balls_;
};

} // namespace duet::compare
