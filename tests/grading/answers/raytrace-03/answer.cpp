// Every sphere is tried, and each hit shortens the ray.
#include "raytrace/lessons/03-surfaces/lab.h"

namespace duet::lab {

Hit make_hit(const Ray& ray, float t, Vec3 outward, int index) {
    const bool front = dot(ray.direction, outward) < 0;
    const Vec3 n = front ? outward : -outward;
    return {t, ray.at(t), n, front, index};
}

std::optional<Hit> closest_hit(const std::vector<Sphere>& spheres, const Ray& ray) {
    Ray rest = ray;
    std::optional<Hit> closest;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const auto t = lesson::hit_sphere(spheres[i], rest);
        if (!t) continue;
        rest.t_max = *t;
        const Vec3 outward = (ray.at(*t) - spheres[i].center) / spheres[i].radius;
        closest = make_hit(ray, *t, outward, static_cast<int>(i));
    }
    return closest;
}

bool any_hit(const std::vector<Sphere>& spheres, const Ray& ray) {
    for (const Sphere& sphere : spheres)
        if (lesson::hit_sphere(sphere, ray)) return true;
    return false;
}

} // namespace duet::lab
