#include "raytrace/render.h"

#include "common/system/error.h"
#include "common/system/stopwatch.h"
#include "raytrace/pass.h"

#include <algorithm>

namespace duet::raytrace {

namespace {

void check(const View& view, const Settings& settings) {
    if (view.width < 1 || view.height < 1)
        throw Error(message("picture of ", view.width, " x ", view.height, " pixels: expected at least 1 x 1"));
    if (settings.samples_per_pixel < 1)
        throw Error(message(settings.samples_per_pixel, " samples a pixel: expected at least 1"));
    if (settings.max_depth < 0) throw Error(message("depth ", settings.max_depth, ": expected at least 0"));
}

// The part of the work that is done after `samples`, as far as the limits let one know.
double fraction_done(const Settings& settings, std::uint32_t samples, double seconds) {
    const double by_count = samples / static_cast<double>(settings.samples_per_pixel);
    const double by_time = settings.time_limit > 0 ? seconds / settings.time_limit : 0;
    return std::min(std::max(by_count, by_time), 1.0);
}

// Two sums of three doubles, two counts and that of invalid samples, a pixel.
std::int64_t film_bytes(const Film& film) { return std::int64_t{64} * film.width() * film.height(); }

} // namespace

Rendering render(const Prepared& prepared, const View& view, const Settings& settings, Control& control) {
    check(view, settings);
    Stopwatch watch;
    const RenderPlan plan(prepared.data(), view, settings);
    Film film(view.width, view.height);
    AovBuffers aovs(plan, view, settings.aovs);
    RayCounts rays;
    const PassTarget target{plan, view, settings, control, film, aovs, rays};

    Rendering rendering;
    RenderStatistics& statistics = rendering.statistics;
    std::uint32_t done = 0;
    double progress = 0;
    while (const auto range = next_pass(settings, done, watch.seconds(), film)) {
        const double after = done > 0 ? watch.seconds() * range->last / done : 0;
        const double next = std::max(progress, fraction_done(settings, range->last, after));
        if (!render_pass(target, *range, progress, next)) {
            statistics.interrupted = true;
            break;
        }
        done = range->last;
        progress = next;
        ++statistics.passes;
    }
    statistics.seconds.emplace_back("trace", watch.lap());

    rendering.radiance = film.image();
    aovs.finish(film, rendering);
    statistics.samples_per_pixel = static_cast<int>(done);
    statistics.camera_rays = rays.camera;
    statistics.indirect_rays = rays.indirect;
    statistics.shadow_rays = rays.shadow;
    statistics.triangles = plan.prepared.accelerator.primitives();
    statistics.memory_bytes = plan.prepared.accelerator.memory_bytes() + film_bytes(film) + aovs.memory_bytes();
    statistics.bvh = plan.prepared.accelerator.statistics();
    statistics.invalid_samples = film.invalid_samples();
    statistics.estimated_relmse = film.estimated_relmse();
    statistics.skipped = skipped(plan, settings);
    statistics.approximations = approximations(plan, settings);
    statistics.seconds.emplace_back("resolve", watch.lap());
    return rendering;
}

} // namespace duet::raytrace
