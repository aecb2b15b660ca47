#include "compare/kernels/ray_sets.h"

#include "common/geometry/quad.h"
#include "common/geometry/triangle.h"
#include "common/sampling/hash.h"
#include "common/sampling/warp.h"
#include "common/system/parallel.h"
#include "common/vec/frame.h"

#include <algorithm>
#include <functional>
#include <optional>

namespace duet::compare {

namespace {

constexpr std::size_t kChunk = 4096; ///< number of rays generated at a time

/// Extracts every other bit of a number below 256, from the lowest on.
int even_bits(int code) {
    int bits = 0;
    for (int i = 0; i < 4; ++i) bits |= (code >> (2 * i) & 1) << i;
    return bits;
}

/// Returns the position of the i-th pixel within a whole tile.
std::pair<int, int> pixel_in_tile(int i, PixelOrder order) {
    static_assert(kTile == 16);
    if (order == PixelOrder::kRows) return {i % kTile, i / kTile};
    return {even_bits(i), even_bits(i >> 1)};
}

/// Returns the results of `make` for each ray and its index, in order and without empty ones. They do not depend on the
/// number of threads.
template <typename Made>
std::vector<Made> collect(std::span<const Ray> rays, int threads,
                          const std::function<std::optional<Made>(const Ray&, std::size_t)>& make) {
    std::vector<std::vector<Made>> parts((rays.size() + kChunk - 1) / kChunk);
    parallel_for(parts.size(), threads, [&](std::size_t part) {
        std::vector<Made> made;
        for (std::size_t i = part * kChunk; i < std::min(rays.size(), (part + 1) * kChunk); ++i)
            if (const std::optional<Made> one = make(rays[i], i)) made.push_back(*one);
        parts[part] = std::move(made);
    });
    std::vector<Made> all;
    for (const std::vector<Made>& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

/// Returns the surface point of the ray's first hit.
std::optional<SurfacePoint> first_surface_point(const KernelScene& scene, const raytrace::Accelerator& accelerator,
                                                const Ray& ray) {
    const Hit hit = accelerator.closest(ray);
    if (!hit.valid()) return std::nullopt;
    return surface_point(*scene.scene, ray, hit);
}

/// Returns two random samples in [0, 1) that belong to the ray.
Vec2 random_samples(std::uint64_t seed, std::size_t index) {
    const std::uint64_t bits = hash_combine(mix_bits(seed), index);
    return {unit_float(high_bits(bits)), unit_float(low_bits(bits))};
}

} // namespace

std::vector<Ray> camera_rays(const Camera& camera, int width, int height, PixelOrder order, int threads) {
    const CameraModel model({camera, width, height});
    const int columns = (width + kTile - 1) / kTile, rows = (height + kTile - 1) / kTile;
    std::vector<Ray> rays(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    parallel_for(static_cast<std::size_t>(rows), threads, [&](std::size_t row) {
        const int y0 = static_cast<int>(row) * kTile;
        auto next = static_cast<std::size_t>(y0) * static_cast<std::size_t>(width); // the rows of tiles above are full
        for (int column = 0; column < columns; ++column) {
            for (int i = 0; i < kTile * kTile; ++i) {
                const auto [x_in_tile, y_in_tile] = pixel_in_tile(i, order);
                const int x = column * kTile + x_in_tile, y = y0 + y_in_tile;
                if (x < width && y < height) rays[next++] = model.ray({x + 0.5, y + 0.5});
            }
        }
    });
    return rays;
}

std::vector<Ray> bounce_rays(const KernelScene& scene, const raytrace::Accelerator& accelerator,
                             std::span<const Ray> rays, std::uint64_t seed, int threads) {
    return collect<Ray>(rays, threads, [&](const Ray& ray, std::size_t index) -> std::optional<Ray> {
        const std::optional<SurfacePoint> point = first_surface_point(scene, accelerator, ray);
        if (!point) return std::nullopt;
        const Vec3 n = dot(point->ng, ray.direction) > 0 ? -point->ng : point->ng;
        const Vec3 w = normalize(frame_from_normal(n).to_world(cosine_hemisphere(random_samples(seed, index))));
        return Ray{offset_origin(*point, w), w};
    });
}

namespace {

struct AimedRay {
    Ray ray;
    Hit end;
};

/// Returns the triangle that a ray to the light ends on. For a quad, it is the one of its two triangles that
/// the ray hits.
Hit light_hit(const SurfaceLight& light, const Ray& ray, float distance) {
    Hit end;
    end.t = distance;
    end.object = light.object;
    end.primitive = light.primitive;
    if (const auto* t = std::get_if<SurfaceLight::Triangle>(&light.shape)) {
        if (const auto hit = intersect_triangle(ShearedRay(ray), t->a, t->b, t->c)) end.t = hit->t;
    } else if (const auto* quad = std::get_if<Quad>(&light.shape)) {
        const std::array<Vec3, 4> p = corners(*quad);
        const ShearedRay sheared(ray);
        if (const auto first = intersect_triangle(sheared, p[0], p[1], p[2])) {
            end.t = first->t;
        } else if (const auto second = intersect_triangle(sheared, p[0], p[2], p[3])) {
            end.t = second->t;
            if (end.object != kNoObject) ++end.primitive;
        }
    }
    return end;
}

} // namespace

ShadowRays shadow_rays(const KernelScene& scene, const raytrace::Accelerator& accelerator, std::span<const Ray> rays,
                       std::uint64_t seed, int threads) {
    constexpr float kShadowRayScale = 1 - 1e-4f;
    const auto make = [&](const Ray& ray, std::size_t index) -> std::optional<AimedRay> {
        const std::optional<SurfacePoint> point = first_surface_point(scene, accelerator, ray);
        if (!point) return std::nullopt;
        const Light& light = scene.lights[index % scene.lights.size()];
        const std::optional<LightSample> s = sample_light(light, point->p, random_samples(~seed, index));
        if (!s) return std::nullopt;
        // The light must be on the side of the incoming ray.
        const bool lit = dot(point->ng, s->wi) * dot(point->ng, ray.direction) < 0;
        if (!lit) return std::nullopt;
        AimedRay aimed{{offset_origin(*point, s->wi), s->wi}, {}};
        aimed.end.t = s->distance;
        if (const auto* surface = std::get_if<SurfaceLight>(&light))
            aimed.end = light_hit(*surface, aimed.ray, s->distance);
        aimed.ray.t_max = s->distance * kShadowRayScale;
        if (aimed.end.object == kNoObject) aimed.end.t = aimed.ray.t_max;
        return aimed;
    };
    ShadowRays result;
    for (const AimedRay& aimed : collect<AimedRay>(rays, threads, make)) {
        result.rays.push_back(aimed.ray);
        result.ends.push_back(aimed.end);
    }
    return result;
}

} // namespace duet::compare
