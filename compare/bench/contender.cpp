#include "compare/bench/contender.h"

#include "common/system/stopwatch.h"
#include "compare/pipeline.h"
#include "raster/render.h"
#include "raytrace/render.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <sys/resource.h>

namespace duet::compare {

namespace {

double cpu_seconds_so_far() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// The path tracer with adaptive sampling.
constexpr std::string_view kAdaptive = "adaptive";
/// The path tracer without Russian roulette.
constexpr std::string_view kNoRoulette = "no-roulette";

/// Returns what keeps a technique from converging to the reference, as a sentence.
std::string note_of(raytrace::Integrator integrator, const Scene& scene) {
    using raytrace::Integrator;
    const bool delta_lights = scene.needs.delta_lights;
    switch (integrator) {
    case Integrator::kDirect:
        return "Light after more than one scattering is missing.";
    case Integrator::kUnshadowed:
        return "Direct light only, without shadows.";
    case Integrator::kNaive:
        return delta_lights ? "Point, spot and sun lights are missing." : "";
    default:
        return "";
    }
}

Contender raster_contender(const Scene& scene, const View& view, const ContenderChoice& choice) {
    raster::Settings settings;
    settings.threads = choice.threads;
    settings.samples_per_pixel = *std::max_element(choice.spps.begin(), choice.spps.end());
    const raster::Prepared prepared = raster::prepare(scene, settings);
    return {"raster", "", paragraph(raster::approximations(prepared, settings)), choice.spps,
            [prepared, view, settings](int spp, std::uint64_t seed, Control& control) {
                raster::Settings s = settings;
                s.samples_per_pixel = spp;
                s.seed = seed;
                return timed([&] { return raster::render(prepared, view, s, control).radiance; }, control);
            }};
}

Contender raytrace_contender(const raytrace::Prepared& prepared, const Scene& scene, const View& view,
                             const ContenderChoice& choice, const std::string& technique, const std::string& sampler) {
    raytrace::Settings settings;
    settings.threads = choice.threads;
    settings.max_depth = choice.depth;
    settings.adaptive = technique == kAdaptive;
    settings.russian_roulette = technique != kNoRoulette;
    settings.integrator = raytrace::integrator(technique == kAdaptive || technique == kNoRoulette ? "path" : technique);
    settings.sampler = sampler_kind(sampler);
    return {technique, sampler, note_of(settings.integrator, scene), choice.spps,
            [prepared, view, settings](int spp, std::uint64_t seed, Control& control) {
                raytrace::Settings s = settings;
                s.samples_per_pixel = spp;
                s.seed = seed;
                return timed([&] { return raytrace::render(prepared, view, s, control).radiance; }, control);
            }};
}

/// The techniques that estimate light, in the order of --help.
constexpr std::string_view kTechniques[] = {"raster", "path", kAdaptive, kNoRoulette, "naive", "direct", "unshadowed"};
constexpr std::string_view kSamplers[] = {"sobol", "stratified", "independent"};

template <typename Names> std::string listed(const Names& names) {
    std::string text;
    for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
    return text;
}

template <typename Names>
void check_names(const char* option, const std::vector<std::string>& found, const Names& known) {
    for (const std::string& name : found)
        if (std::find(std::begin(known), std::end(known), name) == std::end(known))
            throw Error(message(option, ": found ", name, ", expected one or more of ", listed(known)));
}

} // namespace

Trial timed(const std::function<ImageRgb()>& render, const Control& control) {
    Trial trial;
    int times = 0;
    const Stopwatch watch;
    const double cpu = cpu_seconds_so_far();
    do {
        trial.picture = render();
        ++times;
    } while (watch.seconds() < kShortestTiming && !control.stopped());
    trial.seconds = watch.seconds() / times;
    trial.cpu_seconds = (cpu_seconds_so_far() - cpu) / times;
    return trial;
}

void check_choice(const ContenderChoice& choice) {
    check_names("--techniques", choice.techniques, kTechniques);
    check_names("--samplers", choice.samplers, kSamplers);
}

std::vector<Contender> our_contenders(const Scene& scene, const View& view, const ContenderChoice& choice) {
    check_choice(choice);
    std::optional<raytrace::Prepared> traced; // one BVH for all contenders
    std::vector<Contender> contenders;
    for (const std::string& technique : choice.techniques) {
        if (technique == "raster") {
            contenders.push_back(raster_contender(scene, view, choice));
            continue;
        }
        if (!traced) {
            raytrace::Settings settings;
            settings.threads = choice.threads;
            traced = raytrace::prepare(scene, settings);
        }
        for (const std::string& sampler : choice.samplers) {
            if (technique == kAdaptive && depends_on_count(sampler_kind(sampler))) continue; // counts vary by pixel
            contenders.push_back(raytrace_contender(*traced, scene, view, choice, technique, sampler));
        }
    }
    return contenders;
}

} // namespace duet::compare
