#include "raytrace/render.h"

#include "common/system/stopwatch.h"
#include "raytrace/denoise/denoise.h"
#include "raytrace/denoise/features.h"
#include "raytrace/render_state.h"
#include "raytrace/sample_schedule.h"

#include <algorithm>
#include <cmath>

namespace duet::raytrace {

namespace {

// Returns the fraction of the work that is done after `samples` samples per pixel and `seconds`, as far as the limits
// on samples and time determine it.
double fraction_done(const PathTracerSettings& settings, double samples, double seconds) {
    const double by_count = samples / static_cast<double>(settings.samples_per_pixel);
    const double by_time = settings.time_limit > 0 ? seconds / settings.time_limit : 0;
    return std::min(std::max(by_count, by_time), 1.0);
}

double total_target(const Film& film) {
    double sum = 0;
    for (const Film::Pixel& pixel : film.pixels()) sum += pixel.target;
    return sum;
}

std::int64_t film_bytes(const Film& film) {
    return static_cast<std::int64_t>(sizeof(Film::Pixel)) * film.width() * film.height();
}

// Fills in what the statistics say about the image, the work done and the scene.
void fill_statistics(const PathTracerSceneData& scene, const RenderState& state, RenderStatistics& statistics) {
    const Film& film = state.checkpoint.film();
    statistics.first_invalid = state.first_invalid;
    statistics.camera_rays = state.rays.camera;
    statistics.indirect_rays = state.rays.indirect;
    statistics.shadow_rays = state.rays.shadow;
    statistics.triangles = scene.accelerator.primitives();
    statistics.memory_bytes = scene.accelerator.memory_bytes() + film_bytes(film) + state.aovs.memory_bytes();
    statistics.bvh = scene.accelerator.statistics();
    statistics.invalid_samples = film.invalid_samples();
    statistics.estimated_relmse = film.estimated_relmse();
    statistics.skipped = skipped(state.plan, state.settings);
    if (state.plan.russian_roulette)
        statistics.skipped.push_back(
            {"paths ended by Russian roulette", "each carried little light", state.rays.ended});
    statistics.approximations = approximations(state.plan, state.settings);
}

} // namespace

Rendering render(const PathTracerScene& prepared, const View& view, const PathTracerSettings& settings,
                 Control& control) {
    Stopwatch watch;
    Rendering rendering;
    RenderState state(prepared.data(), view, settings);
    rendering.statistics.seconds.emplace_back("plan", watch.lap());
    Film& film = state.checkpoint.film();

    RenderStatistics& statistics = rendering.statistics;
    const auto pixels = static_cast<double>(film.pixels().size());
    const std::int64_t samples_at_start = film.total_samples_taken();
    const auto mean_samples = [&] { return static_cast<double>(film.total_samples_taken()) / pixels; };
    // Only whole passes count. With adaptive sampling the mean number of samples is used, because the minimum is
    // meaningless.
    double finished = settings.adaptive ? mean_samples() : film.min_samples_taken(), progress = 0;
    for (;;) {
        const SpentBudget spent{watch.seconds(), film.total_samples_taken() - samples_at_start};
        if (film.complete() && !plan_pass(settings, spent, film)) break;
        const double after = total_target(film) - static_cast<double>(samples_at_start);
        const double time = spent.samples > 0 ? spent.seconds * after / static_cast<double>(spent.samples) : 0;
        const double next = std::max(progress, fraction_done(settings, total_target(film) / pixels, time));
        if (!state.run_pass(control, progress, next)) {
            statistics.interrupted = true;
            break;
        }
        finished = mean_samples();
        progress = next;
        ++statistics.passes;
    }
    statistics.seconds.emplace_back("trace", watch.lap());
    if (!settings.film.empty()) {
        state.checkpoint.save();
        statistics.seconds.emplace_back("film", watch.lap());
    }

    rendering.radiance = film.image();
    state.aovs.finish(film, rendering);
    statistics.samples_per_pixel = static_cast<int>(std::lround(finished));
    fill_statistics(prepared.data(), state, statistics);
    statistics.seconds.emplace_back("resolve", watch.lap());
    if (settings.denoise) {
        const Planes features = trace_features(state.plan, view, settings);
        statistics.seconds.emplace_back("features", watch.lap());
        rendering.denoised = denoise(film, features, settings.threads);
        statistics.seconds.emplace_back("denoise", watch.lap());
    }
    return rendering;
}

} // namespace duet::raytrace
