// These tests compare multisampling with supersampling at the same sampling pattern, and with many samples.
#include "raster/visibility/multisample.h"
#include "tests/raster/varied_scene.h"

#include "common/image/bitwise_equal.h"

#include <doctest/doctest.h>

#include <set>

using namespace duet;
using namespace duet::test;

namespace {

/// Returns settings without effects that draw their own samples, because their noise does not come from silhouettes.
raster::RasterSettings plain(raster::Shading shading) {
    raster::RasterSettings settings;
    settings.shading = shading;
    settings.shadows = false;
    settings.ambient_occlusion = settings.indirect_light = false;
    return settings;
}

raster::RasterSettings multisampled(int count, raster::Shading shading, bool each_sample = false) {
    raster::RasterSettings settings = plain(shading);
    settings.multisamples = count;
    settings.sample_shading = each_sample;
    return settings;
}

double rmse(const ImageRgb& a, const ImageRgb& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) sum += sqr(static_cast<double>(a[i][c]) - static_cast<double>(b[i][c]));
    return std::sqrt(sum / (3 * static_cast<double>(a.size())));
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("patterns: so many samples, each with a row and a column to itself; other numbers are refused") {
        for (const int count : {2, 4, 8, 16}) {
            std::set<int> columns, rows;
            for (const raster::SampleOffset offset : raster::multisample_pattern(count)) {
                CHECK(offset.x >= 0);
                CHECK(offset.y < raster::kSubpixels);
                columns.insert(offset.x);
                rows.insert(offset.y);
            }
            CHECK(columns.size() == static_cast<std::size_t>(count));
            CHECK(rows.size() == static_cast<std::size_t>(count));
        }
        CHECK_THROWS_AS(raster::multisample_pattern(1), Error);
        CHECK_THROWS_AS(raster::multisample_pattern(5), Error);
        raster::RasterSettings both = multisampled(4, raster::Shading::kAlbedo);
        both.samples_per_pixel = 2;
        CHECK_THROWS_AS(render(varied_scene(12), perspective(), both), Error);
    }

    TEST_CASE("where each primitive has one color it is supersampling, bit for bit") {
        for (const int around : {12, 400}) // triangles of many pixels, and of less than one
            for (const View& view : {perspective(), orthographic()}) {
                const Scene scene = varied_scene(around);
                for (const int count : {2, 4, 8, 16}) {
                    CAPTURE(around);
                    CAPTURE(count);
                    const Rendering once = render(scene, view, multisampled(count, raster::Shading::kAlbedo)),
                                    each = render(scene, view, multisampled(count, raster::Shading::kAlbedo, true));
                    CHECK(bitwise_equal(once.radiance, each.radiance));
                }
            }
        // Emissive surfaces have one color each, so lit shows the mean of their albedos where these are the radiance.
        Scene scene = varied_scene(60), painted = scene;
        for (std::size_t i = 0; i < scene.materials.size(); ++i) {
            const Rgb color(0.3f, 0.7f, 1 / (1 + static_cast<float>(i)));
            scene.materials[i] = Emissive{.radiance = color, .two_sided = true};
            painted.materials[i] = Diffuse{{color}};
        }
        scene.environment = ConstantEnvironment{Rgb()};
        finish_scene(scene), finish_scene(painted);
        const ImageRgb lit = render(scene, perspective(), multisampled(8, raster::Shading::kLit)).radiance,
                       albedo = render(painted, perspective(), multisampled(8, raster::Shading::kAlbedo)).radiance;
        CHECK(rmse(lit, albedo) < 1e-6);
    }

    TEST_CASE("silhouettes come as close to the truth as with as many samples shaded") {
        const Scene scene = varied_scene(60);
        const View view = perspective();
        for (const raster::Shading shading : {raster::Shading::kPhong, raster::Shading::kLit}) {
            CAPTURE(static_cast<int>(shading)); // lit shades each sample
            raster::RasterSettings many = plain(shading);
            many.samples_per_pixel = 256;
            const ImageRgb truth = render(scene, view, many).radiance;
            many.samples_per_pixel = 1;
            const double alone = rmse(render(scene, view, many).radiance, truth);
            for (const int count : {4, 8, 16}) {
                const double once = rmse(render(scene, view, multisampled(count, shading)).radiance, truth),
                             each = rmse(render(scene, view, multisampled(count, shading, true)).radiance, truth);
                CAPTURE(count);
                CHECK(once < alone / 2);
                CHECK(once < each * 1.15); // the value shaded at one position of a pixel varies within it
            }
        }
    }

    TEST_CASE("no sample is shaded outside of what it sees") {
        // The quad strip is viewed at such a grazing angle that its colors go out of range beyond its edge.
        // Extrapolation would be visible.
        Scene scene;
        Mesh mesh;
        mesh.positions = {Vec3(-1, 0, -60), Vec3(1, 0, -60), Vec3(1, -0.5f, 3), Vec3(-1, -0.5f, 3)};
        mesh.uvs = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
        mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
        add(scene, mesh);
        finish_scene(scene);
        const View view{look({0, 0.02, 4}, {0, 0, 0}, 30), 160, 120};
        const Rendering shown_image = render(scene, view, multisampled(16, raster::Shading::kDepth));
        const double nearest = 4.0 / (4 + 1); // the camera's target is 4 m away, the strip at least 1 m
        for (const Rgb c : shown_image.radiance) {
            REQUIRE(static_cast<double>(c.r) <= nearest * 1.001);
            REQUIRE(c.r >= 0);
        }
        CHECK(shown_image.statistics.invalid_samples == 0);
    }

    TEST_CASE("the same bits for any number of threads; auxiliary images; memory that does not grow with samples") {
        const Scene scene = varied_scene(90);
        const View view = perspective();
        raster::RasterSettings settings = multisampled(8, raster::Shading::kPhong);
        settings.aovs = {
            .depth = true, .normal = true, .albedo = true, .hit = true, .variance = false, .samples = true};
        settings.threads = 1;
        const Rendering one = render(scene, view, settings);
        settings.threads = 7;
        const Rendering seven = render(scene, view, settings);
        CHECK(bitwise_equal(one.radiance, seven.radiance));
        CHECK(bitwise_equal(one.depth, seven.depth));
        settings.sample_shading = true;
        const Rendering each = render(scene, view, settings);
        int hits_differ = 0, far_apart = 0;
        for (std::size_t i = 0; i < one.hit.size(); ++i) {
            REQUIRE(one.samples[i] == 8);
            hits_differ += one.hit[i].object != each.hit[i].object || one.hit[i].primitive != each.hit[i].primitive;
            const float a = one.depth[i], b = each.depth[i];
            far_apart += (a == kInfinity) != (b == kInfinity) || (a != kInfinity && std::abs(a - b) > 0.02f * b);
        }
        CHECK(hits_differ == 0);
        CHECK(far_apart < 20);
        settings.sample_shading = false;
        const auto bytes = [&](int count) {
            settings.multisamples = count;
            return render(scene, view, settings).statistics.memory_bytes;
        };
        const std::int64_t four = bytes(4), all_samples = bytes(16);
        CHECK(all_samples < four + four / 10);
    }
}
