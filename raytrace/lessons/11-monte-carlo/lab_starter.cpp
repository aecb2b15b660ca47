// Lab 11: Monte Carlo. Begin with draw_power; direct_light needs sample_quad and light_density.
#include "raytrace/lessons/11-monte-carlo/lab.h"

namespace duet::lab {

float draw_power(float k, float u) {
    not_attempted(); // Remove this line when you start.
    (void)k;
    // The chance of a number below x is the integral of the density from 0 to x. For which x is it u?
    return u;
}

Vec3 sample_quad(const Light& light, Vec2 random) {
    not_attempted(); // Remove this line when you start.
    (void)random;
    return light.corner + (light.u + light.v) * 0.5f; // Always the middle: shadows have hard edges.
}

float light_density(const Light& light, Vec3 p, Vec3 q) {
    not_attempted(); // Remove this line when you start.
    (void)light, (void)p, (void)q;
    // By area the density is 1 / A. How large does a piece of the light look from p?
    return 0;
}

float cosine_density(Vec3 n, Vec3 w) {
    not_attempted(); // Remove this line when you start.
    (void)n, (void)w;
    return 1 / (2 * kPi); // All directions of the hemisphere are alike, so far.
}

Vec3 cosine_direction(Vec3 n, Vec2 random) {
    not_attempted(); // Remove this line when you start.
    (void)random;
    // The cosine has the density 2·x: see draw_power. The angle around n is uniform.
    return n;
}

float mis_weight(float own, float other) {
    not_attempted(); // Remove this line when you start.
    (void)own, (void)other;
    return 0.5f; // Both ways count half: right on average, but noisy.
}

Rgb direct_light(const Light& light, const std::vector<Sphere>& spheres, Vec3 p, Vec3 n, Rgb albedo, Vec2 random) {
    not_attempted(); // Remove this line when you start.
    (void)light, (void)spheres, (void)n, (void)random;
    // So far a floor in its own color, with rings around the origin. The estimate is f·cosine·emission / density.
    return albedo * (0.5f + 0.4f * std::sin(8 * length(p)));
}

} // namespace duet::lab
