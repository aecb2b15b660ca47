// These tests check where samples lie on their triangles, computed with SIMD: in float within the error bounds of
// raster/visibility/packet_interpolation.h, in double exactly.
#include "raster/shader/sphere_packet.h"
#include "raster/visibility/hit_tile.h"
#include "raster/visibility/packet_interpolation.h"
#include "raster/visibility/rasterize_tile.h"
#include "tests/raster/varied_scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <span>

using namespace duet;
using namespace duet::test;

namespace {

/// Adapts a solver's callback: calls use(i, result) for each batch that the solver returns at a time.
template <typename Use> auto each(Use use) {
    return [use](std::size_t first, const auto& results) {
        for (std::size_t s = 0; s < results.size(); ++s) use(first + s, results[s]);
    };
}

/// Returns triangles of all shapes, including slivers whose length is a million times their height, above a ground
/// plane that extends to the horizon.
Scene slivers() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-1, 1), digits(0, 6);
    Mesh mesh;
    const auto point = [&] { return Vec3(place(random), place(random), place(random)); };
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const Vec3 a = point() * 2.0f, along = point(),
                   across = cross(along, point()) * std::pow(10.0f, -digits(random));
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

/// Returns a wall of kAcross × kAcross cells with two triangles each. The indices of any eight adjacent triangles are
/// 1024 apart, so neighbors compete for the same slots of a table.
constexpr std::uint32_t kAcross = 64;
Scene shuffled_wall() {
    Mesh mesh;
    for (std::uint32_t i = 0; i < (kAcross + 1) * (kAcross + 1); ++i)
        mesh.positions.push_back(Vec3(static_cast<float>(i % (kAcross + 1)), static_cast<float>(i / (kAcross + 1)), 0) *
                                     (2.0f / kAcross) -
                                 Vec3(1, 1, 0));
    std::vector<std::array<std::uint32_t, 3>> in_rows;
    for (std::uint32_t row = 0; row < kAcross; ++row)
        for (std::uint32_t column = 0; column < kAcross; ++column) {
            const std::uint32_t a = row * (kAcross + 1) + column, b = a + kAcross + 1;
            in_rows.push_back({a, a + 1, b + 1});
            in_rows.push_back({a, b + 1, b});
        }
    mesh.triangles.resize(in_rows.size());
    for (std::size_t i = 0; i < in_rows.size(); ++i) mesh.triangles[i % 8 * (in_rows.size() / 8) + i / 8] = in_rows[i];
    Scene scene;
    add(scene, mesh);
    finish_scene(scene);
    return scene;
}

/// Holds the geometry of an image and its sample batches, tile by tile.
struct PacketImage : ImageGeometry {
    using ImageGeometry::ImageGeometry;
    /// Calls use(rect, packets) for each tile.
    template <typename Use> void for_each_tile(const Use& use) const {
        for (std::size_t t = 0; t < grid.size(); ++t) {
            const raster::PixelRect rect = grid.tile(t);
            raster::DepthTile depths;
            rasterize_tile(geometry, pass, pass.samples[0], rect, t, depths);
            std::vector<raster::SamplePacket> packets;
            for (int y = rect.y0; y < rect.y1; y += 2)
                for (int x = rect.x0; x < rect.x1; x += 8) packets.push_back(sample_packet(depths, x, y));
            use(rect, packets);
        }
    }
};

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("barycentrics and depths in float are as exact as is said, of slivers, too, and right where they "
              "are not") {
        using raster::kPacketSize, raster::NoVaryings, raster::PacketInterpolator;
        const Scene scene = slivers();
        for (const View& view : {perspective(), orthographic()}) {
            const PacketImage shown_image(scene, view);
            const raster::Geometry& geometry = shown_image.geometry;
            const NoVaryings nothing;
            int seen = 0, close = 0, mended = 0;
            double worst = 0, worst_mended = 0;
            shown_image.for_each_tile(
                [&](const raster::PixelRect& rect, std::span<const raster::SamplePacket> packets) {
                    PacketInterpolator<NoVaryings, float> in_float(geometry.triangles, shown_image.pass, rect, nothing,
                                                                   false);
                    PacketInterpolator<NoVaryings, double> in_double(geometry.triangles, shown_image.pass, rect,
                                                                     nothing, false);
                    std::vector<std::uint32_t> inside(packets.size());
                    in_double.interpolate_packets(
                        packets, false, each([&](std::size_t s, const auto& result) { inside[s] = result.inside; }));
                    in_float.interpolate_packets(
                        packets, true, each([&](std::size_t s, const auto& result) {
                            CHECK((result.inside & ~inside[s]) == 0);
                            for (std::size_t i = 0; i < kPacketSize; ++i) {
                                if (!(result.samples->on_mesh >> i & 1)) continue;
                                const raster::Interpolated wanted = interpolate(
                                    geometry.triangles.unclipped(result.samples->id(i)), packets[s].position(i));
                                const double depth = wanted.depth_sum / wanted.sum;
                                const double error =
                                    std::max({std::abs(static_cast<double>(result.b1[i]) - wanted.b1 / wanted.sum),
                                              std::abs(static_cast<double>(result.b2[i]) - wanted.b2 / wanted.sum),
                                              std::abs(static_cast<double>(result.depth[i]) / depth - 1)});
                                const bool holds = result.inside >> i & 1;
                                ++seen;
                                close += error < 0x1p-20;
                                mended += !holds && (inside[s] >> i & 1);
                                (holds ? worst : worst_mended) = std::max(holds ? worst : worst_mended, error);
                            }
                        }));
                });
            CHECK(seen > 20'000);
            CHECK(close > seen * 0.9);
            CHECK(worst < 0x1p-16);
            CHECK(worst > 0x1p-18); // some are slivers
            CHECK(mended > 50);     // some exceed the error bound
            CHECK(worst_mended < 2e-7);
        }
    }

    TEST_CASE("of triangles that compete for packets, more than there is room for, each result has its own, all of "
              "them or a few at a time") {
        using raster::NoVaryings, raster::PacketInterpolator;
        const PacketImage shown_image(shuffled_wall(), perspective());
        const raster::Triangles& triangles = shown_image.geometry.triangles;
        const NoVaryings nothing;
        for (const std::size_t together : {std::size_t{1}, std::size_t{5}, std::size_t{10'000}}) {
            int seen = 0;
            double worst = 0;
            shown_image.for_each_tile(
                [&](const raster::PixelRect& rect, std::span<const raster::SamplePacket> packets) {
                    PacketInterpolator<NoVaryings, double> solver(triangles, shown_image.pass, rect, nothing, false);
                    for (std::size_t first = 0; first < packets.size(); first += together) {
                        const auto some = packets.subspan(first, std::min(together, packets.size() - first));
                        solver.interpolate_packets(
                            some, false, each([&](std::size_t s, const auto& result) {
                                for (std::size_t i = 0; i < raster::kPacketSize; ++i) {
                                    // A sample outside its triangle is moved inside, so it is not compared.
                                    if (!(result.samples->on_mesh & result.inside & 1u << i)) continue;
                                    const raster::Interpolated wanted =
                                        interpolate(triangles.unclipped(static_cast<std::uint32_t>(some[s].ids[i])),
                                                    some[s].position(i));
                                    worst = std::max(
                                        {worst, std::abs(static_cast<double>(result.b1[i]) - wanted.b1 / wanted.sum),
                                         std::abs(static_cast<double>(result.b2[i]) - wanted.b2 / wanted.sum)});
                                    ++seen;
                                }
                            }));
                    }
                });
            CHECK(seen > 5'000);
            CHECK(worst < 1e-7); // barycentrics are floats
        }
    }

    TEST_CASE("a quad is solved side by side, as two triangles, and its diagonal does not show") {
        using raster::kPacketSize, raster::NoVaryings, raster::PacketInterpolator;
        Scene scene;
        add(scene, QuadList{{Quad{Vec3(-30, -0.5f, 3), Vec3(60, 1, 0), Vec3(0, 0, -90)},
                             Quad{Vec3(-1, 0, 0), Vec3(1.5f, 0, 1), Vec3(0, 1, 0)}}});
        finish_scene(scene);
        for (const View& view : {perspective(), orthographic()}) {
            const PacketImage shown_image(scene, view);
            const NoVaryings nothing;
            std::array<int, 2> halves{};
            int together = 0;
            double worst = 0;
            shown_image.for_each_tile(
                [&](const raster::PixelRect& rect, std::span<const raster::SamplePacket> packets) {
                    PacketInterpolator<NoVaryings, float> solver(shown_image.geometry.triangles, shown_image.pass, rect,
                                                                 nothing, false);
                    solver.interpolate_packets(
                        packets, true, each([&](std::size_t s, const auto& result) {
                            CHECK(result.samples->on_mesh == result.samples->visible);
                            for (std::size_t i = 0; i < kPacketSize; ++i) {
                                if (!(result.samples->on_mesh >> i & 1)) continue;
                                const Hit hit = find_hit(shown_image.geometry, shown_image.pass, result.samples->id(i),
                                                         packets[s].position(i));
                                const std::size_t triangle = result.samples->index(i), half = triangle % 2;
                                const float both = result.b1[i] + result.b2[i];
                                ++halves[half];
                                together += result.inside >> i & 1;
                                CHECK(hit.primitive == result.samples->shape->primitive(triangle));
                                const Vec2 uv = half == 0 ? Vec2(both, result.b2[i]) : Vec2(result.b1[i], both);
                                worst = std::max({worst, std::abs(static_cast<double>(uv.x - hit.u)),
                                                  std::abs(static_cast<double>(uv.y - hit.v))});
                            }
                        }));
                });
            CHECK(halves[0] > 1500);
            CHECK(halves[1] > 1500);
            CHECK(together > (halves[0] + halves[1]) * 0.98);
            CHECK(worst < 0x1p-20);
        }
    }

    TEST_CASE("points of spheres, side by side, are those of each sample's own ray: of stretched ones and from "
              "inside, too") {
        Scene scene;
        add(scene, Sphere{Vec3(0.3f, 0.2f, 0.5f), 0.9f});
        add(scene, Sphere{Vec3(-1, 0.4f, 0), 0.5f},
            translation(Vec3(-0.2f, 0.3f, 0.9f)) * scaling(Vec3(-0.7f, 1.8f, 1.1f)));
        add(scene, Sphere{Vec3(0, 0, 0), 40}); // contains everything else
        finish_scene(scene);
        for (const View& view : {perspective(), orthographic()}) {
            const PacketImage shown_image(scene, view);
            std::array<int, 3> seen{};
            double worst = 0, worst_depth = 0;
            int wrong_side = 0;
            shown_image.for_each_tile([&](const raster::PixelRect&, std::span<const raster::SamplePacket> packets) {
                for (const raster::SamplePacket& place : packets)
                    for (const raster::DrawSphere& sphere : shown_image.geometry.spheres) {
                        const raster::SpherePacket result(shown_image.pass, place, sphere, false);
                        for (std::size_t i = 0; i < raster::kPacketSize; ++i) {
                            if (static_cast<std::uint32_t>(place.ids[i]) != sphere.id) continue;
                            const Vec2d pixel = place.position(i);
                            const Rayd exact = shown_image.pinhole.ray(pixel);
                            const Ray ray = raster::rounded(exact, 0);
                            const Hit hit = find_hit(shown_image.geometry, shown_image.pass, sphere.id, pixel);
                            const SurfacePoint point = surface_point(shown_image.scene, ray, hit);
                            const Vec3 n(result.n[0][i], result.n[1][i], result.n[2][i]);
                            const Vec3 p = sphere.sphere.center + n * sphere.sphere.radius;
                            const double grazing = std::abs(static_cast<double>(dot(point.ng, ray.direction)));
                            ++seen[sphere.object];
                            worst = std::max(worst, static_cast<double>(length(p - point.p_object)) * grazing);
                            const double depth = static_cast<double>(hit.t) * shown_image.pinhole.near / exact.t_min;
                            worst_depth = std::max(
                                worst_depth, std::abs(static_cast<double>(result.depth[i]) / depth - 1) * grazing);
                            wrong_side += (result.side[i] < 0) != (dot(point.ng, ray.direction) > 0);
                        }
                    }
            });
            for (const int each : seen) CHECK(each > 1000);
            CHECK(worst < 1e-5); // relative to a radius of 40
            CHECK(worst_depth < 1e-6);
            CHECK(wrong_side <= 2); // viewed exactly edge-on
        }
    }
}
