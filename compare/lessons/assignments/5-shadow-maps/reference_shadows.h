// The garden of assignment 5, and its shadows by rays in double: the truth that the examiner holds a student's to.
#pragma once

#include "common/vec/box.h"
#include "compare/lessons/assignments/5-shadow-maps/lab.h"
#include "tests/grading/rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace duet::grading {

using lab::Light, lab::GBuffer, lab::Triangle;

inline double d(float x) { return static_cast<double>(x); }

/// Triangles in groups that have a box and a color each.
struct Scene {
    struct Object {
        Box3d box;
        std::size_t first, end;
        Rgb color;
    };
    std::vector<Triangle> triangles;
    std::vector<Object> objects;

    void begin(Rgb color) { objects.push_back({{}, triangles.size(), triangles.size(), color}); }
    void add(Vec3d a, Vec3d b, Vec3d c) {
        triangles.push_back({Vec3(a), Vec3(b), Vec3(c)}), objects.back().end = triangles.size();
        for (const Vec3d p : {a, b, c}) objects.back().box.extend(Vec3d(Vec3(p)));
    }
    void add_quad(Vec3d corner, Vec3d u, Vec3d v) {
        add(corner, corner + u, corner + u + v), add(corner, corner + u + v, corner + v);
    }
    void add_block(Vec3d low, Vec3d high) {
        const Vec3d x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
        add_quad(low, z, y), add_quad(low + x, y, z), add_quad(low, x, z), add_quad(low + y, z, x);
        add_quad(low, y, x), add_quad(low + z, x, y);
    }
    /// Radii (x) at heights (y), turned about a vertical axis.
    void add_revolved(Vec3d foot, double size, const std::vector<Vec2d>& profile, int sides) {
        const auto at = [&](std::size_t k, int i) {
            const double a = 2 * kPiDouble * i / sides, r = profile[k].x * size;
            return foot + Vec3d(r * std::cos(a), profile[k].y * size, r * std::sin(a));
        };
        for (std::size_t k = 0; k + 1 < profile.size(); ++k)
            for (int i = 0; i < sides; ++i) {
                if (profile[k].x > 0) add(at(k, i), at(k + 1, i), at(k, i + 1));
                if (profile[k + 1].x > 0) add(at(k, i + 1), at(k + 1, i), at(k + 1, i + 1));
            }
    }
};

/// A terrace with vases and a pergola.
inline Scene garden(int sides) {
    Scene scene;
    scene.begin({0.62f, 0.52f, 0.4f}), scene.add_quad({-3.4, 0, -3}, {0, 0, 5.6}, {6.8, 0, 0});
    scene.begin({0.7f, 0.66f, 0.6f}), scene.add_block({-3.4, 0, -3}, {3.4, 0.5, -2.7});
    const std::vector<Vec2d> vase{{0, 0},       {0.17, 0},    {0.2, 0.05},  {0.42, 0.4}, {0.4, 0.62},
                                  {0.18, 0.85}, {0.16, 0.95}, {0.26, 1.05}, {0, 0.95}};
    const std::vector<Vec2d> column{{0.16, 0}, {0.16, 0.15}, {0.1, 0.2}, {0.09, 1.85}, {0.14, 1.95}, {0.14, 2}};
    scene.begin({0.72f, 0.22f, 0.1f}), scene.add_revolved({-0.55, 0, 0.9}, 1, vase, sides);
    scene.begin({0.1f, 0.35f, 0.4f}), scene.add_revolved({0.75, 0, 0.2}, 1.25, vase, sides);
    scene.begin({0.8f, 0.55f, 0.15f}), scene.add_revolved({1.5, 0, 1.5}, 0.6, vase, sides);
    for (const double z : {0.55, 1.15, 1.75})
        scene.begin({0.5f, 0.47f, 0.44f}), scene.add_block({-2.5, 0, z}, {-1.5, 0.16, z + 0.22});
    for (const double x : {-2.2, 2.2})
        for (const double z : {-1.9, -0.3})
            scene.begin({0.78f, 0.74f, 0.68f}), scene.add_revolved({x, 0, z}, 1, column, std::min(sides, 10));
    for (const double z : {-1.9, -0.3})
        scene.begin({0.45f, 0.27f, 0.14f}), scene.add_block({-2.6, 2, z - 0.07}, {2.6, 2.16, z + 0.07});
    for (int i = 0; i < 9; ++i)
        scene.begin({0.5f, 0.3f, 0.16f}), scene.add_block({-2.45 + 0.6 * i, 2.16, -2.4}, {-2.33 + 0.6 * i, 2.26, 0.2});
    return scene;
}

const Light kSun{normalize(Vec3{-0.55f, -0.8f, 0.35f}), 0.06f};
const Light kSpot{normalize(Vec3{-3.3f, -1.9f, -1.3f}), 0.2f, true, {3.1f, 2.2f, 1.75f}, 0.62f};

struct Hit {
    double t = kInfinity;
    int triangle = -1;
};
/// The first triangle between two t, without the triangle `own`.
inline Hit first_hit(const Scene& scene, Vec3d o, Vec3d dir, double t_min, double t_max = kInfinity, int own = -1) {
    Hit hit{t_max, -1};
    const Vec3d inverse(1 / dir.x, 1 / dir.y, 1 / dir.z);
    for (const Scene::Object& object : scene.objects) {
        double enter = t_min, leave = hit.t;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double a = (object.box.low[axis] - 1e-9 - o[axis]) * inverse[axis],
                         b = (object.box.high[axis] + 1e-9 - o[axis]) * inverse[axis];
            enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
        }
        for (std::size_t i = object.first; i < object.end && enter <= leave; ++i) {
            const Triangle& tri = scene.triangles[i];
            const double t = hit_triangle(tri.a, tri.b, tri.c, o, dir);
            if (t > t_min && t < hit.t && static_cast<int>(i) != own) hit = {t, static_cast<int>(i)};
        }
    }
    return hit;
}

/// A light in double: its axes, and what is toward it.
struct LightFrame {
    Vec3d forward, right, up, position;
    double radius;
    bool spot;
    double cosine; // of half_angle

    explicit LightFrame(const Light& light)
        : forward(normalize(Vec3d(light.direction))), position(light.position), radius(light.radius), spot(light.spot),
          cosine(std::cos(d(light.half_angle))) {
        right = normalize(cross(forward, std::abs(forward.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 0, 1)));
        up = cross(right, forward);
    }
    double along(Vec3d p) const { return dot(p - position, forward); }
    /// To a point of the unit disk; rays end at t = 1, or never for the sun.
    Vec3d toward(Vec3d p, Vec2d disk = {}) const {
        return (spot ? position - p : -forward) + (right * disk.x + up * disk.y) * radius;
    }
    double end() const { return spot ? 1 : kInfinity; }
    /// The light's ray through p, with the length 1 along the light.
    Vec3d ray(Vec3d p) const { return spot ? (p - position) / along(p) : forward; }
    bool shines_on(Vec3d p, Vec3d n) const {
        const Vec3d to = normalize(toward(p));
        return dot(n, to) > 0 && (!spot || dot(-to, forward) >= cosine);
    }
};

inline std::string name_of(const Light& light) { return light.spot ? "the spot light" : "the sun"; }

/// The box around a scene, and its smallest and largest distance along a light.
struct Extent {
    Box3d box;
    double near = kInfinity, far = -kInfinity;
};
inline Extent extent_of(const Light& light, const Scene& scene) {
    Extent extent;
    for (const Triangle& t : scene.triangles)
        for (const Vec3d p : {Vec3d(t.a), Vec3d(t.b), Vec3d(t.c)}) {
            const double along = LightFrame(light).along(p);
            extent.box.extend(p), extent.near = std::min(extent.near, along), extent.far = std::max(extent.far, along);
        }
    return extent;
}
/// Triangles with corners that are drawn one by one.
inline Scene random_triangles(int count, const auto& corner) {
    Scene scene;
    scene.begin({});
    for (int i = 0; i < count; ++i) {
        const Vec3d a = corner(), b = corner();
        scene.add(a, b, corner());
    }
    return scene;
}

/// What a camera sees of a scene: the triangle of each pixel, too.
struct PrimaryHits {
    GBuffer gbuffer;
    Image<int> triangle;
};
inline PrimaryHits primary_hits(const Scene& scene, int width, int height, Vec3d eye = {0.2, 2.6, 6.2},
                                Vec3d target = {0.05, 0.75, 0}, double tangent = 0.34) {
    PrimaryHits primary{{{width, height}, {width, height}}, {width, height, -1}};
    const Vec3d back = normalize(eye - target), right = normalize(cross(Vec3d(0, 1, 0), back)), up = cross(back, right);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double px = (2 * (x + 0.5) - width) / height * tangent, py = (1 - 2 * (y + 0.5) / height) * tangent;
            const Vec3d ray = right * px + up * py - back;
            const Hit hit = first_hit(scene, eye, ray, 0);
            if (hit.triangle < 0) continue;
            const Triangle& t = scene.triangles[static_cast<std::size_t>(hit.triangle)];
            const Vec3d n = normalize(cross(Vec3d(t.b) - Vec3d(t.a), Vec3d(t.c) - Vec3d(t.a)));
            primary.triangle(x, y) = hit.triangle;
            primary.gbuffer.point(x, y) = Vec3(eye + ray * hit.t),
                                     primary.gbuffer.normal(x, y) = Vec3(dot(n, ray) < 0 ? n : -n);
        }
    return primary;
}

/// Evenly over the unit disk: k of n points on a spiral.
inline Vec2d disk_point(int k, int n, double power = 0.5) {
    const double r = n == 1 ? 0 : std::pow((k + 0.5) / n, power), angle = 2.399963 * k;
    return {r * std::cos(angle), r * std::sin(angle)};
}
/// The fraction of the light that each pixel sees. A power other than 1/2 crowds the points of its disk. Where every
/// `step`-th ray says the same, the others are left out.
inline ImageFloat traced_visibility(const Scene& scene, const Light& light, const PrimaryHits& primary, int samples,
                                    double power = 0.5, bool beyond_light = false, int step = 1) {
    const LightFrame frame(light);
    return each_pixel(primary.triangle.width(), primary.triangle.height(), [&](int x, int y) {
        const Vec3d p(primary.gbuffer.point(x, y)), n(primary.gbuffer.normal(x, y));
        if (!frame.shines_on(p, n)) return 0.0f;
        const auto lit = [&](int by) {
            int count = 0;
            for (int k = 0; k < samples; k += by)
                count += first_hit(scene, p, frame.toward(p, disk_point(k, samples, power)), 1e-5,
                                   beyond_light ? kInfinity : frame.end(), primary.triangle(x, y))
                             .triangle < 0;
            return count;
        };
        if (step > 1) {
            const int some = lit(step);
            if (some == 0 || some == (samples + step - 1) / step) return some == 0 ? 0.0f : 1.0f;
        }
        return static_cast<float>(lit(1)) / static_cast<float>(samples);
    });
}

/// The garden in the light, as the page shows it.
inline ImageRgb shade(const Scene& scene, const Light& light, const PrimaryHits& primary, const ImageFloat& lit) {
    return each_pixel(lit.width(), lit.height(), [&](int x, int y) {
        const int i = primary.triangle(x, y);
        if (i < 0) return Rgb(0.03f, 0.05f, 0.1f);
        const Vec3d p(primary.gbuffer.point(x, y)), n(primary.gbuffer.normal(x, y));
        const auto of = std::ranges::find_if(scene.objects, [&](const auto& o) { return static_cast<int>(o.end) > i; });
        const bool tile = i < 2 && std::lround(std::floor(p.x * 1.6) + std::floor(p.z * 1.6)) % 2 != 0;
        const double cosine = std::max(0.0, dot(n, normalize(LightFrame(light).toward(p))));
        return of->color * (tile ? 0.78f : 1.0f) *
               (Rgb(1.45f, 1.25f, 0.95f) * (static_cast<float>(cosine) * lit(x, y)) +
                Rgb(0.13f, 0.17f, 0.26f) * static_cast<float>(1.4 + 0.6 * n.y));
    });
}

/// Red where an image is too bright, blue where it is too dark.
inline ImageRgb signed_difference(const ImageFloat& found, const ImageFloat& truth) {
    return each_pixel(found.width(), found.height(), [&](int x, int y) {
        const float error = found(x, y) - truth(x, y);
        return error > 0 ? Rgb(error, 0, 0) : Rgb(0, -0.4f * error, -error);
    });
}

/// What the truth says of each pixel. Near the edges of shadows, and where light grazes, it says nothing.
enum ShadowTruth { kLit, kShadow, kUnlit, kUncertain }; // kUnlit: no light comes there anyway
/// With texels of that side at the distance 1 m (the sun: everywhere). Where the light and the normal make the angle θ,
/// what throws a shadow must be more than 1.5 (1 + tan θ) texels and 1 cm in front of the surface.
inline Image<ShadowTruth> classify_pixels(const Scene& scene, const Light& light, const PrimaryHits& primary,
                                          double texel_at_1m) {
    const LightFrame frame(light);
    return each_pixel(primary.triangle.width(), primary.triangle.height(), [&](int x, int y) {
        const Vec3d p(primary.gbuffer.point(x, y)), n(primary.gbuffer.normal(x, y));
        if (primary.triangle(x, y) < 0) return kUnlit;
        const Vec3d ray = frame.ray(p), to = normalize(frame.toward(p));
        const double texel = texel_at_1m * (light.spot ? frame.along(p) : 1), cosine = dot(n, to);
        const double inside = light.spot ? dot(-to, frame.forward) - frame.cosine : 1;
        if (cosine < -1e-3 || inside < -1e-3) return kUnlit;
        if (cosine < 0.15 || inside < 1e-3) return kUncertain;
        int lit = 0, dark = 0;
        for (int k = 0; k < 9; ++k) {
            const Vec3d aside = (frame.right * (k % 3 - 1.0) + frame.up * (k / 3 - 1.0)) * (1.5 * texel);
            const Vec3d q = p + aside - ray * (dot(n, aside) / dot(n, ray)), toward = frame.toward(q);
            const Hit hit = first_hit(scene, q, toward, 1e-4, frame.end(), primary.triangle(x, y));
            lit += hit.triangle < 0;
            dark += hit.triangle >= 0 &&
                    hit.t * length(toward) > 1.5 * texel * (1 + std::sqrt(1 - sqr(cosine)) / cosine) + 0.01;
        }
        return lit == 9 ? kLit : dark == 9 ? kShadow : kUncertain;
    });
}

/// What is wrong with shadows, where the truth says something.
struct ShadowErrors {
    ImageFloat expected; ///< as found where the truth says nothing
    int lit = 0, acne = 0, dark = 0, leaks = 0;
    double farthest = 0; ///< of what throws a shadow that is missing
};
inline ShadowErrors find_shadow_errors(const Scene& scene, const Light& light, const PrimaryHits& primary,
                                       const Image<ShadowTruth>& truth, const ImageFloat& found) {
    ShadowErrors v{found};
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (truth[i] == kUncertain) continue;
        v.expected[i] = truth[i] == kLit;
        const bool wrong = found[i] != v.expected[i];
        v.lit += truth[i] == kLit, v.dark += truth[i] == kShadow, (truth[i] == kLit ? v.acne : v.leaks) += wrong;
        const Vec3d p(primary.gbuffer.point[i]), toward = LightFrame(light).toward(p);
        const Hit hit = first_hit(scene, p, toward, 1e-4, LightFrame(light).end(), primary.triangle[i]);
        if (wrong && hit.triangle >= 0) v.farthest = std::max(v.farthest, hit.t * length(toward));
    }
    return v;
}

/// The width of a penumbra from a row of pixels that runs from dark to bright over a length. From 10 % to 90 % of the
/// light it is 0.69 of the width behind a disk, and 0.8 behind a square.
inline double measure_penumbra(const ImageFloat& row, double run) {
    const auto crossing = [&](double level) {
        int i = 1;
        while (i + 1 < row.width() && d(row(i, 0)) <= level) ++i;
        const double a = row(i - 1, 0), b = row(i, 0);
        return (i - 1 + std::clamp((level - a) / (b - a), 0.0, 1.0)) / (row.width() - 1) * run;
    };
    return (crossing(0.9) - crossing(0.1)) / 0.745;
}

} // namespace duet::grading
