// A path tracer by the book: Physically Based Rendering, 4th edition, §13.4.
#include "compare/lessons/assignments/4-path-tracer/lab.h"

#include <random>

namespace duet::lab {

namespace {

class Numbers {
public:
    explicit Numbers(std::uint32_t seed) : engine_(seed) {}
    float next() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }

private:
    std::mt19937 engine_;
};

Vec3 cosine_direction(Vec3 n, Numbers& numbers) {
    const float r = std::sqrt(numbers.next());
    const float phi = 2 * kPi * numbers.next();
    const Vec3 side = std::abs(n.x) > 0.5f ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    const Vec3 s = normalize(cross(side, n));
    const Vec3 t = cross(n, s);
    return normalize(s * (r * std::cos(phi)) + t * (r * std::sin(phi)) + n * std::sqrt(1 - r * r));
}

const Quad& at(const Scene& scene, int index) { return scene.quads[static_cast<std::size_t>(index)]; }

bool shines(const Quad& quad) { return max_component(quad.emission) > 0; }

Rgb path(const Scene& scene, Ray ray, int bounces, Strategy strategy, Numbers& numbers) {
    const float lights = static_cast<float>(scene.lights.size());
    Rgb sum(0), weight(1);
    float bsdf_pdf = 0;
    for (int bounce = 0; bounce <= bounces; ++bounce) {
        const auto hit = closest_hit(scene, ray);
        if (!hit) break;
        const Quad& quad = at(scene, hit->quad);
        if (hit->front && shines(quad)) {
            float part = 1;
            if (bounce > 0 && strategy == Strategy::kLight) part = 0;
            if (bounce > 0 && strategy == Strategy::kMis)
                part = power_heuristic(bsdf_pdf, light_pdf(quad, ray.origin, ray.direction) / lights);
            sum += weight * quad.emission * part;
        }
        if (bounce == bounces) break;
        const Vec3 p = hit->p + hit->n * 1e-4f;
        if (strategy != Strategy::kBsdf && !scene.lights.empty()) {
            const auto choice = static_cast<std::size_t>(numbers.next() * lights);
            const Quad& light = at(scene, scene.lights[choice]);
            const Vec2 random{numbers.next(), numbers.next()};
            const LightSample sample = sample_light(light, p, random);
            const float cosine = dot(sample.wi, hit->n);
            if (sample.pdf > 0 && cosine > 0 && !closest_hit(scene, Ray{p, sample.wi, 0, sample.distance * 0.9999f})) {
                const float pdf = sample.pdf / lights;
                const float part = strategy == Strategy::kMis ? power_heuristic(pdf, cosine * kInvPi) : 1;
                sum += weight * quad.albedo * light.emission * (kInvPi * cosine / pdf * part);
            }
        }
        weight *= quad.albedo;
        const Vec3 wi = cosine_direction(hit->n, numbers);
        bsdf_pdf = dot(wi, hit->n) * kInvPi;
        ray = Ray{p, wi};
    }
    return sum;
}

} // namespace

LightSample sample_light(const Quad& light, Vec3 p, Vec2 random) {
    const Vec3 normal = cross(light.u, light.v);
    const Vec3 to_light = light.corner + light.u * random.x + light.v * random.y - p;
    const float distance = length(to_light);
    const Vec3 wi = to_light / distance;
    const float area = length(normal);
    const float cosine = -dot(wi, normal) / area;
    return {wi, distance, cosine > 0 ? distance * distance / (cosine * area) : 0};
}

float light_pdf(const Quad& light, Vec3 p, Vec3 wi) {
    const Scene alone{{light}, {0}};
    const auto hit = closest_hit(alone, Ray{p, wi});
    if (!hit || !hit->front) return 0;
    const float cosine = dot(-wi, hit->n);
    return hit->t * hit->t / (cosine * length(cross(light.u, light.v)));
}

float power_heuristic(float pdf, float other) {
    if (!(pdf > 0)) return 0;
    const float ratio = other / pdf;
    return 1 / (1 + ratio * ratio);
}

std::vector<Rgb> radiance(const Scene& scene, const std::vector<Ray>& rays, int samples, int bounces, Strategy strategy,
                          std::uint32_t seed) {
    Numbers numbers(seed);
    std::vector<Rgb> result;
    for (const Ray& ray : rays) {
        Rgb sum(0);
        for (int i = 0; i < samples; ++i) sum += path(scene, ray, bounces, strategy, numbers);
        result.push_back(sum / static_cast<float>(samples));
    }
    return result;
}

} // namespace duet::lab
