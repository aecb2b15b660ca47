// Where samples lie on their triangles, side by side: in float as the error bounds of raster/solve.h say, in double exactly.
#include "raster/cover.h"
#include "raster/solve.h"
#include "tests/raster/varied_scene.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;
using namespace duet::test;

namespace {

/// Triangles of all shapes, down to slivers whose length is a million times their height; under them a ground to the horizon.
Scene slivers() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-1, 1), digits(0, 6);
    Mesh mesh;
    const auto point = [&] { return Vec3(place(random), place(random), place(random)); };
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const Vec3 a = point() * 2.0f, along = point(), across = cross(along, point()) * std::pow(10.0f, -digits(random));
        for (const Vec3 p : {a, a + along, a + along * place(random) + across}) mesh.positions.push_back(p);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3 p : {Vec3(-1e4f, -1, -1e4f), Vec3(0, -1, 1e4f), Vec3(1e4f, -1, -1e4f)}) mesh.positions.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 2});
    Scene scene;
    add(scene, mesh);
    finish_scene(scene);
    return scene;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("barycentrics and depths in float are as exact as is said, of slivers, too, and right where they are not") {
        using raster::kStrip, raster::NoVaryings, raster::StripSolver;
        const Scene scene = slivers();
        const raster::Settings settings;
        const raster::Prepared prepared = raster::prepare(scene, settings);
        for (const View& view : {perspective(), orthographic()}) {
            const Pinhole pinhole = CameraModel(view).through();
            const raster::PassView pass{pinhole, 0, raster::viewport_of(view, pinhole), {{37, 201}}};
            const raster::TileGrid grid{{0, 0, view.width, view.height}};
            raster::Geometry geometry;
            process_geometry(prepared.data(), grid, pass, settings, geometry);
            const NoVaryings nothing;
            int seen = 0, close = 0, mended = 0;
            double worst = 0, worst_mended = 0;
            for (std::size_t t = 0; t < grid.size(); ++t) {
                const raster::PixelRect rect = grid.tile(t);
                raster::DepthTile depths;
                cover(geometry, pass, pass.samples[0], rect, t, depths);
                StripSolver<NoVaryings, float> in_float(geometry.triangles, pass, rect, nothing, false);
                StripSolver<NoVaryings, double> in_double(geometry.triangles, pass, rect, nothing, false);
                std::vector<raster::StripPlace> places;
                for (int y = rect.y0; y < rect.y1; y += 2)
                    for (int x = rect.x0; x < rect.x1; x += 8) places.push_back(strip_place(depths, x, y));
                std::vector<std::uint32_t> inside(places.size());
                in_double.solve(places, false, [&](std::size_t s, const auto& strip) { inside[s] = strip.inside; });
                in_float.solve(places, true, [&](std::size_t s, const auto& strip) {
                    CHECK((strip.inside & ~inside[s]) == 0);
                    for (std::size_t i = 0; i < kStrip; ++i) {
                        if (!(strip.samples->on_mesh >> i & 1)) continue;
                        const raster::Interpolated wanted =
                            interpolate(geometry.triangles.whole(strip.samples->id(i)), places[s].position(i));
                        const double depth = wanted.depth_sum / wanted.sum;
                        const double error = std::max({std::abs(static_cast<double>(strip.b1[i]) - wanted.b1 / wanted.sum),
                                                       std::abs(static_cast<double>(strip.b2[i]) - wanted.b2 / wanted.sum),
                                                       std::abs(static_cast<double>(strip.depth[i]) / depth - 1)});
                        const bool holds = strip.inside >> i & 1;
                        ++seen;
                        close += error < 0x1p-20;
                        mended += !holds && (inside[s] >> i & 1);
                        (holds ? worst : worst_mended) = std::max(holds ? worst : worst_mended, error);
                    }
                });
            }
            CHECK(seen > 20'000);
            CHECK(close > seen * 0.9);
            CHECK(worst < 0x1p-13);
            CHECK(worst > 0x1p-18);   // some are slivers
            CHECK(mended > 50);       // and some are worse
            CHECK(worst_mended < 1e-6);
        }
    }
}
