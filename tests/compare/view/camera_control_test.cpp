// These tests check how the mouse moves a camera.
#include "compare/view/camera_control.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

using namespace duet;
using namespace duet::compare;

namespace {

const Camera kFront{.eye = {0, 0, 5}, .look_at = {0, 0, 0}};

void check_near(Vec3d a, Vec3d b, double scale = 1) { CHECK(length(a - b) < 4e-6 * scale); }

double view_distance(const Camera& camera) { return length(camera.look_at - camera.eye); }

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("orbits keep the distance and what the camera looks at") {
        const Camera right = orbit(kFront, radians(90.0), 0);
        check_near(right.eye, {5, 0, 0}, 5);
        check_near(orbit(kFront, 0, radians(30.0)).eye, {0, 2.5, 5 * std::cos(radians(30.0))}, 5);
        Camera camera = kFront;
        for (int i = 0; i < 1000; ++i) camera = orbit(camera, 0.1, 0.003 * (i % 7 - 3));
        CHECK(view_distance(camera) == doctest::Approx(5).epsilon(1e-3));
        CHECK(camera.look_at == kFront.look_at);
    }

    TEST_CASE("no orbit turns the camera over, and one back ends where it began") {
        const Camera above = orbit(kFront, 0, 10), below = orbit(kFront, 0, -10);
        CHECK(above.eye.y == doctest::Approx(5 * std::cos(radians(1.0))).epsilon(1e-5));
        CHECK(below.eye.y == doctest::Approx(-5 * std::cos(radians(1.0))).epsilon(1e-5));
        check_near(orbit(orbit(kFront, 0.7, 0.4), 0, -0.4).eye, orbit(kFront, 0.7, 0).eye, 5);
        const Camera pole{.eye = {0, 5, 0}, .look_at = {0, 0, 0}, .up = {0, 1, 0}}; // looks along its up vector
        CHECK(std::isfinite(orbit(pole, 0.1, 0.1).eye.x));
    }

    TEST_CASE("looking around moves the look-at point alone") {
        const Camera right = look_around(kFront, radians(90.0), 0);
        CHECK(right.eye == kFront.eye);
        check_near(right.look_at, {5, 0, 5}, 5);
        check_near(look_around(kFront, 0, radians(30.0)).look_at, {0, 2.5, 5 - 5 * std::cos(radians(30.0))}, 5);
    }

    TEST_CASE("panning by one shifts the image by its height") {
        const Camera camera = pan(kFront, 0, 1);
        const View view{camera, 100, 100};
        const Vec3d shifted = CameraModel(view).pinhole().project(kFront.look_at);
        CHECK(shifted.y == doctest::Approx(150).epsilon(1e-4)); // from the middle, 50, down by 100
        check_near(camera.eye - camera.look_at, kFront.eye - kFront.look_at, 5);
        CHECK(pan(kFront, 1, 0).eye.x > 0);
    }

    TEST_CASE("dolly, fly and focus") {
        CHECK(view_distance(dolly(kFront, 0.5)) == doctest::Approx(2.5));
        Camera plan = kFront;
        plan.projection = Camera::Projection::kOrthographic;
        CHECK(dolly(plan, 0.5).height == doctest::Approx(1));
        CHECK(dolly(plan, 0.5).eye == plan.eye);
        check_near(fly(kFront, 0.2, 0, 0).eye, {0, 0, 4}, 5);
        check_near(fly(kFront, 0, 0.2, 0.4).eye, {1, 2, 5}, 5);
        const Camera focused = look_at_point(kFront, {1, 0, 0});
        check_near(focused.look_at, {1, 0, 0});
        CHECK(look_at_point(kFront, kFront.eye).look_at == kFront.look_at);
    }

    TEST_CASE("no wheel brings the eye to what it looks at") {
        Camera camera{.eye = {100, 0, 5}, .look_at = {100, 0, 0}};
        for (int i = 0; i < 1000; ++i) camera = dolly(camera, 0.9);
        CHECK(view_distance(camera) > 1e-3);
        CHECK(view_distance(camera) < 1.3e-3);
        camera = frame_box(camera, Box3{{100, 0, 0}, {100, 0, 0}}, 1);
        CHECK(view_distance(camera) > 1e-3);
    }

    TEST_CASE("a framed box is in the image, and fills half of it at least") {
        const Box3 box{{1, 2, 3}, {2, 4, 4}};
        for (const double aspect : {0.3, 1.0, 2.0})
            for (const auto projection : {Camera::Projection::kPerspective, Camera::Projection::kOrthographic}) {
                Camera camera = orbit(kFront, 0.4, 0.3);
                camera.projection = projection;
                camera = frame_box(camera, box, aspect);
                const View view{camera, static_cast<int>(1000 * aspect), 1000};
                const Pinhole pinhole = CameraModel(view).pinhole();
                double low = 1e9, high = -1e9;
                for (int corner = 0; corner < 8; ++corner) {
                    const Vec3d p(corner & 1 ? 2 : 1, corner & 2 ? 4 : 2, corner & 4 ? 4 : 3);
                    const Vec3d pixel = pinhole.project(p);
                    CHECK((pixel.x >= 0 && pixel.y >= 0 && pixel.x <= view.width && pixel.y <= view.height));
                    low = std::min(low, pixel.y), high = std::max(high, pixel.y);
                }
                if (aspect >= 1) CHECK(high - low > 500);
            }
        CHECK(frame_box(kFront, Box3(), 1).eye == kFront.eye);
    }

    TEST_CASE("the camera's numbers are short at every scale") {
        for (const double scale : {1e-6, 1.0, 1e6}) {
            const Camera camera{.eye = {0, 0, 5 * scale}, .look_at = {0, 0, 0}};
            const Camera turned = orbit(camera, 0.3, 0.2);
            for (const double x : {turned.eye.x, turned.eye.y, turned.eye.z}) {
                char text[32];
                std::snprintf(text, sizeof text, "%.7g", x);
                CHECK(std::strtod(text, nullptr) == x);
            }
            CHECK(view_distance(turned) == doctest::Approx(5 * scale).epsilon(1e-5));
        }
    }
}
