// Lab 05: matte surfaces. Begin with srgb_from_linear; path_color needs unit_vector and diffuse_direction.
#include "raytrace/lessons/05-diffuse/lab.h"

namespace duet::lab {

float srgb_from_linear(float linear) {
    not_attempted(); // Remove this line when you start.
    // Two cases: a straight line for dark values, a power for the others (std::pow).
    return linear;
}

std::optional<Vec3> unit_vector(Vec3 cube_point) {
    not_attempted(); // Remove this line when you start.
    (void)cube_point;
    // Which points of the cube may stay? Scale those to length 1.
    return Vec3{0, 1, 0};
}

Vec3 diffuse_direction(Vec3 n, Vec3 u) {
    not_attempted(); // Remove this line when you start.
    (void)u;
    return n; // Every path goes straight away from the surface: no spot of the ground sees the spheres beside it.
}

Vec3 offset_origin(Vec3 p, Vec3 p_error, Vec3 n, Vec3 direction) {
    not_attempted(); // Remove this line when you start.
    (void)p_error, (void)n, (void)direction;
    // How far apart along n can p and the true point be, if each coordinate is off by as much as it may?
    return p;
}

Rgb path_color(const std::vector<Sphere>& spheres, const std::vector<Rgb>& albedos, const Ray& ray, int bounces,
               int seed) {
    not_attempted(); // Remove this line when you start.
    (void)bounces, (void)seed;
    // So far each surface has its own color, without any light. Go on from the hit in a loop.
    const auto hit = lesson::closest_hit(spheres, ray);
    return hit ? albedos[hit->index] : lesson::sky_color(ray.direction);
}

} // namespace duet::lab
