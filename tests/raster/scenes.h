// This header provides simple scenes for the rasterizer's tests and an oracle in double precision, which tests a ray
// against every primitive.
#pragma once

#include "common/scene/build_scene.h"
#include "raster/render.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace duet::test {

inline Vec3 on_torus(double u, double v, double big, double small) {
    const double ring = big + small * std::cos(v);
    return Vec3(Vec3d(ring * std::cos(u), small * std::sin(v), -ring * std::sin(u)));
}

/// Returns a closed torus around the y axis. Its triangles are counterclockwise as viewed from outside.
inline Mesh torus(int around, int across, double big = 1, double small = 0.4) {
    Mesh mesh;
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k)
            mesh.positions.push_back(on_torus(2 * kPiDouble * i / around, 2 * kPiDouble * k / across, big, small));
    const auto vertex = [&](int i, int k) { return static_cast<std::uint32_t>((i % around) * across + k % across); };
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k) {
            mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1)});
            mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1)});
        }
    return mesh;
}

inline Mesh turned_inside_out(Mesh mesh) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    return mesh;
}

/// Adds an object with the given material, or gray diffuse by default.
inline Object& add(Scene& scene, Shape shape, const Mat4& to_world = Mat4(), Material material = Diffuse{}) {
    const std::uint32_t index =
        add_material(scene, "material " + std::to_string(scene.materials.size() + 1), std::move(material));
    return add_object(scene, "", std::move(shape), index, to_world);
}

/// Adds a second instance of an existing shape, which also prevents the first from being baked.
inline void add_instance(Scene& scene, std::size_t of, const Mat4& to_world) {
    Object object = scene.objects[of];
    object.place(to_world);
    scene.objects.push_back(object);
}

inline Camera look(Vec3d eye, Vec3d at, double fov_degrees = 40) {
    Camera camera;
    camera.eye = eye;
    camera.look_at = at;
    camera.fov_degrees = fov_degrees;
    return camera;
}

/// Returns an orthographic camera, whose image shows this height in meters.
inline Camera look_orthographic(Vec3d eye, Vec3d at, double height) {
    Camera camera = look(eye, at);
    camera.projection = Camera::Projection::kOrthographic;
    camera.height = height;
    return camera;
}

inline Rendering render(const Scene& scene, const View& view, const raster::RasterSettings& settings) {
    Control control;
    return raster::render(raster::prepare(scene, settings), view, settings, control);
}

/// Returns settings without light between surfaces and without occlusion of the environment.
inline raster::RasterSettings plain() {
    raster::RasterSettings settings;
    settings.ambient_occlusion = settings.indirect_light = false;
    return settings;
}

/// Returns the given settings without all light but the direct light of lights.
inline raster::RasterSettings direct_light_only(raster::RasterSettings settings = {}) {
    settings.indirect_light = settings.components.environment = settings.components.reflection = false;
    return settings;
}

/// Returns settings for an image of this shading and its hits.
inline raster::RasterSettings with_hits(raster::Shading shading = raster::Shading::kLit) {
    raster::RasterSettings settings;
    settings.shading = shading;
    settings.aovs.hit = true;
    return settings;
}

inline raster::RasterSettings hits_only() {
    raster::RasterSettings settings = with_hits(raster::Shading::kDepth);
    settings.aovs.depth = true;
    return settings;
}

// Holds a hit that the oracle finds, in double precision.
struct ReferenceHit {
    std::uint32_t object = kNoObject, primitive = 0;
    double u = 0, v = 0, t = std::numeric_limits<double>::infinity();
    double cosine = 1; ///< between the ray and the normal
};

/// Finds the nearest primitive along a ray by brute force in double precision.
class Oracle {
public:
    explicit Oracle(const Scene& scene, float time = 0) : scene_(scene) {
        for (std::uint32_t o = 0; o < scene.objects.size(); ++o) add_object(o, time);
    }

    ReferenceHit trace(const Rayd& ray) const {
        ReferenceHit nearest;
        for (const Facet& f : facets_) test(ray, f, nearest);
        for (const Ball& b : balls_) test(ray, b, nearest);
        return nearest;
    }

    /// Returns the point of a triangle or quad at (u, v). For a sphere, where u and v are undefined, the point is far
    /// away.
    Vec3d position(std::uint32_t object, std::uint32_t primitive, float u, float v) const {
        for (const Facet& f : facets_)
            if (f.object == object && f.primitive == primitive)
                return f.p + f.a * static_cast<double>(u) + f.b * static_cast<double>(v);
        return Vec3d(1e30, 1e30, 1e30);
    }

private:
    struct Facet {
        std::uint32_t object, primitive;
        Vec3d p, a, b;
        bool quad;
    };
    struct Ball {
        std::uint32_t object;
        Sphere sphere;
        Mat4d to_object;
    };

    void add_object(std::uint32_t index, float time) {
        const Object& object = scene_.objects[index];
        const ObjectTransform transform = object_transform(object, time);
        const Mat4d to_world(transform.to_world);
        const Shape& shape = scene_.shapes[object.shape];
        if (const Sphere* sphere = std::get_if<Sphere>(&shape)) {
            balls_.push_back({index, *sphere, inverse_affine(to_world)});
            return;
        }
        for (std::uint32_t k = 0; k < primitive_count(shape); ++k) {
            const PrimitiveVertices corners = primitive_vertices(shape, k);
            const auto at = [&](std::size_t i) { return transform_point(to_world, Vec3d(corners.p[i])); };
            const bool quad = corners.count == 4;
            facets_.push_back({index, k, at(0), at(1) - at(0), at(quad ? 3 : 2) - at(0), quad});
        }
    }

    static bool nearer(double t, std::uint32_t object, std::uint32_t primitive, const ReferenceHit& than) {
        if (t != than.t) return t < than.t;
        return object != than.object ? object < than.object : primitive < than.primitive;
    }

    static void test(const Rayd& ray, const Facet& f, ReferenceHit& nearest) {
        const Vec3d n = cross(f.a, f.b);
        const double toward = dot(ray.direction, n);
        if (toward == 0) return;
        const double t = dot(f.p - ray.origin, n) / toward;
        if (!(t >= ray.t_min) || !nearer(t, f.object, f.primitive, nearest)) return;
        const Vec3d q = ray.at(t) - f.p;
        const double u = dot(cross(q, f.b), n) / dot(n, n), v = dot(cross(f.a, q), n) / dot(n, n);
        if (u < 0 || v < 0 || (f.quad ? u > 1 || v > 1 : u + v > 1)) return;
        nearest = {f.object, f.primitive, u, v, t, std::abs(toward) / length(n)};
    }

    static void test(const Rayd& ray, const Ball& ball, ReferenceHit& nearest) {
        const Vec3d o = transform_point(ball.to_object, ray.origin) - Vec3d(ball.sphere.center);
        const Vec3d d = transform_vector(ball.to_object, ray.direction);
        const double r = static_cast<double>(ball.sphere.radius), a = dot(d, d), b = dot(o, d);
        const double inside = r * r - length_squared(o - d * (b / a));
        if (inside < 0) return;
        for (const double sign : {-1.0, 1.0}) {
            const double t = (-b + sign * std::sqrt(a * inside)) / a;
            if (!(t >= ray.t_min)) continue;
            if (nearer(t, ball.object, 0, nearest))
                nearest = {ball.object, 0, 0, 0, t, std::sqrt(inside) / r}; // grazing where the root is small
            return;
        }
    }

    const Scene& scene_;
    std::vector<Facet> facets_;
    std::vector<Ball> balls_;
};

/// Holds the result of comparing an image's hits with the oracle's.
struct Agreement {
    int same = 0, edge = 0, tie = 0, unexplained = 0, wrong_distance = 0;
    std::string first; ///< the first unexplained or wrong pixel
};

/// Compares each pixel's hit with exact rays. A different primitive counts as an edge if a ray displaced by at most
/// 1/128 pixel hits it, and as a tie if its distance is equal within 1e-5.
inline Agreement compare_hits(const Scene& scene, const View& view, const Image<Hit>& hits, double time = 0) {
    const CameraModel camera(view);
    const Pinhole pinhole = camera.pinhole();
    const Oracle oracle(scene, static_cast<float>(camera.time(time)));
    Agreement result;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const Hit& hit = hits(x, y);
            const auto matches = [&](const ReferenceHit& e) {
                return e.object == hit.object && (e.object == kNoObject || e.primitive == hit.primitive);
            };
            const auto report = [&](const char* what, const ReferenceHit& e) {
                if (result.first.empty())
                    result.first = message(what, " at pixel ", x, ", ", y, ": found object ", hit.object, " primitive ",
                                           hit.primitive, " t ", hit.t, " u ", hit.u, " v ", hit.v, "; exact: object ",
                                           e.object, " primitive ", e.primitive, " t ", e.t, " u ", e.u, " v ", e.v);
            };
            const Rayd ray = pinhole.ray({x + 0.5, y + 0.5});
            const ReferenceHit exact = oracle.trace(ray);
            // The tolerance is 1e-5 of the distance plus the rounding of a float ray's origin, which matters close to
            // the eye.
            const double tolerance = 1e-5 * exact.t + 0x1p-22 * length(ray.origin);
            if (matches(exact)) {
                ++result.same;
                if (hit.valid() && std::abs(static_cast<double>(hit.t) - exact.t) * exact.cosine > tolerance) {
                    ++result.wrong_distance;
                    report("wrong distance", exact);
                }
                continue;
            }
            // First try the position that the hit itself gives, which finds the thinnest sliver. Then try positions
            // all around.
            bool edge = false;
            if (hit.valid()) {
                const Vec3d p = pinhole.project(oracle.position(hit.object, hit.primitive, hit.u, hit.v));
                const bool close = std::hypot(p.x - x - 0.5, p.y - y - 0.5) <= 1.0 / 128;
                edge = close && matches(oracle.trace(pinhole.ray({p.x, p.y})));
            }
            for (int i = 0; i < 16 && !edge; ++i) {
                const double angle = 2 * kPiDouble * i / 16, reach = 1.0 / 128;
                edge = matches(
                    oracle.trace(pinhole.ray({x + 0.5 + reach * std::cos(angle), y + 0.5 + reach * std::sin(angle)})));
            }
            if (edge) {
                ++result.edge;
            } else if (hit.valid() && std::abs(static_cast<double>(hit.t) - exact.t) <= tolerance) {
                ++result.tie;
            } else {
                ++result.unexplained;
                report("unexplained", exact);
            }
        }
    return result;
}

} // namespace duet::test
