// These tests compare rough metal under environments and area lights with the exact integrals.
#include "tests/raster/lobe_lookup.h"
#include "tests/raster/scenes.h"

#include "common/material/ggx.h"
#include "common/sampling/hash.h"
#include "common/sampling/warp.h"
#include "raster/lighting/ggx_fit.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

Vec3 viewer(float cosine) { return {std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine}; }

Vec2 number(int i) {
    return {unit_float(high_bits(mix_bits(static_cast<std::uint64_t>(i) + 1))),
            unit_float(low_bits(mix_bits(static_cast<std::uint64_t>(i) + 1)))};
}

/// Returns the reflectance for uniform incident light, estimated with the BSDF's own samples.
double reflected(const MetalBsdf& bsdf, Vec3 wo) {
    constexpr int kSamples = 20000;
    double sum = 0;
    for (int i = 0; i < kSamples; ++i) {
        const float lobe = unit_float(high_bits(mix_bits(static_cast<std::uint64_t>(i) + 77777)));
        if (const auto s = bsdf.sample(wo, lobe, number(i), TransportMode::kRadiance))
            sum += static_cast<double>(s->weight.g);
    }
    return sum / kSamples;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the table made with the build holds what its maker computes") {
        const auto lobes = raster::compute_lobe_table();
        for (const int row : {0, 5, 15}) {
            const float roughness = lerp(raster::kSmoothest, raster::kRoughest, static_cast<float>(row) / 15);
            const raster::LobeMatrix straight = raster::ggx_lobe(sqr(roughness), 1);
            CHECK(straight.m11 == doctest::Approx(lobes(row, 0)[0]).epsilon(1e-4));
            CHECK(straight.m22 == doctest::Approx(lobes(row, 0)[2]).epsilon(1e-4));
        }
    }

    TEST_CASE("albedo: the table returns what the BSDF's own samples do, to 0.015; never more than all") {
        for (const float roughness : {0.1f, 0.33f, 0.6f, 0.95f})
            for (const float cosine : {0.05f, 0.3f, 0.7f, 0.99f})
                for (const float reflectance : {0.0f, 0.5f, 1.0f}) {
                    CAPTURE(roughness);
                    CAPTURE(cosine);
                    const float alpha = roughness * roughness;
                    const double found =
                        static_cast<double>(MetalBsdf(Rgb(reflectance), alpha).directional_albedo(cosine).g);
                    CHECK(std::abs(found - reflected({Rgb(reflectance), alpha}, viewer(cosine))) < 0.004);
                    CHECK(found <= 1.0001);
                }
    }

    TEST_CASE("lobes: the transformed cosine is the cosine itself where GGX is, and close to its lobe elsewhere") {
        for (const float roughness : {0.15f, 0.4f, 0.7f, 1.0f})
            for (const float cosine : {0.3f, 0.7f, 1.0f}) {
                CAPTURE(roughness);
                CAPTURE(cosine);
                const float alpha = roughness * roughness;
                CHECK(raster::lobe_distance(alpha, cosine, raster::ggx_lobe(alpha, cosine)) < 0.45);
            }
        CHECK(raster::lobe_distance(0.01f, 0.7f, {}) > 1.5); // a cosine lobe does not approximate a narrow lobe
    }

    TEST_CASE("white furnace: rough metal in a constant environment shows the BSDF's albedo, from either side") {
        for (const double side : {1.0, -1.0}) {
            Scene scene;
            add(scene, QuadList{{{Vec3(-5, 0, 5), Vec3(10, 0, 0), Vec3(0, 0, -10)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0.6f});
            scene.environment = ConstantEnvironment{Rgb(0.5f)};
            finish_scene(scene);
            const View view{look({0, 3 * side, 2}, {0, 0, 0}), 4, 4};
            const Rendering found = render(scene, view, {});
            const Pinhole pinhole = CameraModel(view).pinhole();
            for (int i = 0; i < 4; ++i) {
                const float cosine = static_cast<float>(std::abs(pinhole.ray({i + 0.5, i + 0.5}).direction.y));
                const double expected = 0.5 * reflected({Rgb(1.0f), 0.36f}, viewer(cosine));
                CHECK(static_cast<double>(found.radiance(i, i).g) == doctest::Approx(expected).epsilon(0.01));
            }
        }
    }

    TEST_CASE("frosted glass alone shows the sky blurred, more the rougher it is; a pane stays clear") {
        const auto contrast = [](float roughness, bool thin) {
            Scene scene;
            Dielectric glass;
            glass.roughness = {roughness}, glass.thin = thin;
            add(scene, Sphere{Vec3(0, 0, 0), 1}, Mat4(), glass);
            scene.environment = SkyEnvironment{{0, 0, 0}, {1, 1, 1}};
            finish_scene(scene);
            CHECK(scene.needs.glossy == (roughness > 0 && !thin));
            const ImageRgb found = render(scene, {look({0, 0, 5}, {0, 0, 0}, 20), 48, 48}, {}).radiance;
            float least = 1, most = 0; // over the sphere
            for (int y = 12; y < 36; ++y)
                for (int x = 12; x < 36; ++x)
                    least = std::min(least, found(x, y).g), most = std::max(most, found(x, y).g);
            return most - least;
        };
        const float clear = contrast(0, false), frosted = contrast(0.5f, false), rougher = contrast(0.8f, false);
        CHECK(clear > 0.03f);
        CHECK(frosted < 0.95f * clear);
        CHECK(rougher < 0.95f * frosted);
        CHECK(contrast(0.8f, true) == contrast(0, true));
    }

    // The scene is a mirror floor in front of an emissive wall. Below the wall's base the floor shows the wall upside
    // down.
    TEST_CASE("gbuffer reflections: a mirror shows the wall that the image shows, elsewhere the sky") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-5, 0, 5), Vec3(10, 0, 0), Vec3(0, 0, -10)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        add(scene, QuadList{{{Vec3(-5, 0, -1), Vec3(10, 0, 0), Vec3(0, 1, 0)}}}, Mat4(),
            Emissive{Rgb(0.0f, 2.0f, 0.0f)});
        scene.environment = ConstantEnvironment{Rgb(0.25f)};
        finish_scene(scene);
        const View view{look({0, 1.5, 4}, {0, 0.5, 0}, 40), 96, 96};
        raster::RasterSettings settings;
        settings.aovs.hit = true;
        const Rendering found = render(scene, view, settings);
        const Pinhole pinhole = CameraModel(view).pinhole();
        int wall = 0, sky = 0, wrong = 0;
        for (int y = 0; y < 96; ++y)
            for (int x = 4; x < 92; ++x) {
                if (found.hit(x, y).object != 0) continue;
                const Rayd ray = pinhole.ray({x + 0.5, y + 0.5});
                const Vec3d p = ray.at(-ray.origin.y / ray.direction.y);
                if (p.z < -0.97) continue; // in the corner
                // This is the height at which the reflected ray hits the wall.
                const double height = -ray.direction.y * (-1 - p.z) / ray.direction.z;
                if (std::abs(height - 1) < 0.1) continue; // its edge, blurred over pixels
                const Rgb expected = height < 1 ? Rgb(0.0f, 2.0f, 0.0f) : Rgb(0.25f);
                (height < 1 ? wall : sky) += 1;
                wrong += max_component(found.radiance(x, y) - expected) > 1e-4f ||
                         found.radiance(x, y).g < expected.g - 1e-4f;
            }
        CHECK(wall > 500);
        CHECK(sky > 500);
        CHECK(wrong < (wall + sky) / 10); // the edges of what the image shows, where the probe takes over
        raster::RasterSettings one;
        one.threads = 1;
        CHECK(render(scene, view, one).radiance.pixels() == found.radiance.pixels());
    }
}
