// These tests check that the camera maps pixels to rays and points to pixels consistently, through any point of the
// lens.
#include "common/camera/camera.h"

#include <doctest/doctest.h>

#include <random>
#include <vector>

using namespace duet;

namespace {

View random_view(std::mt19937& engine, Camera::Projection projection) {
    std::uniform_real_distribution<double> u(-1, 1);
    View view;
    view.camera.projection = projection;
    view.camera.eye = Vec3d(u(engine), u(engine), u(engine)) * 10.0;
    view.camera.look_at = Vec3d(u(engine), u(engine), u(engine));
    view.camera.fov_degrees = 60 + 50 * u(engine);
    view.camera.height = 2 + u(engine);
    view.camera.aperture_radius = 0.2;
    view.camera.focus_distance = 3;
    view.width = 200;
    view.height = 100;
    return view;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("project(ray(x, y).at(t)) is (x, y), for each projection and lens point") {
        std::mt19937 engine(7);
        std::uniform_real_distribution<double> u(0, 1);
        for (int trial = 0; trial < 2000; ++trial) {
            const View view =
                random_view(engine, trial % 2 ? Camera::Projection::kPerspective : Camera::Projection::kOrthographic);
            const CameraModel model(view);
            const Vec2d pixel(u(engine) * 200, u(engine) * 100), lens(u(engine), u(engine));
            const Pinhole pinhole = model.pinhole(lens);
            const Rayd ray = pinhole.ray(pixel);
            const double t = 0.5 + 20 * u(engine);
            const Vec3d projected = pinhole.project(ray.at(t));
            CHECK(projected.x == doctest::Approx(pixel.x).epsilon(1e-9));
            CHECK(projected.y == doctest::Approx(pixel.y).epsilon(1e-9));
            CHECK(projected.z == doctest::Approx(t * dot(ray.direction, pinhole.forward)).epsilon(1e-9));
            const Ray rounded = model.ray(pixel, lens);
            CHECK(length(Vec3d(rounded.direction) - ray.direction) < 1e-6);
            CHECK(length(Vec3d(rounded.origin) - ray.origin) < 1e-5);
        }
    }

    TEST_CASE("many rays at once are those one by one, to the bit, and start where through() stands") {
        std::mt19937 engine(9);
        std::uniform_real_distribution<float> u(0, 1);
        for (int trial = 0; trial < 40; ++trial) {
            View view =
                random_view(engine, trial % 4 ? Camera::Projection::kPerspective : Camera::Projection::kOrthographic);
            if (trial % 3 == 0) view.camera.aperture_radius = 0;
            const CameraModel model(view);
            // The counts give whole batches and batches with a remainder.
            std::vector<CameraModel::Sample> points(static_cast<std::size_t>(1 + trial));
            for (CameraModel::Sample& point : points) {
                point.pixel = Vec2d(static_cast<double>(200 * u(engine)), static_cast<double>(100 * u(engine)));
                point.lens = trial % 5 == 0 ? Vec2(0.5f, 0.5f) : Vec2(u(engine), u(engine));
                point.time = u(engine);
            }
            std::vector<Ray> rays(points.size());
            model.rays(points, rays);
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Vec2d lens(points[i].lens);
                const Ray one = model.ray(points[i].pixel, lens, static_cast<double>(points[i].time));
                CHECK(rays[i].origin == one.origin);
                CHECK(rays[i].direction == one.direction);
                CHECK(rays[i].t_min == one.t_min);
                CHECK(rays[i].t_max == one.t_max);
                CHECK(rays[i].time == one.time);
                const Pinhole pinhole = model.pinhole(lens);
                // The ray's direction must aim from the rounded origin at the focus point. If it aimed from the
                // unrounded origin, the error would exceed the rounding of the direction.
                CHECK(length(Vec3d(one.direction) - pinhole.ray(points[i].pixel).direction) < 1.5 * 0x1p-25);
                if (view.camera.projection == Camera::Projection::kPerspective)
                    CHECK(Vec3d(Vec3(pinhole.origin)) == pinhole.origin);
            }
        }
    }

    TEST_CASE("rays through all of the lens meet in the plane of focus, and only there") {
        std::mt19937 engine(8);
        std::uniform_real_distribution<double> u(0, 1);
        const View view = random_view(engine, Camera::Projection::kPerspective);
        const CameraModel model(view);
        const auto at_depth = [&](Vec2d lens, double depth) {
            const Pinhole pinhole = model.pinhole(lens);
            const Rayd ray = pinhole.ray({31, 77});
            return ray.at(depth / dot(ray.direction, pinhole.forward));
        };
        const Vec3d focus = at_depth({0.5, 0.5}, 3);
        for (int trial = 0; trial < 100; ++trial) {
            const Vec2d lens(u(engine), u(engine));
            CHECK(length(at_depth(lens, 3) - focus) < 1e-6);
        }
        CHECK(length(at_depth({0.99, 0.5}, 6) - at_depth({0.01, 0.5}, 6)) > 0.3);
    }

    TEST_CASE("conventions: row 0 is the top, x runs right, the image spans the vertical field of view") {
        View view;
        view.camera.eye = {0, 0, 5};
        view.camera.look_at = {0, 0, 0};
        view.camera.fov_degrees = 90;
        view.width = 40;
        view.height = 20;
        const Pinhole pinhole = CameraModel(view).pinhole();
        CHECK(pinhole.project({0, 5, 0}).y == doctest::Approx(0));
        CHECK(pinhole.project({0, -5, 0}).y == doctest::Approx(20));
        CHECK(pinhole.project({10, 0, 0}).x == doctest::Approx(40));
        CHECK(pinhole.project({0, 0, 0}).z == doctest::Approx(5));
        CHECK(pinhole.ray({20, 10}).t_min == doctest::Approx(5e-6));
    }

    TEST_CASE("looking straight along up still gives an image") {
        View view;
        view.camera.eye = {0, 5, 0};
        view.camera.look_at = {0, 0, 0};
        view.width = view.height = 10;
        const Vec3d p = CameraModel(view).pinhole().project({0, 0, 0});
        CHECK(p.x == doctest::Approx(5));
        CHECK(p.y == doctest::Approx(5));
    }

} // TEST_SUITE
