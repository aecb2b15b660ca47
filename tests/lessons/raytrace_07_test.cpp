// Lesson raytrace-07: its camera's rays are those of the library, pinhole and thin lens.
#include "common/camera/camera.h"
#include "common/sampling/warp.h"
#include "raytrace/lessons/07-camera/camera.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

using namespace duet;

namespace {

/// A random point of a cube around zero.
Vec3 random_point(lesson::Random& random, float reach) {
    const float x = random.next(), y = random.next(), z = random.next();
    return (Vec3(x, y, z) * 2.0f - Vec3(1, 1, 1)) * reach;
}

/// The same camera for the library.
View library_view(const lesson::View& view, int width, int height) {
    Camera camera;
    camera.eye = Vec3d(view.eye), camera.look_at = Vec3d(view.look_at), camera.up = Vec3d(view.up);
    camera.fov_degrees = static_cast<double>(view.fov_degrees);
    camera.aperture_radius = static_cast<double>(view.aperture_radius);
    camera.focus_distance = static_cast<double>(view.focus_distance);
    return {camera, width, height};
}

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("raytrace-07: the library's camera has the lesson's rays") {
        lesson::Random random(7);
        int views = 0;
        for (int i = 0; i < 400; ++i) {
            lesson::View view{.eye = random_point(random, 9), .look_at = random_point(random, 3)};
            view.up = random_point(random, 2);
            view.fov_degrees = 10 + 90 * random.next();
            view.aperture_radius = i % 2 == 0 ? 0 : 0.3f * random.next();
            view.focus_distance = 1 + 9 * random.next();
            const Vec3 forward = view.look_at - view.eye;
            if (length(cross(forward, view.up)) < 0.2f * length(forward) * length(view.up)) continue;
            ++views;
            const int width = 100 + i, height = 500 - i;
            const lesson::Camera camera(view, width, height);
            const CameraModel model(library_view(view, width, height));
            for (int k = 0; k < 20; ++k) {
                const float x = random.next() * static_cast<float>(width),
                            y = random.next() * static_cast<float>(height);
                const float u = random.next(), v = random.next();
                const Ray mine = camera.ray(x, y, concentric_disk(Vec2(u, v)));
                const Ray theirs = model.ray(Vec2d(Vec2(x, y)), Vec2d(Vec2(u, v)));
                REQUIRE(length(mine.origin - theirs.origin) < 5e-6f);
                REQUIRE(length(mine.direction - theirs.direction) < 5e-6f);
            }
        }
        CHECK(views > 300);
    }

    TEST_CASE("raytrace-07: hand-computed rays") {
        // 90 degrees of view, 200 × 100: the upper edge is 45 degrees up, the right edge has x = 2 at distance 1.
        const lesson::Camera camera({}, 200, 100);
        const auto near = [](Vec3 a, Vec3 b) { return length(a - normalize(b)) < 1e-6f; };
        CHECK(near(camera.ray(100, 50, Vec2(0, 0)).direction, {0, 0, -1}));
        CHECK(near(camera.ray(100, 0, Vec2(0, 0)).direction, {0, 1, -1}));
        CHECK(near(camera.ray(200, 50, Vec2(0, 0)).direction, {2, 0, -1}));
        // From (3, 0, 0) to zero: what is to the right is at -z.
        const lesson::Camera aside({.eye = {3, 0, 0}, .look_at = {0, 0, 0}}, 200, 100);
        CHECK(near(aside.ray(200, 50, Vec2(0, 0)).direction, {-1, 0, -2}));
    }

    TEST_CASE("raytrace-07: all rays of a point meet in the sharp plane, and beyond it in a disk of the known radius") {
        // Radius of the lens 0.25, sharp at 4: at the distance 10 the disk's radius is 0.25 · (10 - 4) / 4 = 0.375.
        const lesson::Camera camera({.fov_degrees = 40, .aperture_radius = 0.25f, .focus_distance = 4}, 100, 100);
        const auto at_depth = [](const Ray& ray, float depth) {
            return ray.at((-depth - ray.origin.z) / ray.direction.z);
        };
        const Ray center = camera.ray(20, 70, Vec2(0, 0));
        const Vec3 sharp = at_depth(center, 4), beyond = at_depth(center, 10);
        lesson::Random random(9);
        float most = 0;
        for (int i = 0; i < 10'000; ++i) {
            const Ray ray = camera.ray(20, 70, random);
            REQUIRE(length(at_depth(ray, 4) - sharp) < 2e-6f);
            most = std::max(most, length(at_depth(ray, 10) - beyond));
        }
        CHECK(most < 0.37501f);
        CHECK(most > 0.37f);
    }

    TEST_CASE("raytrace-07: points of the lens are evenly spread, as the library's are") {
        // Of 160 000 points each of sixteen rings of the same area gets 10 000 on average, with the standard deviation
        // 97; the limit is five of them. So for sixteen sectors.
        constexpr int kPoints = 160'000;
        lesson::Random random(11);
        for (const bool library : {false, true}) {
            std::array<int, 16> rings{}, sectors{};
            for (int i = 0; i < kPoints; ++i) {
                const float u = random.next(), v = random.next();
                const Vec2 p = library ? concentric_disk(Vec2(u, v)) : lesson::random_in_disk(random);
                ++rings[static_cast<std::size_t>(min(16 * dot(p, p), 15.0f))];
                const float turn = std::atan2(p.y, p.x) / (2 * kPi) + 0.5f;
                ++sectors[static_cast<std::size_t>(min(16 * turn, 15.0f))];
            }
            for (const auto& bins : {rings, sectors})
                for (const int bin : bins) CHECK(std::abs(bin - kPoints / 16) < 490);
        }
    }
}
