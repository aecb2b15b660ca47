// The nearest of many surfaces along a ray.
#pragma once

#include "raytrace/lessons/02-sphere/sphere.h"

#include <vector>

namespace duet::lesson {

/// What a ray hit, and where.
struct Hit {
    float t = 0;           ///< the distance along the ray, in lengths of its direction
    Vec3 p;                ///< the point
    Vec3 n;                ///< the unit normal on the side from which the ray came
    bool front = true;     ///< whether the ray came from outside
    std::size_t index = 0; ///< which surface of the list
};

/// A hit at distance t of a surface whose unit normal `outward` points out of the solid.
inline Hit make_hit(const Ray& ray, float t, Vec3 outward, std::size_t index) {
    const bool front = dot(ray.direction, outward) < 0;
    return {t, ray.at(t), front ? outward : -outward, front, index};
}

/// The nearest hit of any sphere, or nothing. Each hit shortens the ray, so that only nearer ones count after it.
inline std::optional<Hit> closest_hit(const std::vector<Sphere>& spheres, Ray ray) {
    std::optional<Hit> closest;
    for (std::size_t i = 0; i < spheres.size(); ++i)
        if (const auto t = hit_sphere(spheres[i], ray)) {
            ray.t_max = *t;
            closest = make_hit(ray, *t, (ray.at(*t) - spheres[i].center) / spheres[i].radius, i);
        }
    return closest;
}

} // namespace duet::lesson
