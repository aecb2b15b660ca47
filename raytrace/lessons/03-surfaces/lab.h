// Lab 03: the nearest surface.
#pragma once

#include "common/image/rgb.h"
#include "raytrace/lessons/02-sphere/sphere.h"
#include "tests/grading/lab.h"

#include <vector>

namespace duet::lab {

using lesson::Sphere;

/// What a ray hit, and where.
struct Hit {
    float t = 0;
    Vec3 p;            ///< the point, ray.at(t)
    Vec3 n;            ///< the unit normal, turned against the ray: dot(ray.direction, n) <= 0
    bool front = true; ///< whether the ray came from outside
    int index = 0;     ///< of the sphere in the list
};

/// A hit at distance t, from the unit normal that points out of the sphere.
Hit make_hit(const Ray& ray, float t, Vec3 outward, int index);

/// The nearest hit with ray.t_min < t < ray.t_max, whatever the order of the list; nothing where the ray hits no
/// sphere. lesson::hit_sphere (lesson 02) is given.
std::optional<Hit> closest_hit(const std::vector<Sphere>& spheres, const Ray& ray);

/// Whether the ray hits any sphere at all with ray.t_min < t < ray.t_max: what a shadow asks.
bool any_hit(const std::vector<Sphere>& spheres, const Ray& ray);

} // namespace duet::lab

DUET_LAB(make_hit, closest_hit, any_hit)
