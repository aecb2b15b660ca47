// These tests compare the G-buffer bounds of spheres and ellipsoids with a ray for every pixel.
#include "raster/geometry/sphere.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;
using namespace duet::raster;

namespace {

/// Returns whether the ray hits the transformed sphere at or beyond t_min. The quadratic is solved in object space in
/// double.
bool sees(const Rayd& ray, const Sphere& sphere, const Mat4d& to_object) {
    const Vec3d o = transform_point(to_object, ray.origin) - Vec3d(sphere.center);
    const Vec3d d = transform_vector(to_object, ray.direction);
    const double r = static_cast<double>(sphere.radius);
    const double a = dot(d, d), b = dot(o, d), closest2 = length_squared(o - d * (b / a));
    if (closest2 > r * r) return false;
    return (-b + std::sqrt(a * (r * r - closest2))) / a >= ray.t_min; // the far intersection
}

struct Case {
    Camera camera;
    Sphere sphere;
    Mat4d to_world;
};

/// Returns whether the sphere is entirely beyond the near plane of a camera that looks along −z.
bool beyond_near(const Case& c, double near) {
    const double reach =
        static_cast<double>(c.sphere.radius) * length(Vec3d(c.to_world[2][0], c.to_world[2][1], c.to_world[2][2]));
    return c.camera.eye.z - transform_point(c.to_world, Vec3d(c.sphere.center)).z - reach >= near;
}

void check_bounds(const Case& c) {
    const View view{c.camera, 64, 48};
    const Pinhole pinhole = CameraModel(view).pinhole();
    const Mat4d to_object = inverse_affine(c.to_world);
    const Viewport viewport{view.width, view.height, pinhole.near};
    const PixelRect bounds = sphere_bounds(c.sphere, pinhole.world_to_pixel * c.to_world, viewport);
    PixelRect seen{view.width, view.height, 0, 0};
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            // Test the center and the corners of the pixel, because the tight box bounds the silhouette and not pixel
            // centers.
            bool any = false;
            for (const Vec2d at :
                 {Vec2d(x + 0.5, y + 0.5), Vec2d(x, y), Vec2d(x + 1, y), Vec2d(x, y + 1), Vec2d(x + 1, y + 1)})
                any = any || sees(pinhole.ray(at), c.sphere, to_object);
            if (any)
                seen = {std::min(seen.x0, x), std::min(seen.y0, y), std::max(seen.x1, x + 1), std::max(seen.y1, y + 1)};
        }
    CAPTURE(c.sphere.center.x);
    CAPTURE(c.sphere.center.y);
    CAPTURE(c.sphere.center.z);
    CAPTURE(c.sphere.radius);
    if (seen.empty()) return;
    CAPTURE(seen.x0);
    CAPTURE(bounds.x0);
    CAPTURE(seen.x1);
    CAPTURE(bounds.x1);
    CAPTURE(seen.y0);
    CAPTURE(bounds.y0);
    CAPTURE(seen.y1);
    CAPTURE(bounds.y1);
    REQUIRE(bounds.x0 <= seen.x0);
    REQUIRE(bounds.y0 <= seen.y0);
    REQUIRE(bounds.x1 >= seen.x1);
    REQUIRE(bounds.y1 >= seen.y1);
    // The bounds of an orthographic camera cover the whole sphere, even if the near plane cuts it.
    if (c.camera.projection == Camera::Projection::kOrthographic && !beyond_near(c, pinhole.near)) return;
    // The bounds must be tight if the silhouette is entirely inside the image: one pixel of margin, plus one for the
    // pixel corners.
    if (seen.x0 > 0 && seen.x1 < view.width && seen.y0 > 0 && seen.y1 < view.height) {
        CHECK(seen.x0 - bounds.x0 <= 3);
        CHECK(bounds.x1 - seen.x1 <= 3);
        CHECK(seen.y0 - bounds.y0 <= 3);
        CHECK(bounds.y1 - seen.y1 <= 3);
    }
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    Vec3d vector(double reach) { return {(*this)(-reach, reach), (*this)(-reach, reach), (*this)(-reach, reach)}; }
    Mat4d stretch() {
        const Vec3d axis = normalize(vector(1) + Vec3d(0, 0, 1e-3));
        // The numbers are drawn in separate statements because the evaluation order of operands is unspecified.
        const Mat4d first = rotation(axis, (*this)(0, 6));
        const Vec3d scale{(*this)(0.2, 2), (*this)(0.2, 2), -(*this)(0.2, 2)};
        const Mat4d second = rotation(axis, (*this)(0, 6));
        return translation(vector(2)) * second * scaling(scale) * first;
    }

private:
    std::mt19937 engine_;
};

Camera camera(Camera::Projection projection, double near) {
    Camera c;
    c.projection = projection;
    c.eye = {0, 0, 4};
    c.near = near;
    c.height = 4;
    c.fov_degrees = 60;
    return c;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("bounds hold every pixel that sees a sphere") {
        Random random(1);
        for (int i = 0; i < 1200; ++i) {
            // Cases range from distant spheres to spheres that cross the near plane or contain the eye.
            const auto projection = i % 3 == 0 ? Camera::Projection::kOrthographic : Camera::Projection::kPerspective;
            const double near = std::array{1e-4, 0.5, 2.0}[static_cast<std::size_t>(i) % 3];
            const Sphere sphere{Vec3(random.vector(4)), static_cast<float>(random(0.05, i % 2 == 0 ? 1 : 5))};
            check_bounds({camera(projection, near), sphere, Mat4d()});
        }
    }

    TEST_CASE("bounds hold every pixel that sees an ellipsoid, mirrored or not") {
        Random random(2);
        for (int i = 0; i < 1200; ++i) {
            const auto projection = i % 3 == 0 ? Camera::Projection::kOrthographic : Camera::Projection::kPerspective;
            const double near = std::array{1e-4, 0.5, 2.0}[static_cast<std::size_t>(i) % 3];
            const Sphere sphere{Vec3(random.vector(2)), static_cast<float>(random(0.2, 2))};
            check_bounds({camera(projection, near), sphere, random.stretch()});
        }
    }

    TEST_CASE("a huge sphere under the eye, as ground, and tiny far ones") {
        Camera ground = camera(Camera::Projection::kPerspective, 1e-5);
        ground.eye = {13, 2, 3};
        ground.look_at = {0, 0, 0};
        ground.fov_degrees = 20;
        check_bounds({ground, {Vec3(0, -1000, 0), 1000}, Mat4d()});
        ground.eye = {13, 1e-3, 3}; // the eye is a millimeter above the sphere
        check_bounds({ground, {Vec3(0, -1000, 0), 1000}, Mat4d()});
        check_bounds({camera(Camera::Projection::kPerspective, 1e-4), {Vec3(200, 100, -1000), 20}, Mat4d()});
        check_bounds({camera(Camera::Projection::kPerspective, 1e-4), {Vec3(0, 0, 4), 1}, Mat4d()}); // contains the eye
    }

    TEST_CASE("camera rays side by side are those of each alone, and meet spheres where those do: near, far, of any "
              "size, from inside") {
        Random random(3);
        int met = 0;
        for (int i = 0; i < 6000; ++i) {
            Camera c = camera(i % 3 == 0 ? Camera::Projection::kOrthographic : Camera::Projection::kPerspective,
                              i % 4 == 0 ? 1.5 : 1e-3);
            c.eye = c.eye + random.vector(1);
            const Pinhole pinhole = CameraModel({c, 64, 48}).pinhole();
            const double size = std::pow(10, random(-6, 6));
            DrawSphere sphere;
            // The sphere is around the line of sight or around the eye.
            const Vec3d about = i % 5 == 0 ? c.eye : c.eye - normalize(c.eye - c.look_at) * random(0, 5 * size);
            sphere.sphere = {Vec3(about + random.vector(0.5 * size)), static_cast<float>(size)};
            if (i % 11 == 0) {
                sphere.identity = false;
                sphere.to_world = Mat4(random.stretch());
                sphere.to_object = Mat4(inverse_affine(Mat4d(sphere.to_world)));
            }
            alignas(64) std::array<double, Doubles::size> x, y;
            for (std::size_t k = 0; k < x.size(); ++k) x[k] = random(0, 64), y[k] = random(0, 48);
            const CameraRays rays(pinhole, Doubles::load_aligned(x.data()), Doubles::load_aligned(y.data()));
            const Doubles found = sphere.intersect(rays);
            for (std::size_t k = 0; k < x.size(); ++k) {
                const Rayd exact = pinhole.ray({x[k], y[k]});
                const Ray ray = rays.at(k, 0);
                REQUIRE(ray.origin == Vec3(exact.origin));
                REQUIRE(ray.direction == Vec3(exact.direction));
                REQUIRE(rays.t_min.get(k) == exact.t_min);
                const std::optional<float> t = sphere.intersect(ray);
                REQUIRE(found.get(k) == (t ? static_cast<double>(*t) : std::numeric_limits<double>::infinity()));
                met += t.has_value();
            }
        }
        CHECK(met > 8'000);
        CHECK(met < 6000 * static_cast<int>(Doubles::size) - 2'000);
    }

    TEST_CASE("what lies behind the eye or beside the image has empty bounds") {
        const View view{camera(Camera::Projection::kPerspective, 1e-3), 64, 48};
        const Pinhole pinhole = CameraModel(view).pinhole();
        const Viewport viewport{64, 48, pinhole.near};
        CHECK(sphere_bounds({Vec3(0, 0, 6), 1.9f}, pinhole.world_to_pixel, viewport).empty());
        CHECK(sphere_bounds({Vec3(50, 0, 0), 1}, pinhole.world_to_pixel, viewport).empty());
        CHECK(sphere_bounds({Vec3(0, -50, 0), 1}, pinhole.world_to_pixel, viewport).empty());
        CHECK_FALSE(sphere_bounds({Vec3(0, 0, 6), 2.1f}, pinhole.world_to_pixel, viewport).empty());
    }
}
