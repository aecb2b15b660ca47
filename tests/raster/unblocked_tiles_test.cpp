// These tests check that tiles without shadows are found: none that has one, and most of the others.
#include "tests/raster/scenes.h"

#include "raster/gbuffer/gbuffer_pass.h"
#include "raster/shadows/unblocked_tiles.h"
#include "raytrace/acceleration/accelerator.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;
using namespace duet::test;
using namespace duet::raster;

namespace {

class Numbers {
public:
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    Vec3d point(const Box3d& box) {
        return {between(box.low.x, box.high.x), between(box.low.y, box.high.y), between(box.low.z, box.high.z)};
    }
    /// Returns a box that may be flat along some axes.
    Box3d box(double spread, double size) {
        const Vec3d low(between(-spread, spread), between(-spread, spread), between(-spread, spread));
        const auto side = [&] { return between(0, 1) < 0.2 ? 0.0 : between(0, size); };
        return {low, low + Vec3d(side(), side(), side())};
    }

private:
    std::mt19937 engine_{5};
};

/// Returns the G-buffer of a scene from its camera.
GBuffer gbuffer_of(const RasterSceneData& data, int width, int height) {
    const PassView pass = center_view({data.scene.camera, width, height});
    const TileGrid grid{{0, 0, width, height}};
    const auto geometry = data.geometries->take();
    process_geometry(data, grid, pass, {}, *geometry);
    GBuffer gbuffer(ScreenProjection(pass.pinhole, SampleOffset()), width, height, optional_planes(data.scene));
    Planes3 emission(width, height);
    const RasterSettings settings;
    const Control control;
    fill_gbuffer({data, settings, *geometry, nullptr, pass, grid, SampleOffset(), control}, gbuffer, emission);
    return gbuffer;
}

} // namespace

TEST_SUITE("unit") {

    // A point of the shaft lies on a line between a point of each box.
    TEST_CASE("a box misses the shaft of two others only if no point of the shaft lies in it, and mostly then") {
        Numbers numbers;
        int missed = 0, unmet = 0;
        for (int trial = 0; trial < 3000; ++trial) {
            const Box3d a = numbers.box(4, 2), b = numbers.box(4, 2), box = numbers.box(4, 3);
            const bool misses = misses_shaft(a, b, box);
            bool met = false;
            for (int k = 0; k < 2000 && !met; ++k) {
                const double t = numbers.between(0, 1);
                const Vec3d p = numbers.point(a) * (1 - t) + numbers.point(b) * t;
                met = p.x >= box.low.x && p.y >= box.low.y && p.z >= box.low.z && p.x <= box.high.x &&
                      p.y <= box.high.y && p.z <= box.high.z;
            }
            REQUIRE_FALSE((misses && met));
            missed += misses, unmet += !met;
        }
        CHECK(missed > 0.93 * unmet); // measured: 0.95
    }

    TEST_CASE("rays from the points of an unblocked tile to its light are unblocked") {
        for (const char* const name : {"cornell", "veach", "glass", "demo"}) {
            CAPTURE(name);
            const Scene scene = load_scene(std::string(DUET_SOURCE_DIR "/models/") + name + ".json");
            RasterSettings settings = plain();
            settings.shadow_map_side = 64;
            const RasterScene prepared = prepare(scene, settings);
            const raytrace::Accelerator accelerator(scene, 0);
            constexpr int kWidth = 320, kHeight = 180;
            const GBuffer gbuffer = gbuffer_of(prepared.data(), kWidth, kHeight);
            const UnblockedTiles unblocked(prepared.data(), gbuffer, 2);
            const Shadows& shadows = *prepared.data().shadows;
            Numbers numbers;
            int rays = 0, blocked = 0;
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x) {
                    if (gbuffer.object(x, y) < 0) continue;
                    for (std::size_t source = 0; source < shadows.sources().size(); ++source) {
                        if (!unblocked.contains(source, x, y)) continue;
                        const std::vector<std::size_t>& lights = shadows.sources()[source].lights;
                        const Light& light = scene.lights[lights[static_cast<std::size_t>(x) % lights.size()]];
                        const std::size_t lane = static_cast<std::size_t>(x) % Floats::size;
                        const Vec3T<Floats> p = gbuffer.points(x - static_cast<int>(lane), y);
                        const Vec3 n = gbuffer.normal.vector_at(x, y);
                        const Vec3 at(gbuffer.projection.eye() +
                                      Vec3d(Vec3(p.x.get(lane), p.y.get(lane), p.z.get(lane))));
                        const Vec2 u(static_cast<float>(numbers.between(0, 1)),
                                     static_cast<float>(numbers.between(0, 1)));
                        const auto sample = sample_light(light, at, u);
                        if (!sample || dot(sample->wi, n) < 0.05f) continue;
                        Ray ray{at + n * 1e-3f, sample->wi};
                        Hit end;
                        end.t = sample->distance * 0.998f;
                        if (const auto* surface = std::get_if<SurfaceLight>(&light))
                            end.object = surface->object, end.primitive = surface->primitive;
                        ++rays;
                        blocked += accelerator.occluded(ray, end);
                    }
                }
            CAPTURE(rays);
            CHECK(rays > 5000);
            CHECK(blocked == 0);
        }
    }
}
