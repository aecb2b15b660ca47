// These tests check that the hall of models/ is closed: from inside, the sky is visible only through the windows, the
// gap along the crown and the open end.
#include "common/scene/scene.h"
#include "raytrace/acceleration/accelerator.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace duet;

namespace {

// These dimensions are those of models/hall.cpp, in meters: the nave and the aisles, viewed along z.
constexpr double kHalfNave = 5, kHalfWidth = 9, kEnd = 18, kBay = 6, kVault = 8, kRoof = 5.6;
constexpr double kFoot = 1.6; // of the windows

class Random {
public:
    double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    double side() { return engine_() % 2 == 0 ? -1 : 1; }

private:
    std::mt19937 engine_{1};
};

/// Returns a position where a camera may be: in the nave, under its vault, or in an aisle.
Vec3d inside(Random& random) {
    const double z = random(-17, 17);
    if (random(0, 1) < 0.5) return {random.side() * random(5.8, 8.5), random(0.3, 5.2), z};
    return {random(-4, 4), random(0.3, 10), z};
}

/// Returns whether (along, height) is inside an arched opening or within a millimeter of it.
bool in_arch(Vec2d p, double half, double foot, double spring) {
    constexpr double kRoom = 0.001;
    const double along = p.x - kBay * (std::floor(p.x / kBay) + 0.5); // from the bay's center
    if (std::abs(p.x) > kEnd || p.y < foot - kRoom || std::abs(along) > half + kRoom) return false;
    return p.y < spring || std::hypot(along, p.y - spring) < half + kRoom;
}

/// Returns whether a ray that hits nothing leaves through an opening.
bool leaves_by_opening(const Rayd& ray) {
    const auto at = [&](std::size_t axis, double place) {
        return ray.at((place - ray.origin[axis]) / ray.direction[axis]);
    };
    const Vec3d d = ray.direction, end = at(2, std::copysign(kEnd, d.z)), crown = at(1, kVault + kHalfNave);
    const Vec3d window = at(0, std::copysign(kHalfWidth, d.x)), arch = at(0, std::copysign(kHalfNave, d.x));
    if (d.z > 0 && std::abs(end.x) < kHalfWidth && end.y < (std::abs(end.x) < kHalfNave ? kVault + kHalfNave : kRoof))
        return true;
    if (d.z < 0 && std::hypot(end.x, end.y - kVault) < 1.601) return true; // the round window
    if (in_arch({window.z, window.y}, 1.1, kFoot, 3.4)) return true;
    // The ray leaves over the roof of the opposite aisle.
    if (ray.origin.x * std::copysign(1.0, d.x) < kHalfNave && in_arch({arch.z, arch.y}, 2.4, kRoof, 4.2)) return true;
    // The gap along the crown is 18 degrees wide. Coffers beside it are up to 0.18 m deeper than the vault.
    return d.y > 0 && std::abs(crown.z) < 9 && std::abs(crown.x) < 1.2 * kHalfNave * std::sin(0.05 * kPiDouble);
}

Scene hall() { return load_scene(std::filesystem::path(DUET_SOURCE_DIR) / "models/hall.json"); }

Ray ray_to(Vec3d from, Vec3d to) { return {Vec3(from), Vec3(normalize(to - from))}; }

/// Returns the center of a bay, along z.
double bay(Random& random) { return kBay * (std::floor(random(-3, 3)) + 0.5); }

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("no ray from within the hall meets the sky but by an opening: anywhere, below windows, at the far "
              "wall's edge") {
        const Scene scene = hall();
        const raytrace::Accelerator accelerator(scene, 0);
        Random random;
        const auto target = [&](int kind, Vec3d from) -> Vec3d {
            if (kind == 0) return from + Vec3d(random(-1, 1), random(-1, 1), random(-1, 1));
            if (kind == 1) // the wall below a window
                return {random.side() * (kHalfWidth + random(-0.25, 0.25)), random(0, kFoot),
                        bay(random) + random(-1.2, 1.2)};
            // The vault's surface is known to a few millimeters.
            const double angle = random(0, kPiDouble), radius = kHalfNave + random(-0.006, 0.002);
            return {radius * std::cos(angle), kVault + radius * std::sin(angle), -kEnd};
        };
        int out = 0;
        for (int trial = 0; trial < 600'000; ++trial) {
            const Vec3d from = inside(random), to = target(trial % 3, from);
            const Ray ray = ray_to(from, to);
            if (accelerator.closest(ray).valid()) continue;
            ++out;
            CAPTURE(from.x);
            CAPTURE(from.y);
            CAPTURE(from.z);
            CAPTURE(to.x);
            CAPTURE(to.y);
            CAPTURE(to.z);
            REQUIRE(leaves_by_opening(Rayd{Vec3d(ray.origin), Vec3d(ray.direction)}));
        }
        CHECK(out > 1000);
    }

    TEST_CASE("the hall's windows have sills: nothing looks down between the two faces of a wall") {
        const Scene scene = hall();
        const raytrace::Accelerator accelerator(scene, 0);
        Random random;
        int missed = 0;
        for (int trial = 0; trial < 10'000; ++trial) {
            const double side = random.side(), middle = bay(random);
            const Vec3d from(side * random(6, 8.5), random(2, 3.4), middle + random(-0.8, 0.8));
            const Vec3d to(side * (kHalfWidth + random(-0.24, 0.24)), kFoot, middle + random(-1, 1));
            missed +=
                std::abs(static_cast<double>(accelerator.closest(ray_to(from, to)).t) - length(to - from)) > 0.001;
        }
        CHECK(missed == 0);
    }
}
