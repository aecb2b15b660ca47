// Your sphere. Begin with hit_sphere: until it finds something, the others have nothing to show.
#include "raytrace/lessons/02-sphere/lab.h"

namespace duet::lab {

std::optional<float> hit_sphere(Vec3 center, float radius, const Ray& ray) {
    not_attempted(); // Remove this line when you start.
    (void)center, (void)radius, (void)ray;
    // Compute a, b and the third coefficient of the quadratic, then the discriminant. What does its sign say?
    return std::nullopt;
}

Vec3 sphere_normal(Vec3 center, float radius, Vec3 p) {
    not_attempted(); // Remove this line when you start.
    (void)center, (void)radius, (void)p;
    return {0, 0, 1}; // Every normal points at the viewer: the sphere looks flat.
}

Rgb normal_color(Vec3 n) {
    not_attempted(); // Remove this line when you start.
    (void)n;
    return {0.5f, 0.5f, 0.5f};
}

std::optional<float> hit_cylinder(float radius, const Ray& ray) {
    not_attempted(); // Remove this line when you start.
    (void)radius, (void)ray;
    // Look at ray and cylinder from straight above. What do you see, and which coordinates are left?
    return std::nullopt;
}

} // namespace duet::lab
