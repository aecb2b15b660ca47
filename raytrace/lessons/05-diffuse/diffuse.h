// Random directions off a matte surface, and points from which they leave it for good.
#pragma once

#include "raytrace/lessons/03-surfaces/surfaces.h"
#include "raytrace/lessons/04-antialiasing/sampling.h"

namespace duet::lesson {

/// A random point of the unit sphere, all equally likely: points of the cube around it are drawn until one lies inside
/// the sphere, and that one is scaled to length 1. (Ray Tracing in One Weekend, §9.1)
inline Vec3 random_unit_vector(Random& random) {
    for (;;) {
        const float x = 2 * random.next() - 1, y = 2 * random.next() - 1, z = 2 * random.next() - 1;
        const Vec3 v{x, y, z};
        const float squared = length_squared(v);
        if (squared > 1e-12f && squared <= 1) return v / std::sqrt(squared);
    }
}

/// A direction in which a matte surface of unit normal n reflects light, likely in proportion to the cosine of its
/// angle with n (Lambert's law). Its length is not 1. (Ray Tracing in One Weekend, §9.4)
inline Vec3 random_diffuse_direction(Vec3 n, Random& random) {
    const Vec3 direction = n + random_unit_vector(random);
    return length_squared(direction) > 1e-12f ? direction : n; // the random vector may be almost exactly -n
}

/// The point of a hit, computed again from the center: then it is off by few roundings, each at most 2^-24 of its
/// number. It is moved out of the surface, to the side from which the ray came, by a bound of that error.
inline Vec3 offset_point(const Sphere& sphere, const Hit& hit) {
    const Vec3 outward = normalize(hit.p - sphere.center);
    const float bound = 8 * 0x1p-24f * (max_component(abs(sphere.center)) + sphere.radius);
    return sphere.center + outward * (sphere.radius + (hit.front ? bound : -bound));
}

} // namespace duet::lesson
