// These tests check renders that grow sample by sample: they have the bits of a render with that many samples.
#include "raytrace/progressive_render.h"

#include "common/system/error.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

Scene room() {
    SceneBuilder builder;
    const std::uint32_t grey = builder.material(Diffuse{{Rgb(0.5f, 0.6f, 0.7f)}});
    builder.add(quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}), grey);
    builder.add(Sphere{{-0.7f, 0, 0}, 1}, builder.material(Metal{{Rgb(0.9f)}, 0.3f}));
    builder.add(quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), builder.material(Emissive{Rgb(4.0f)}));
    builder.scene.environment = SkyEnvironment{};
    return builder.finish();
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a progressive render has the bits of a render with as many samples, with every integrator") {
        const Scene scene = room();
        const View view{scene.camera, 40, 30};
        for (const Integrator integrator :
             {Integrator::kPath, Integrator::kBidirectional, Integrator::kVcm, Integrator::kMetropolis,
              Integrator::kNormal})
            for (const bool variance : {false, true}) {
                CAPTURE(integrator_name(integrator));
                PathTracerSettings settings;
                settings.integrator = integrator;
                settings.aovs.variance = variance;
                const PathTracerScene prepared = prepare(scene, settings);
                ProgressiveRender progressive(prepared, view, settings);
                Control control;
                settings.samples_per_pixel = 0;
                for (const std::uint32_t samples : {1u, 2u, 5u}) {
                    CHECK(progressive.add_samples(samples, control));
                    settings.samples_per_pixel += static_cast<int>(samples);
                }
                const Rendering expected = render(prepared, view, settings, control);
                CHECK(progressive.film().image().pixels() == expected.radiance.pixels());
                if (variance) CHECK(progressive.film().estimated_relmse() == expected.statistics.estimated_relmse);
            }
    }

    TEST_CASE("a stopped step is finished by the next one") {
        const Scene scene = room();
        const View view{scene.camera, 80, 60};
        PathTracerSettings settings;
        settings.samples_per_pixel = 4;
        const PathTracerScene prepared = prepare(scene, settings);
        ProgressiveRender progressive(prepared, view, settings);
        std::atomic<bool> stop = false;
        Control stopping{&stop, [&](double) { stop = true; }}, control; // after the first tile
        CHECK_FALSE(progressive.add_samples(4, stopping));
        CHECK(progressive.film().min_samples_taken() == 0);
        CHECK(progressive.film().total_samples_taken() > 0);
        CHECK(progressive.add_samples(1, control));
        CHECK(progressive.film().image().pixels() == render(prepared, view, settings, control).radiance.pixels());
    }

    TEST_CASE("samplers that need the number of samples, films and adaptive sampling are refused") {
        const Scene scene = room();
        const View view{scene.camera, 8, 6};
        const PathTracerScene prepared = prepare(scene, {});
        PathTracerSettings stratified, film, adaptive, deep;
        stratified.sampler = SamplerKind::kStratified;
        film.film = "some.film";
        adaptive.adaptive = true;
        deep.max_depth = -1;
        for (const PathTracerSettings& settings : {stratified, film, adaptive, deep})
            CHECK_THROWS_AS(ProgressiveRender(prepared, view, settings), Error);
    }
}
