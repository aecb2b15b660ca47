// Lab 10: light sources and quads. Begin with hit_quad; closest_hit and path_color need it.
#include "raytrace/lessons/10-cornell-box/lab.h"

namespace duet::lab {

std::optional<float> hit_quad(const Quad& quad, const Ray& ray) {
    not_attempted(); // Remove this line when you start.
    (void)quad, (void)ray;
    // Where does the ray meet the plane? Which a and b does that point have?
    return std::nullopt;
}

std::vector<Quad> box_of_quads(Vec3 low, Vec3 high, Rgb albedo) {
    not_attempted(); // Remove this line when you start.
    // One side is here: the top. Its normal, u × v, points up.
    const float x = high.x - low.x, z = high.z - low.z;
    return {{{low.x, high.y, low.z}, {0, 0, z}, {x, 0, 0}, albedo}};
}

Rgb emitted(const Quad& quad, Vec3 ray_direction) {
    not_attempted(); // Remove this line when you start.
    (void)ray_direction;
    return quad.emission; // From both sides, so far.
}

std::optional<lesson::Hit> closest_hit(const std::vector<Quad>& quads, const Ray& ray) {
    not_attempted(); // Remove this line when you start.
    (void)quads, (void)ray;
    // lesson::make_hit(ray, t, outward_normal, index) makes a hit: see lesson 03.
    return std::nullopt;
}

Rgb path_color(const std::vector<Quad>& quads, const Ray& ray, int bounces, int seed) {
    not_attempted(); // Remove this line when you start.
    (void)bounces, (void)seed;
    // So far each quad has its own color, without any light. Collect light in a loop.
    const auto hit = closest_hit(quads, ray);
    return hit ? quads[hit->index].albedo : Rgb(0);
}

} // namespace duet::lab
