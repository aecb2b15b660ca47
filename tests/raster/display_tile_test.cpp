// These tests compare the fast paths of display images and shadow maps with naive implementations.
#include "raster/draw.h"
#include "raster/shader/srgb_packet.h"
#include "raster/visibility/hit_tile.h"
#include "raster/visibility/rasterize_tile.h"
#include "tests/raster/varied_scene.h"

#include "common/image/srgb.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <random>

using namespace duet;
using namespace duet::test;

namespace {

raster::RasterSettings phong(raster::Output output) {
    raster::RasterSettings settings;
    settings.shading = raster::Shading::kPhong;
    settings.output = output;
    return settings;
}

/// Evaluates Phong's model at a pixel's center from its hit alone, with the shared surface point and the path
/// tracer's lights.
Rgb naive_phong(const Scene& scene, const View& view, const Hit& hit, int x, int y) {
    if (!hit.valid()) return {};
    const Rayd exact = CameraModel(view).pinhole().ray({x + 0.5, y + 0.5});
    const Ray ray{
        .origin = Vec3(exact.origin), .direction = Vec3(exact.direction), .t_min = static_cast<float>(exact.t_min)};
    const SurfacePoint point = surface_point(scene, ray, hit);
    const Vec3 wo = -ray.direction, n = dot(point.ng, wo) < 0 ? -point.ns : point.ns;
    const Rgb base = base_color(scene.materials[point.material], scene.textures, point);
    Rgb sum = base * mean_radiance(scene.environment);
    for (const Light& light : scene.lights) {
        const auto arriving = sample_light(light, point.p, {0.5f, 0.5f});
        if (!arriving) continue;
        const float cosine = std::max(dot(n, arriving->wi), 0.0f),
                    mirror = std::max(dot(reflect(arriving->wi, n), wo), 0.0f);
        const float lobe = 0.04f * 34 * std::pow(mirror, 32.0f) / (2 * kPi);
        sum += arriving->radiance * cosine * (base * (1 / kPi) + Rgb(lobe));
    }
    return sum;
}

int largest_difference(Rgba8 a, Rgba8 b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b), std::abs(a.a - b.a)});
}

constexpr std::uint32_t kAll = (1u << raster::kPacketSize) - 1;

raster::SrgbPacket encode_all(float value) {
    raster::ColorPacket colors;
    colors.r.fill(value);
    colors.g.fill(value);
    colors.b.fill(value);
    raster::SrgbPacket codes, *to = &codes;
    raster::encode_packets(std::span(&colors, 1), &kAll, {}, &to);
    return codes;
}

struct ReversedDepthShader : raster::NoVaryings {
    template <typename T, typename F> RgbT<T> fragment(const F& f) const { return RgbT<T>(f.reversed_depth); }
};

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a packet of pixels gets the codes that single values get") {
        std::vector<float> values{0.0f, -1.0f, 1.0f, 2.0f, kInfinity, -kInfinity, std::nanf(""), 1e-30f, 1e-40f};
        for (int code = 0; code < 255; ++code) { // around every change of the code
            const auto middle = static_cast<float>(srgb_decode((code + 0.5) / 255));
            for (int step = -200; step <= 200; ++step)
                values.push_back(
                    std::bit_cast<float>(std::bit_cast<std::uint32_t>(middle) + static_cast<std::uint32_t>(step)));
        }
        std::mt19937 engine(1);
        std::uniform_real_distribution<float> uniform(0, 1.01f);
        for (int i = 0; i < 200'000; ++i) values.push_back(uniform(engine));
        for (std::uint32_t bits = 0; bits < 0x3f800000u; bits += 7919) values.push_back(std::bit_cast<float>(bits));
        const auto wrong_codes = [&](const std::vector<float>& of) {
            const std::size_t count = of.size() / raster::kPacketSize;
            std::vector<raster::ColorPacket> colors(count);
            std::vector<raster::SrgbPacket> codes(count);
            std::vector<raster::SrgbPacket*> to;
            std::vector<std::uint32_t> seen;
            for (std::size_t s = 0; s < count; ++s) {
                for (std::size_t k = 0; k < raster::kPacketSize; ++k) {
                    const std::size_t i = s * raster::kPacketSize + k;
                    colors[s].r[k] = of[i];
                    colors[s].g[k] = of[of.size() - 1 - i];
                    colors[s].b[k] = of[(i * 7 - k * 6) % of.size()];
                }
                to.push_back(&codes[s]);
                seen.push_back((static_cast<std::uint32_t>(engine()) | static_cast<std::uint32_t>(engine())) & kAll);
            }
            const Rgba8 background{1, 2, 3, 4};
            raster::encode_packets(colors, seen.data(), background, to.data());
            int wrong = 0;
            for (std::size_t s = 0; s < count; ++s)
                for (std::size_t k = 0; k < raster::kPacketSize; ++k) {
                    const Rgba8 own{srgb_encode_8bit(colors[s].r[k]), srgb_encode_8bit(colors[s].g[k]),
                                    srgb_encode_8bit(colors[s].b[k]), 255};
                    wrong += codes[s][k] != (seen[s] >> k & 1 ? own : background);
                }
            return wrong;
        };
        CHECK(wrong_codes(values) == 0);
        // Keep only values above the linear segment.
        std::erase_if(values, [](float x) { return !(x > 0.0031308f && x <= 1.0f); });
        CHECK(values.size() > 200'000);
        CHECK(wrong_codes(values) == 0);
        CHECK(encode_all(0.5f)[7] == Rgba8{188, 188, 188, 255});
    }

    TEST_CASE("Phong's shading side by side is Phong's model at each hit") {
        for (const int around : {12, 60, 400}) // triangles of many pixels, of a few, and of less than one
            for (const View& view : {perspective(), orthographic()}) {
                const Scene scene = varied_scene(around);
                raster::RasterSettings settings = phong(raster::Output::kRadiance);
                settings.aovs.hit = true;
                const Rendering shown_image = render(scene, view, settings);
                const Rendering encoded = render(scene, view, phong(raster::Output::kSrgb8));
                REQUIRE(encoded.srgb.width() == view.width);
                int different = 0, worst = 0, not_encoded = 0;
                for (int y = 0; y < view.height; ++y)
                    for (int x = 0; x < view.width; ++x) {
                        const auto code = [](Rgb c) {
                            return Rgba8{srgb_encode_8bit(c.r), srgb_encode_8bit(c.g), srgb_encode_8bit(c.b), 255};
                        };
                        const Rgba8 wanted = code(naive_phong(scene, view, shown_image.hit(x, y), x, y));
                        not_encoded += encoded.srgb(x, y) != code(shown_image.radiance(x, y));
                        different += encoded.srgb(x, y) != wanted;
                        worst = std::max(worst, largest_difference(encoded.srgb(x, y), wanted));
                    }
                CAPTURE(around);
                CHECK(not_encoded == 0); // of display images and of float images
                CHECK(worst <= 1);       // float versus double, where a value is at a change of the code
                CHECK(different <= 8);   // of 78,447 pixels
            }
    }

    TEST_CASE("a depth-only image has the same reversed depth that shading sees") {
        for (const View& view : {perspective(), orthographic()}) {
            const Scene scene = varied_scene(90);
            raster::RasterSettings settings = phong(raster::Output::kReversedDepth);
            const Rendering depths = render(scene, view, settings);
            settings.output = raster::Output::kRadiance;
            Control control;
            const Rendering shaded =
                raster::draw(raster::prepare(scene, settings), view, settings, ReversedDepthShader{}, control);
            int wrong = 0, seen = 0;
            for (std::size_t i = 0; i < depths.reversed_depth.size(); ++i) {
                wrong += depths.reversed_depth[i] != shaded.radiance[i].r;
                seen += depths.reversed_depth[i] > 0;
            }
            CHECK(wrong == 0);
            CHECK(seen > 10'000);
        }
    }

    TEST_CASE("images are the same for any number of threads, and drawn over an earlier one") {
        const Scene scene = varied_scene(120);
        const View view = perspective();
        for (const raster::Output output : {raster::Output::kSrgb8, raster::Output::kReversedDepth}) {
            raster::RasterSettings settings = phong(output);
            const raster::RasterScene prepared = raster::prepare(scene, settings);
            Control control;
            settings.threads = 1;
            const Rendering one = raster::render(prepared, view, settings, control);
            Rendering again;
            for (const int threads : {2, 3, 7}) {
                settings.threads = threads;
                View other = view; // another view of a different size in between
                other.camera.eye.x += 1;
                other.width += 100;
                raster::render(prepared, other, settings, control, again);
                raster::render(prepared, view, settings, control, again);
                CHECK(again.srgb.pixels() == one.srgb.pixels());
                CHECK(again.reversed_depth.pixels() == one.reversed_depth.pixels());
            }
        }
    }

    TEST_CASE("front faces only: nothing is seen of a mesh turned inside out but its far side") {
        Scene scene;
        add(scene, turned_inside_out(torus(40, 20)));
        finish_scene(scene);
        const View view{look({0, 3, 0.01}, {0, 0, 0}, 60), 120, 120};
        raster::RasterSettings settings = phong(raster::Output::kReversedDepth);
        const Rendering both = render(scene, view, settings);
        settings.front_faces_only = true;
        const Rendering fronts = render(scene, view, settings);
        int seen = 0, farther = 0;
        for (std::size_t i = 0; i < both.reversed_depth.size(); ++i) {
            REQUIRE((both.reversed_depth[i] > 0) == (fronts.reversed_depth[i] > 0)); // the silhouette is unchanged
            seen += both.reversed_depth[i] > 0;
            farther += fronts.reversed_depth[i] < both.reversed_depth[i];
        }
        CHECK(seen > 2000);
        CHECK(farther > seen * 9 / 10);
    }

    TEST_CASE("hits found side by side are those found one by one") {
        const Scene scene = varied_scene(200);
        for (const View& view : {perspective(), orthographic()}) {
            const ImageGeometry drawn(scene, view);
            const raster::Geometry& geometry = drawn.geometry;
            const Pinhole& pinhole = drawn.pinhole;
            const raster::SampleOffset offset = drawn.samples[0];
            double worst = 0;
            int compared = 0;
            for (std::size_t t = 0; t < drawn.grid.size(); ++t) {
                raster::DepthTile depths;
                rasterize_tile(geometry, drawn.pass, offset, drawn.grid.tile(t), t, depths);
                const raster::HitTile tile(depths, geometry, drawn.pass);
                const raster::PixelRect& r = tile.rect();
                for (int y = r.y0; y < r.y1; ++y)
                    for (int x = r.x0; x < r.x1; ++x) {
                        const Hit& hit = tile.hit(x, y);
                        REQUIRE(hit.valid() == (depths.id(x, y) != raster::kNoTriangle));
                        if (!hit.valid() || scene.objects[hit.object].shape == 2) continue;
                        const raster::Run& run = geometry.triangles.run_of(depths.id(x, y));
                        if (run.sphere) continue;
                        const Vec2d pixel = offset.position(x, y);
                        const Hit naive =
                            hit_triangle(geometry.triangles.unclipped(depths.id(x, y)), {hit.object, hit.primitive},
                                         pixel, pinhole.ray(pixel).t_min / pinhole.near, pinhole.near);
                        REQUIRE(naive.object == hit.object);
                        const auto apart = [](float a, float b) {
                            return std::abs(static_cast<double>(a) - static_cast<double>(b));
                        };
                        worst = std::max({worst, apart(hit.u, naive.u), apart(hit.v, naive.v), apart(hit.t, naive.t)});
                        ++compared;
                    }
            }
            CHECK(compared > 10'000);
            CHECK(worst < 2e-7); // float rounding of values up to 8
        }
    }

    TEST_CASE("what is wholly behind is left out, and nothing else") {
        // Large triangles overlap in any order of depth. Blocks become fully covered, and later triangles fail their
        // depth test.
        std::mt19937 engine(3);
        const auto number = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(engine);
        };
        const raster::Viewport viewport{128, 128, 0.1, false};
        for (int trial = 0; trial < 30; ++trial) {
            struct SetupTriangles : raster::UnclippedTriangles {
                std::vector<raster::UnclippedTriangle> wholes;
                std::vector<raster::DrawTriangle> triangles;
                raster::UnclippedTriangle unclipped(std::uint32_t id) const override { return wholes[id]; }
            } setup;
            for (std::uint32_t id = 0; id < 40; ++id) {
                const double middle = number(1, 10);
                const auto vertex = [&] {
                    const double depth = middle * number(0.9, 1.1);
                    const double xw = number(-120, 240) * depth, yw = number(-120, 240) * depth;
                    return raster::PixelVertex{.xw = xw, .yw = yw, .w = depth, .depth = depth};
                };
                setup.wholes.push_back({vertex(), vertex(), vertex()});
                const raster::UnclippedTriangle& t = setup.wholes.back();
                std::array<raster::FixedPoint, 3> p{snap(t.a), snap(t.b), snap(t.c)};
                if (raster::doubled_area(p[0], p[1], p[2]) < 0) std::swap(p[1], p[2]);
                if (raster::doubled_area(p[0], p[1], p[2]) != 0)
                    setup.triangles.push_back(raster::set_up(t, p, id, false, viewport));
            }
            raster::DepthTile together, alone;
            together.reset({0, 0, 128, 128}, {}, viewport);
            Image<float> nearest(128, 128, 0.0f);
            Image<std::uint32_t> id(128, 128, raster::kNoTriangle);
            for (const raster::DrawTriangle& triangle : setup.triangles) {
                together.draw(triangle, setup);
                alone.reset({0, 0, 128, 128}, {}, viewport);
                alone.draw(triangle, setup);
                for (int y = 0; y < 128; ++y)
                    for (int x = 0; x < 128; ++x) {
                        if (!(alone.reversed_depth(x, y) > nearest(x, y))) continue;
                        nearest(x, y) = alone.reversed_depth(x, y);
                        id(x, y) = alone.id(x, y);
                    }
            }
            int wrong = 0;
            for (int y = 0; y < 128; ++y)
                for (int x = 0; x < 128; ++x)
                    wrong += together.id(x, y) != id(x, y) || together.reversed_depth(x, y) != nearest(x, y);
            REQUIRE(wrong == 0);
        }
    }
}
