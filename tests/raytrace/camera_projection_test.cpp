// These tests compare where the camera sees a point, for paths from the lights, with the rays of the camera.
#include "raytrace/bidirectional/camera_projection.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

TEST_SUITE("unit") {
    // The pixel density is the inverse of the area, across the ray, that the rays of a small square of the image cover.
    TEST_CASE("a point is seen by the pixel whose ray hits it, at the density of those rays") {
        View view{Camera{}, 80, 60};
        view.camera.eye = {1, 2, 5};
        view.camera.look_at = {0, 0.5, 0};
        view.camera.aperture_radius = 0.2;
        for (const auto projection : {Camera::Projection::kPerspective, Camera::Projection::kOrthographic}) {
            view.camera.projection = projection;
            const Pinhole pinhole = CameraModel(view).pinhole({0.9, 0.3});
            const auto at = [&](double x, double y, double t) {
                const Rayd ray = pinhole.ray({x, y});
                return ray.origin + ray.direction * t;
            };
            const double x = 12.3, y = 51.7, step = 1e-4;
            const Vec3d p = at(x, y, 4), direction = pinhole.ray({x, y}).direction;
            const auto seen = seen_through(pinhole, p);
            REQUIRE(seen.has_value());
            CHECK(seen->pixel.x == doctest::Approx(x));
            CHECK(seen->pixel.y == doctest::Approx(y));
            CHECK(length(seen->to_camera + direction) < 1e-9);
            CHECK(seen->distance == doctest::Approx(4 - pinhole.ray({x, y}).t_min));
            const Vec3d dx = (at(x + step, y, 4) - p) / step, dy = (at(x, y + step, 4) - p) / step;
            CHECK(seen->pixel_density == doctest::Approx(1 / std::abs(dot(cross(dx, dy), direction))).epsilon(1e-3));
            CHECK(!seen_through(pinhole, pinhole.origin + pinhole.forward * (pinhole.near * 0.9)).has_value());
        }
    }
}
