// The truth of assignment 6: one ray a question in double, for both pipelines. It can make each of the typical
// mistakes, so that a wrong image is recognized by its likeness.
#pragma once

#include "compare/lessons/assignments/6-comparison/lab.h"
#include "tests/grading/judge.h"
#include "tests/grading/rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace duet::grading {

using lab::Camera, lab::HitCounts, lab::Rendering, lab::Scene, lab::Triangle;

constexpr int kWidth = 96, kHeight = 64;

/// What a wrong pipeline does. Each is drawn to be recognized.
struct HitMistakes {
    bool upside_down = false, mirrored = false, corners = false, horizontal_fov = false, farthest = false;
    bool no_near = false, one_sided = false, painter = false, drops_clipped = false;
};

struct PixelHit {
    int triangle = -1;
    double distance = kInfinity, depth = kInfinity;
};

struct View {
    Vec3d eye, right, up, forward;
    double focal, width, height, near;

    View(const Camera& camera, int w, int h, bool horizontal_fov = false)
        : eye(camera.eye), forward(normalize(Vec3d(camera.target) - eye)), width(w), height(h), near(camera.near) {
        right = normalize(cross(forward, Vec3d(camera.up)));
        up = cross(right, forward);
        focal = (horizontal_fov ? width : height) / 2 / std::tan(radians(static_cast<double>(camera.fov_degrees)) / 2);
    }
    Vec3d direction(double x, double y) const {
        return normalize(right * (x - width / 2) + up * (height / 2 - y) + forward * focal);
    }
    double depth(Vec3 p) const { return dot(Vec3d(p) - eye, forward); }
};

inline PixelHit trace_pixel(const Scene& scene, const View& view, double x, double y,
                            const HitMistakes& mistakes = {}) {
    if (mistakes.upside_down) y = view.height - y;
    if (mistakes.mirrored) x = view.width - x;
    if (mistakes.corners) x -= 0.5, y -= 0.5;
    const Vec3d d = view.direction(x, y);
    const double start = mistakes.no_near ? 0 : view.near / dot(d, view.forward);
    PixelHit pixel_hit;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        if (mistakes.one_sided && dot(cross(Vec3d(t.b) - Vec3d(t.a), Vec3d(t.c) - Vec3d(t.a)), d) > 0) continue;
        if (mistakes.drops_clipped && std::min({view.depth(t.a), view.depth(t.b), view.depth(t.c)}) < view.near)
            continue;
        const double distance = hit_triangle(t.a, t.b, t.c, view.eye, d);
        if (!(distance > start) || distance == kInfinity) continue;
        const bool wins = mistakes.farthest ? pixel_hit.triangle < 0 || distance > pixel_hit.distance
                                            : mistakes.painter || distance < pixel_hit.distance;
        if (wins) pixel_hit = {static_cast<int>(i), distance, distance * dot(d, view.forward)};
    }
    return pixel_hit;
}

/// All triangles that rays through the point (x, y) and eight points around it see.
inline std::set<int> triangles_nearby(const Scene& scene, const View& view, double x, double y, double by) {
    std::set<int> seen;
    for (const double dy : {-by, 0.0, by})
        for (const double dx : {-by, 0.0, by}) seen.insert(trace_pixel(scene, view, x + dx, y + dy).triangle);
    return seen;
}

/// A ground that goes on behind the eye, and random tetrahedra on it.
inline Scene random_scene(Rng& rng, int tetrahedra = 9) {
    Scene scene{{}, normalize(Vec3{0.5f, 0.8f, 0.35f}), {0.9f, 0.85f, 0.7f}, {0.16f, 0.2f, 0.3f}};
    const Vec3 a{-7, 0.01f, 6.3f}, b{7.1f, 0.02f, 6}, c{6.8f, 0, -7}, d{-7.2f, 0, -6.7f};
    scene.triangles = {{a, b, c, {0.6f, 0.55f, 0.45f}}, {a, c, d, {0.45f, 0.5f, 0.4f}}};
    for (int i = 0; i < tetrahedra; ++i) {
        const double x = rng.uniform(-2.6, 2.6), z = rng.uniform(-3.5, 1.2), size = rng.uniform(0.4, 0.9);
        std::array<Vec3, 4> p;
        for (std::size_t k = 0; k < 3; ++k) {
            const double angle = 2.0944 * static_cast<double>(k) + rng.uniform(0, 0.8);
            p[k] = Vec3(Vec3d(x + size * std::cos(angle), 0.05 + rng.uniform(0, 0.1), z + size * std::sin(angle)));
        }
        p[3] = Vec3(Vec3d(x, size * rng.uniform(1.2, 2), z));
        const Rgb color(static_cast<float>(rng.uniform(0.2, 0.9)), static_cast<float>(rng.uniform(0.2, 0.9)),
                        static_cast<float>(rng.uniform(0.2, 0.9)));
        for (const auto& [u, v, w] : {std::array{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
            scene.triangles.push_back({p[static_cast<std::size_t>(u)], p[static_cast<std::size_t>(v)],
                                       p[static_cast<std::size_t>(w)], color});
    }
    return scene;
}

const Camera kFront{{0.3f, 1.7f, 4.2f}, {0, 0.5f, -0.4f}, {0, 1, 0}, 48, 0.1f};
const Camera kTilted{
    {2.1f, 2.4f, 3}, {0.1f, 0.3f, -0.8f}, {0.25f, 1, 0.1f}, 62, 2.6f}; // its near plane cuts the ground

inline Vec3d facing_normal(const Triangle& t, Vec3d d) {
    const Vec3d n = normalize(cross(Vec3d(t.b) - Vec3d(t.a), Vec3d(t.c) - Vec3d(t.a)));
    return dot(n, d) > 0 ? -n : n;
}

inline Rgb shaded(const Scene& scene, const Triangle& t, double cosine, bool lit) {
    return t.albedo * (scene.sky + scene.sun * (lit ? static_cast<float>(std::max(0.0, cosine)) : 0.0f));
}

inline bool is_sunlit(const Scene& scene, Vec3d p, Vec3d n, double away) {
    return std::ranges::none_of(scene.triangles, [&](const Triangle& t) {
        const double distance = hit_triangle(t.a, t.b, t.c, p + n * away, Vec3d(scene.to_sun));
        return distance > 0 && distance < kInfinity;
    });
}

/// The counts by the contract's definition, from two renderings.
inline HitCounts count_hits(const Scene& scene, const Camera& camera, const Rendering& raster, const Rendering& traced,
                            double by = 1.0 / 128) {
    const View view(camera, kWidth, kHeight);
    HitCounts counts;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double a = raster.distance(x, y), b = traced.distance(x, y);
            if (raster.triangle(x, y) == traced.triangle(x, y))
                ++counts.same;
            else if (triangles_nearby(scene, view, x + 0.5, y + 0.5, by).contains(raster.triangle(x, y)))
                ++counts.edge;
            else if (std::max(a, b) < kInfinity && std::abs(a - b) <= 1e-5 * std::max(a, b))
                ++counts.tie;
            else
                ++counts.unexplained;
        }
    return counts;
}

/// The truth as a rendering, moved to the right by a number of pixels.
inline Rendering truth(const Scene& scene, const Camera& camera, double moved = 0) {
    const View view(camera, kWidth, kHeight);
    Rendering result{ImageRgb(kWidth, kHeight), Image<int>(kWidth, kHeight), ImageFloat(kWidth, kHeight)};
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const PixelHit pixel_hit = trace_pixel(scene, view, x + 0.5 - moved, y + 0.5);
            result.triangle(x, y) = pixel_hit.triangle, result.distance(x, y) = static_cast<float>(pixel_hit.distance);
        }
    return result;
}

} // namespace duet::grading
