// Your path tracer. The starter shows the colors of the surfaces it sees. Begin with sample_light.
#include "compare/lessons/assignments/4-path-tracer/lab.h"

namespace duet::lab {

LightSample sample_light(const Quad& light, Vec3 p, Vec2 random) {
    not_attempted(); // Remove this line when you start.
    (void)random;    // The point is light.corner + light.u * random.x + light.v * random.y.
    const Vec3 to_corner = light.corner - p;
    return {normalize(to_corner), length(to_corner), 1};
}

float light_pdf(const Quad& light, Vec3 p, Vec3 wi) {
    not_attempted(); // Remove this line when you start.
    (void)light, (void)p, (void)wi;
    return 1;
}

float power_heuristic(float pdf, float other) {
    not_attempted(); // Remove this line when you start.
    (void)pdf, (void)other;
    return 0.5f; // Half for each way: right only where both densities are the same.
}

std::vector<Rgb> radiance(const Scene& scene, const std::vector<Ray>& rays, int samples, int bounces, Strategy strategy,
                          std::uint32_t seed) {
    not_attempted(); // Remove this line when you start.
    (void)samples, (void)bounces, (void)strategy, (void)seed;
    std::vector<Rgb> result;
    for (const Ray& ray : rays) {
        const auto hit = closest_hit(scene, ray);
        result.push_back(hit ? scene.quads[static_cast<std::size_t>(hit->quad)].albedo : Rgb(0));
    }
    return result;
}

} // namespace duet::lab
