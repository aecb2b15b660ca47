// This header declares the textbook ray tracer of the naive columns, in float. It uses the triangle test of Möller
// and Trumbore (1997) with its customary epsilon, and the sphere test and t > 0.001 of Ray Tracing in One Weekend.
#pragma once

#include "common/scene/scene.h"

#include <vector>

namespace duet::compare {

/// Tests every primitive in world space. It keeps no reference to the scene.
class TextbookTracer {
public:
    explicit TextbookTracer(const Scene& scene);

    /// Returns the object, the primitive and t of the nearest hit; u and v are not set.
    Hit nearest(const Ray& ray) const;

private:
    struct Triangle {
        std::uint32_t object, primitive;
        Vec3 a, edge1, edge2;
    };
    struct PlacedSphere {
        std::uint32_t object;
        Sphere sphere;
        Mat4 to_object;
    };
    std::vector<Triangle> triangles_;
    std::vector<PlacedSphere> spheres_;
};

} // namespace duet::compare
