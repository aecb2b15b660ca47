#include "raytrace/render.h"

#include "common/system/error.h"
#include "common/system/stopwatch.h"
#include "raytrace/bidirectional/bidirectional_pass.h"
#include "raytrace/film/film_checkpoint.h"
#include "raytrace/render_pass.h"
#include "raytrace/sample_schedule.h"

#include <algorithm>
#include <cmath>

namespace duet::raytrace {

namespace {

void check(const View& view, const PathTracerSettings& settings) {
    if (view.width < 1 || view.height < 1)
        throw Error(message("image of ", view.width, " x ", view.height, " pixels: expected at least 1 x 1"));
    if (settings.samples_per_pixel < 1)
        throw Error(message(settings.samples_per_pixel, " samples a pixel: expected at least 1"));
    if (!settings.film.empty() &&
        (settings.aovs.depth || settings.aovs.normal || settings.aovs.albedo || settings.aovs.hit))
        throw Error("a film keeps no depth, normal, albedo or hit: expected none of these auxiliary images with it");
    if (settings.first_sample > 0 && needs_sample_count(settings.sampler))
        throw Error(message("samples of the ", sampler_name(settings.sampler),
                            " sampler depend on how many there are, and are not taken in parts: expected another"));
    if (settings.adaptive && (settings.first_sample > 0 || needs_sample_count(settings.sampler)))
        throw Error(
            "adaptive sampling gives pixels different numbers of samples: expected no shard, and a sampler whose "
            "samples do not depend on how many there are");
    if (settings.max_depth < 0) throw Error(message("depth ", settings.max_depth, ": expected at least 0"));
}

// Returns the fraction of the work that is done after `samples` samples per pixel and `seconds`, as far as the
// limits on samples and time determine it.
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

} // namespace

Rendering render(const PathTracerScene& prepared, const View& view, const PathTracerSettings& settings,
                 Control& control) {
    check(view, settings);
    const bool bidirectional = traces_light_paths(settings.integrator);
    if (bidirectional) check_bidirectional(prepared.data().scene, settings);
    Stopwatch watch;
    Rendering rendering;
    const RenderPlan plan(prepared.data(), view, settings);
    rendering.statistics.seconds.emplace_back("plan", watch.lap());
    FilmCheckpoint checkpoint(plan.scene, view, settings);
    Film& film = checkpoint.film();
    AovBuffers aovs(plan, view, settings.aovs);
    RayCounts rays;
    const PassContext context{plan,       view, settings, control,
                              checkpoint, aovs, rays,     rendering.statistics.first_invalid};

    RenderStatistics& statistics = rendering.statistics;
    const auto pixels = static_cast<double>(film.pixels().size());
    const std::int64_t samples_at_start = film.total_samples_taken();
    double finished = film.min_samples_taken(), progress = 0; // finished: mean samples per pixel
    for (;;) {
        const SpentBudget spent{watch.seconds(), film.total_samples_taken() - samples_at_start};
        if (film.complete() && !plan_pass(settings, spent, film)) break;
        const double after = total_target(film) - static_cast<double>(samples_at_start);
        const double time = spent.samples > 0 ? spent.seconds * after / static_cast<double>(spent.samples) : 0;
        const double next = std::max(progress, fraction_done(settings, total_target(film) / pixels, time));
        if (!(bidirectional ? render_bidirectional_pass : render_pass)(context, progress, next)) {
            statistics.interrupted = true;
            break;
        }
        finished = static_cast<double>(film.total_samples_taken()) / pixels;
        progress = next;
        ++statistics.passes;
    }
    statistics.seconds.emplace_back("trace", watch.lap());
    if (!settings.film.empty()) {
        checkpoint.save();
        statistics.seconds.emplace_back("film", watch.lap());
    }

    rendering.radiance = film.image();
    aovs.finish(film, rendering);
    statistics.samples_per_pixel = static_cast<int>(std::lround(finished));
    statistics.camera_rays = rays.camera;
    statistics.indirect_rays = rays.indirect;
    statistics.shadow_rays = rays.shadow;
    statistics.triangles = plan.prepared.accelerator.primitives();
    statistics.memory_bytes = plan.prepared.accelerator.memory_bytes() + film_bytes(film) + aovs.memory_bytes();
    statistics.bvh = plan.prepared.accelerator.statistics();
    statistics.invalid_samples = film.invalid_samples();
    statistics.estimated_relmse = film.estimated_relmse();
    statistics.skipped = skipped(plan, settings);
    if (plan.russian_roulette) statistics.skipped.push_back({"paths ended by roulette", "dim ones", rays.ended});
    statistics.approximations = approximations(plan, settings);
    statistics.seconds.emplace_back("resolve", watch.lap());
    return rendering;
}

} // namespace duet::raytrace
