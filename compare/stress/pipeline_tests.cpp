// These tests run whole pipelines: both must find the same hits, and the images must be bitwise equal for any number
// of threads.
#include "compare/check/scene_check.h"
#include "compare/hits/hit_agreement.h"
#include "compare/renderer.h"
#include "compare/stress/random_scene.h"
#include "compare/stress/textbook_tracer.h"
#include "raster/render.h"
#include "raytrace/render.h"

#include <algorithm>
#include <span>

namespace duet::compare {

namespace {

// Hits ---------------------------------------------------------------------------------------------------------------

constexpr int kWidth = 32, kHeight = 24;

bool same_primitive(const Hit& a, const Hit& b) {
    return a.object == b.object && (!a.valid() || a.primitive == b.primitive);
}

/// Returns the reference with at most `most` of the differing pixels of `hits`, chosen at random. Judging a wrong
/// pixel takes thousands of rays, and a trial with many wrong pixels has failed in any case.
Image<Hit> sample_differences(const Image<Hit>& hits, const Image<Hit>& reference, std::size_t most,
                              TrialRandom& random) {
    std::vector<std::size_t> different;
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (!same_primitive(hits[i], reference[i])) different.push_back(i);
    Image<Hit> result = reference;
    for (std::size_t k = 0; k < std::min(most, different.size()); ++k) {
        std::swap(different[k], different[k + random.below(static_cast<std::uint32_t>(different.size() - k))]);
        result[different[k]] = hits[different[k]];
    }
    return result;
}

Image<Hit> textbook_hits(const TrialScene& trial) {
    const TextbookTracer textbook(trial.scene);
    const CameraModel camera(trial.view);
    Image<Hit> hits(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) hits(x, y) = textbook.nearest(camera.ray({x + 0.5, y + 0.5}));
    return hits;
}

void check_hits(Trial& trial, const TrialScene& random) {
    Control control;
    const ComparisonSettings settings{.threads = 1}; // trials already run in parallel
    const Image<Hit> raster = raster_hits(random.scene, settings)(random.view, control).hit;
    const Image<Hit> raytrace = raytrace_hits(random.scene, settings)(random.view, control).hit;
    const auto judge = [&](const Image<Hit>& hits, std::size_t most) {
        const Image<Hit> judged = sample_differences(hits, raytrace, most, trial.random);
        return compare_hits(random.scene, random.view, judged, raytrace, 1);
    };
    const HitAgreement agreement = judge(raster, 16), textbook = judge(textbook_hits(random), 4);
    if (!agreement.listed.empty()) trial.note(agreement.listed.front().describe());
    if (agreement.distance_violations > 0)
        trial.note("distances apart by ", agreement.worst_distance, " at pixel (", agreement.worst_x, ", ",
                   agreement.worst_y, ")");
    trial.record(static_cast<double>(agreement.unexplained + agreement.distance_violations));
    trial.record_naive(static_cast<double>(textbook.unexplained));
}

template <SceneContents contents> void hits_of(Trial& trial) {
    check_hits(trial, random_scene(trial.random, contents, {}, kWidth, kHeight));
}

constexpr SceneContents kAll{.soup = true, .meshes = true, .spheres = true, .quads = true, .instances = true};

void hits_at_scales(Trial& trial) {
    const Placement placement{.offset = {}, .scale = trial.random.log_uniform(1e-6f, 1e6f)};
    trial.note("scale ", exact(placement.scale));
    check_hits(trial, random_scene(trial.random, kAll, placement, kWidth, kHeight));
}

void hits_far_away(Trial& trial) {
    const Placement placement{.offset = trial.random.vector() * 1e5f, .scale = 1};
    trial.note("at ", exact(placement.offset));
    check_hits(trial, random_scene(trial.random, kAll, placement, kWidth, kHeight));
}

// Threads ------------------------------------------------------------------------------------------------------------

template <typename Settings> Settings settings_with_all_aovs(int threads) {
    Settings settings;
    settings.threads = threads;
    settings.samples_per_pixel = 6;
    settings.aovs = kAllAovs;
    return settings;
}
Rendering render_raster(const TrialScene& trial, int threads) {
    Control control;
    auto settings = settings_with_all_aovs<raster::RasterSettings>(threads);
    settings.shadow_map_side = 128;
    return raster::render(raster::prepare(trial.scene, settings), trial.view, settings, control);
}
Rendering render_raytrace(const TrialScene& trial, int threads) {
    Control control;
    const auto settings = settings_with_all_aovs<raytrace::PathTracerSettings>(threads);
    return raytrace::render(raytrace::prepare(trial.scene, settings), trial.view, settings, control);
}

template <Rendering (*render)(const TrialScene&, int)>
StressResult threads(const StressTest& test, const StressSetting& setting) {
    StressSetting single_threaded = setting;
    single_threaded.threads = 1; // a trial uses its own threads
    return run_trials(test, single_threaded, [](Trial& trial) {
        const TrialScene random = random_lit_scene(trial.random, 100, 75);
        const Rendering one = render(random, 1);
        int different = 0;
        for (const int count : {2, 3, 7}) different += !same_bits(render(random, count), one);
        trial.record(different);
    });
}

constexpr std::string_view kHitSource =
    "where they differ (16 such pixels a trial at most), rays in double precision within 1/128 pixel see the one and "
    "the other, or a tie (compare/hits); distances within 1e-5 of the primitive's reach";
constexpr std::string_view kTextbookMethod =
    "Moeller-Trumbore and t > 0.001 in float; four such pixels a trial at most";

constexpr StressTest row(std::string_view name, std::string_view what, std::int64_t trials,
                         StressResult (*run)(const StressTest&, const StressSetting&)) {
    return {name, what, 0, "unexplained pixels", kHitSource, kTextbookMethod, trials, run};
}

constexpr std::string_view kSameBits =
    "the definition: numbers depend on pixel and sample, sums are made in their order";

constexpr StressTest kTests[] = {
    row("pipeline/hits-soup",
        "both pipelines see the same in a soup of triangles of all sizes, before the eye and behind", 2000,
        trials_of<hits_of<SceneContents{.soup = true}>>),
    row("pipeline/hits-meshes", "both pipelines see the same of closed meshes, from outside and within", 500,
        trials_of<hits_of<SceneContents{.meshes = true}>>),
    row("pipeline/hits-spheres", "both pipelines see the same of spheres and ellipsoids, from outside and within", 1500,
        trials_of<hits_of<SceneContents{.spheres = true, .instances = true}>>),
    row("pipeline/hits-quads", "both pipelines see the same of boxes and walls", 1500,
        trials_of<hits_of<SceneContents{.quads = true}>>),
    row("pipeline/hits-instances", "both pipelines see the same of all shapes turned, stretched and mirrored", 300,
        trials_of<hits_of<kAll>>),
    row("pipeline/hits-scales", "both pipelines see the same in scenes of all shapes at scales from 1e-6 to 1e6", 300,
        trials_of<hits_at_scales>),
    row("pipeline/hits-far", "both pipelines see the same in scenes of all shapes up to 1e5 meters from the origin",
        300, trials_of<hits_far_away>),
    {.name = "pipeline/threads-raster",
     .what = "2, 3 and 7 threads give the rasterizer's bits of one, in the image and all auxiliary ones",
     .bound = 0,
     .unit = "different",
     .source = kSameBits,
     .naive = "",
     .trials = 8,
     .run = threads<render_raster>},
    {.name = "pipeline/threads-raytrace",
     .what = "2, 3 and 7 threads give the path tracer's bits of one, in the image and all auxiliary ones",
     .bound = 0,
     .unit = "different",
     .source = kSameBits,
     .naive = "",
     .trials = 8,
     .run = threads<render_raytrace>},
};

} // namespace

std::span<const StressTest> pipeline_tests() { return kTests; }

} // namespace duet::compare
