// These tests check that the shadow map views of a sun resolve what the camera resolves, near and far.
#include "tests/raster/scenes.h"

#include "raster/shadows/light_views.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raster;
using namespace duet::test;

namespace {

constexpr int kSide = 1024;

/// Returns points of a floor in a long hall from 2 m to 40 m in front of the camera. Each has the width of a pixel of
/// an image 100 pixels high.
std::vector<VisiblePoint> hall_floor() {
    std::vector<VisiblePoint> seen;
    for (double z = 2; z < 40; z *= 1.05)
        for (double x = -0.8; x <= 0.8; x += 0.1) seen.push_back({Vec3d(std::clamp(x * z, -5.0, 5.0), 0, -z), z / 100});
    return seen;
}

/// Returns whether the point is inside a shadow view, at least `texels` from its edges.
bool holds(const Camera& view, Vec3d p, double texels) {
    const Vec3d h = CameraModel({view, kSide, kSide}).pinhole().project(p);
    return h.x >= texels && h.y >= texels && h.x <= kSide - texels && h.y <= kSide - texels;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a sun in a hall: the floor at the camera's feet is seen through a map of its own, what is far through "
              "wider ones") {
        const SunLight sun{normalize(Vec3(-0.5f, -0.75f, -0.4f)), Rgb(1)};
        const Box3 casters{Vec3(-6, 0, -41), Vec3(6, 9, 1)};
        const Camera camera = look({0, 1.7, 0}, {0, 1.7, -20}, 60);
        const std::vector<VisiblePoint> seen = hall_floor();
        const std::vector<Camera> views = sun_views(sun, 0, casters, camera, seen, kSide, 4),
                                  others = sun_views(sun, 0, casters, camera, {}, kSide, 4);
        REQUIRE(views.size() > 1);
        CHECK(std::ranges::is_sorted(views, {}, &Camera::height));
        CHECK(views.front().height < 0.4 * others.front().height);
        for (const VisiblePoint& s : seen) {
            CAPTURE(s.p.z);
            const auto view = std::ranges::find_if(views, [&](const Camera& v) { return holds(v, s.p, 2.5); });
            REQUIRE(view != views.end());
            if (s.width < 0.05) CHECK(view == views.begin());
            CHECK(view->height <= others.front().height);
        }
    }

    TEST_CASE("a sun over what is seen at one distance: no map for a gain of little") {
        const SunLight sun{normalize(Vec3(0.2f, -1, 0.1f)), Rgb(1)};
        const Box3 casters{Vec3(-1, 0, -1), Vec3(1, 1, 1)};
        const Camera camera = look({0, 3, 3}, {0, 0, 0}, 40);
        std::vector<VisiblePoint> seen;
        for (int i = 0; i < 400; ++i)
            seen.push_back({Vec3d(i % 20 * 1.8 / 19 - 0.9, 0, i / 20 * 1.8 / 19 - 0.9), 0.01});
        CHECK(sun_views(sun, 0, casters, camera, seen, kSide, 4).size() ==
              sun_views(sun, 0, casters, camera, {}, kSide, 4).size());
    }
}
