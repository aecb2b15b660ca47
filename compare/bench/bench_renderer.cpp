#include "compare/bench/bench_renderer.h"

#include "common/system/suggestion.h"
#include "compare/renderer.h"
#include "compare/report/text.h"
#include "compare/timing.h"
#include "raster/render.h"
#include "raytrace/bidirectional/bidirectional_pass.h"
#include "raytrace/render.h"

#include <algorithm>
#include <memory>
#include <optional>

namespace duet::compare {

namespace {

/// This is the path tracer with adaptive sampling.
constexpr std::string_view kAdaptive = "adaptive";
/// This is the path tracer whose image is denoised.
constexpr std::string_view kDenoised = "denoised";
/// This is the path tracer without Russian roulette.
constexpr std::string_view kNoRoulette = "no-roulette";

bool is_variant_of_path(const std::string& technique) {
    return technique == kAdaptive || technique == kDenoised || technique == kNoRoulette;
}

/// Returns one sentence on what keeps a technique from converging to the reference.
std::string note_of(raytrace::Integrator integrator, const Scene& scene) {
    using raytrace::Integrator;
    const bool delta_lights = scene.needs.delta_lights;
    switch (integrator) {
    case Integrator::kWhitted:
        return "Lights shine from their centers, and surfaces do not light each other.";
    case Integrator::kDirect:
        return "Light after more than one scattering is missing.";
    case Integrator::kUnshadowed:
        return "Direct light only, without shadows.";
    case Integrator::kVcm:
    case Integrator::kPhotons:
        return "Light is blurred by merging paths, less with more samples.";
    case Integrator::kNaive:
        return delta_lights ? "Point, spot and sun lights are missing." : "";
    default:
        return "";
    }
}

BenchRenderer raster_bench_renderer(const Scene& scene, const View& view, const RendererChoice& choice) {
    raster::RasterSettings settings;
    settings.threads = choice.threads;
    settings.samples_per_pixel = *std::max_element(choice.spps.begin(), choice.spps.end());
    const raster::RasterScene prepared = raster::prepare(scene, settings);
    return {"raster", "", joined(raster::approximations(prepared, settings), " "), choice.spps,
            [prepared, view, settings](int spp, std::uint64_t seed, Control& control) {
                raster::RasterSettings s = settings;
                s.samples_per_pixel = spp;
                s.seed = seed;
                return time_render([&] { return raster::render(prepared, view, s, control).radiance; }, control);
            }};
}

BenchRenderer path_tracer_bench_renderer(const raytrace::PathTracerScene& prepared, const Scene& scene,
                                         const View& view, const RendererChoice& choice, const std::string& technique,
                                         const std::string& sampler) {
    raytrace::PathTracerSettings settings;
    settings.threads = choice.threads;
    settings.max_depth = choice.depth;
    settings.adaptive = technique == kAdaptive;
    settings.denoise = technique == kDenoised;
    settings.russian_roulette = technique != kNoRoulette;
    settings.integrator = raytrace::integrator(is_variant_of_path(technique) ? "path" : technique);
    settings.sampler = sampler_kind(sampler);
    const int least_spp = settings.denoise ? 2 : 1;
    std::vector<int> spps = choice.spps;
    std::erase_if(spps, [&](int spp) { return spp < least_spp; });
    return {technique, sampler, note_of(settings.integrator, scene), std::move(spps),
            [prepared, view, settings, least_spp](int spp, std::uint64_t seed, Control& control) {
                raytrace::PathTracerSettings s = settings;
                s.samples_per_pixel = std::max(spp, least_spp); // the bench's warm-up render requests one sample
                s.seed = seed;
                const auto render = [&] {
                    Rendering rendering = raytrace::render(prepared, view, s, control);
                    return std::move(s.denoise ? rendering.denoised : rendering.radiance);
                };
                return time_render(render, control);
            }};
}

/// These techniques estimate the radiance of a scene. They are in the order of --help.
constexpr std::string_view kTechniques[] = {"raster",    "path",       kAdaptive,       kDenoised,
                                            kNoRoulette, "naive",      "bidirectional", "vcm",
                                            "photons",   "metropolis", "direct",        "unshadowed"};
/// These integrators may render references: their expected image has all light, or approaches that with more samples.
constexpr std::string_view kReferenceIntegrators[] = {"path", "bidirectional", "vcm", "photons"};
constexpr std::string_view kSamplers[] = {"sobol", "stratified", "independent"};

template <typename Names>
void check_names(const char* option, const std::vector<std::string>& found, const Names& known) {
    for (const std::string& name : found) name_index(option, name, {std::begin(known), std::end(known)});
}

} // namespace

TimedImage time_render(const std::function<ImageRgb()>& render, const Control& control) {
    TimedImage trial;
    int times = 0;
    const Stopwatch watch;
    const double cpu = processor_seconds();
    do {
        trial.image = render();
        ++times;
    } while (watch.seconds() < kMinTimingSeconds && !control.stopped());
    trial.seconds = watch.seconds() / times;
    trial.cpu_seconds = (processor_seconds() - cpu) / times;
    return trial;
}

void check_renderer_choice(const RendererChoice& choice) {
    check_names("--techniques", choice.techniques, kTechniques);
    check_names("--samplers", choice.samplers, kSamplers);
}

void check_reference_integrator(const std::string& name) {
    check_names("--reference-by", {name}, kReferenceIntegrators);
}

void check_supported(const Scene& scene, std::vector<std::string> techniques, const std::string& reference_by) {
    techniques.push_back(reference_by);
    for (const std::string& technique : techniques) {
        if (technique == "raster" || is_variant_of_path(technique)) continue;
        raytrace::PathTracerSettings settings;
        settings.integrator = raytrace::integrator(technique);
        settings.adaptive = false;
        if (traces_light_paths(settings.integrator)) raytrace::check_bidirectional(scene, settings);
    }
}

std::vector<BenchRenderer> duet_renderers(const Scene& scene, const View& view, const RendererChoice& choice) {
    check_renderer_choice(choice);
    std::optional<raytrace::PathTracerScene> traced; // one BVH for all renderers
    std::vector<BenchRenderer> renderers;
    for (const std::string& technique : choice.techniques) {
        if (technique == "raster") {
            renderers.push_back(raster_bench_renderer(scene, view, choice));
            continue;
        }
        if (!traced) {
            raytrace::PathTracerSettings settings;
            settings.threads = choice.threads;
            traced = raytrace::prepare(scene, settings);
        }
        for (const std::string& sampler : choice.samplers) {
            if (technique == kAdaptive && needs_sample_count(sampler_kind(sampler))) continue; // sample counts vary
            renderers.push_back(path_tracer_bench_renderer(*traced, scene, view, choice, technique, sampler));
        }
    }
    return renderers;
}

} // namespace duet::compare
