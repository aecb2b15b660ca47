// These tests compare rough metal under environments and area lights with the exact integrals.
#include "tests/raster/scenes.h"

#include "common/light/form_factor.h"
#include "common/material/ggx.h"
#include "common/sampling/hash.h"
#include "common/sampling/warp.h"
#include "raster/lighting/area_specular.h"
#include "raster/lighting/ggx_fit.h"
#include "raster/lighting/prefiltered_environment.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;
using raster::Prefiltered;

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

ImageEnvironment picture_of(const SkyEnvironment& sky) {
    ImageRgb image(128, 64);
    for (int y = 0; y < 64; ++y) {
        const float down = 0.5f - 0.5f * std::cos(kPi * (static_cast<float>(y) + 0.5f) / 64);
        for (int x = 0; x < 128; ++x) image(x, y) = lerp(sky.up, sky.down, down);
    }
    return make_image_environment(std::move(image), 1, 0);
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
                    CHECK(std::abs(found - reflected({Rgb(reflectance), alpha}, viewer(cosine))) < 0.015);
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

    TEST_CASE("a light surface on rough metal: the integral of the BSDF over the light, to a tenth of its largest") {
        SurfacePoint surface;
        surface.p = {0, 0, 0};
        surface.ng = surface.ns = {0, 1, 0};
        surface.object = 5;
        SurfaceLight lamp;
        lamp.radiance = Rgb(1.0f);
        lamp.two_sided = true;
        for (const float roughness : {0.3f, 0.6f})
            for (const float tilt : {0.3f, 0.9f}) {
                const Vec3 to_viewer = normalize(Vec3(std::sin(tilt), std::cos(tilt), 0.2f));
                const raster::ShadingPoint point(surface, to_viewer);
                const MetalBsdf bsdf{Rgb(0.9f), roughness * roughness};
                double largest = 0, worst = 0;
                for (float x = -2; x <= 2; x += 0.5f)
                    for (const int kind : {0, 1, 2}) {
                        const Vec3 corner(x - 0.5f, 1.5f, -0.5f);
                        if (kind == 0) lamp.shape = Quad{corner, {1, 0, 0}, {0, 0.3f, 1}};
                        if (kind == 1)
                            lamp.shape = SurfaceLight::Triangle{corner, corner + Vec3(1, 0, 0), corner + Vec3(0, 0, 1)};
                        if (kind == 2) lamp.shape = Sphere{corner, 0.4f};
                        double exact = 0;
                        constexpr int kSamples = 20000;
                        for (int i = 0; i < kSamples; ++i) {
                            const auto s = sample_light(lamp, surface.p, number(i));
                            if (!s) continue;
                            const Vec3 wi = point.frame.to_local(s->wi);
                            if (!(wi.z > 0)) continue;
                            const float f = bsdf.eval(point.wo, wi, TransportMode::kRadiance).g;
                            exact += static_cast<double>(f * wi.z / s->pdf) / kSamples;
                        }
                        const double found = static_cast<double>(raster::area_reflection(lamp, bsdf, point).g);
                        largest = std::max(largest, exact);
                        worst = std::max(worst, std::abs(found - exact));
                    }
                CAPTURE(roughness);
                CAPTURE(tilt);
                CHECK(largest > 0.05);
                CHECK(worst < 0.1 * largest);
            }
    }

    // At normal incidence the lobe is rotationally symmetric. A sphere whose edge passes through the lobe's center
    // must give the same reflection for every azimuth.
    TEST_CASE("a round lamp is round: the same from all sides, and half of it where its edge is mirrored") {
        SurfacePoint surface;
        surface.ng = surface.ns = {0, 0, 1};
        surface.object = 5;
        const raster::ShadingPoint point(surface, {0, 0, 1});
        const MetalBsdf bsdf{Rgb(0.9f), 0.01f};
        SurfaceLight lamp;
        lamp.radiance = Rgb(1.0f);
        const auto found = [&](double tilt, double turn) {
            lamp.shape = Sphere{
                Vec3(Vec3d(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)) * 2.0), 1};
            return static_cast<double>(raster::area_reflection(lamp, bsdf, point).g);
        };
        const double edge = kPiDouble / 6, whole = found(0, 0);
        for (int i = 0; i < 32; ++i) {
            CHECK(found(edge, i * 0.2) == doctest::Approx(found(edge, 0)).epsilon(1e-3));
            CHECK(found(edge, i * 0.2) == doctest::Approx(whole / 2).epsilon(0.05)); // the edge is slightly curved
        }
        CHECK(found(edge + 0.15, 1) < 0.01 * whole);
    }

    TEST_CASE("what fills the hemisphere is reflected by the albedo; the light's back, and its own surface, not at all") {
        SurfacePoint surface;
        surface.ng = surface.ns = {0, 1, 0};
        surface.object = 5;
        const raster::ShadingPoint point(surface, normalize(Vec3(0.5f, 1, 0)));
        const MetalBsdf bsdf{Rgb(0.7f), 0.04f};
        SurfaceLight lamp;
        lamp.radiance = Rgb(2.0f);
        lamp.shape = Quad{Vec3(-1e4f, 1, -1e4f), Vec3(2e4f, 0, 0), Vec3(0, 0, 2e4f)}; // emits downward
        const float all = 2 * bsdf.directional_albedo(point.wo.z).g;
        // The transformed cosine extends partly below the horizon.
        CHECK(raster::area_reflection(lamp, bsdf, point).g == doctest::Approx(all).epsilon(0.02));
        lamp.shape = Quad{Vec3(-1e4f, 1, -1e4f), Vec3(0, 0, 2e4f), Vec3(2e4f, 0, 0)};
        CHECK(is_black(raster::area_reflection(lamp, bsdf, point)));
        lamp.two_sided = true;
        lamp.object = 5;
        CHECK(is_black(raster::area_reflection(lamp, bsdf, point)));
    }

    TEST_CASE("prefiltered: constants stay, skies and their pictures agree, more blurred the rougher; any threads") {
        const Environment constant = ConstantEnvironment{Rgb(0.7f, 0.5f, 0.2f)};
        const SkyEnvironment sky{{1, 0.2f, 0}, {0, 0.3f, 1}};
        const Environment described = sky, picture = picture_of(sky);
        const Prefiltered flat(constant, 1), exact(described, 1), maps(picture, 1), again(picture, 3);
        for (const float roughness : {0.05f, 0.2f, 0.5f, 0.77f, 1.0f})
            for (const Vec3 w :
                 {Vec3(0, 1, 0), Vec3(0, -1, 0), normalize(Vec3(1, 0.3f, -0.5f)), normalize(Vec3(-0.1f, -0.6f, 1))}) {
                const float alpha = roughness * roughness;
                CHECK(flat.at(constant, w, alpha) == Rgb(0.7f, 0.5f, 0.2f));
                const Rgb a = exact.at(described, w, alpha), b = maps.at(picture, w, alpha);
                CHECK(b == again.at(picture, w, alpha));
                for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(a[c] - b[c]) < 0.02f);
            }
        const auto contrast = [&](float alpha) {
            return exact.at(described, {0, 1, 0}, alpha).b - exact.at(described, {0, -1, 0}, alpha).b;
        };
        CHECK(contrast(0.01f) > contrast(0.25f));
        CHECK(contrast(0.25f) > contrast(1.0f));
        CHECK(contrast(0.01f) > 0.97f);
        CHECK(contrast(1.0f) > 0.4f);
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
    TEST_CASE("gbuffer reflections: a mirror shows the wall that the picture shows, elsewhere the sky") {
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
        settings.screen_reflections = false;
        const Rendering without = render(scene, view, settings);
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
                CHECK(without.radiance(x, y).g == doctest::Approx(0.25));
            }
        CHECK(wall > 500);
        CHECK(sky > 500);
        CHECK(wrong == 0);
        raster::RasterSettings one;
        one.threads = 1;
        CHECK(render(scene, view, one).radiance.pixels() == found.radiance.pixels());
    }
}
