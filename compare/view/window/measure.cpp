#include "compare/view/window/measure.h"

#include "common/program/statistics.h"
#include "common/system/error.h"
#include "common/system/stopwatch.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iomanip>
#include <iostream>

namespace duet::compare {

using nlohmann::json;

namespace {

// Draws a frame. Throws Error if the window was closed or the scene cannot be loaded, because nothing can be measured
// then.
void draw_frame(App& app, Window& window, double wait = 0) {
    window.begin_frame(wait);
    app.draw();
    window.end_frame();
    if (window.closing()) throw Error("the window was closed before its speed was measured");
    if (const LoadedScene loaded = app.live().loaded(); !loaded.error.empty()) throw Error(loaded.error);
}

// Returns the median and the 95th percentile, in milliseconds, of times in seconds.
json percentiles(std::vector<double> times) {
    const auto at = [&](double part) {
        const auto i = static_cast<std::ptrdiff_t>(part * static_cast<double>(times.size() - 1));
        std::nth_element(times.begin(), times.begin() + i, times.end());
        return 1000 * times[static_cast<std::size_t>(i)];
    };
    return {{"images", times.size()}, {"median_ms", at(0.5)}, {"p95_ms", at(0.95)}};
}

json measure_turn(App& app, Window& window, double seconds) {
    std::vector<double> intervals;
    double scales = 0;
    unsigned last = app.live().raster_frame()->version;
    Stopwatch watch, since_image;
    for (double angle = 0; watch.seconds() < seconds;) {
        draw_frame(app, window);
        const double now = 2 * kPiDouble * watch.seconds() / seconds;
        app.turn(now - angle);
        angle = now;
        const auto frame = app.live().raster_frame();
        if (frame->version == last) continue;
        last = frame->version;
        intervals.push_back(since_image.lap());
        scales += frame->scale;
    }
    if (intervals.empty()) intervals.push_back(seconds);
    const auto count = static_cast<double>(intervals.size());
    json result = percentiles(std::move(intervals));
    result["scale"] = scales / count;
    return result;
}

// Moves the first object back and forth with every frame of the window, as a user would drag it. Returns the times
// between images of edited scenes, for both pipelines, or null if the scene cannot be edited.
json measure_drag(App& app, Window& window, double seconds) {
    const Box3 bounds = app.live().loaded().scene->bounds;
    const double step = 1e-3 * static_cast<double>(length(bounds.diagonal()));
    struct Shown {
        unsigned load = 0;
        Stopwatch since{};
        std::vector<double> intervals{};
        void note(unsigned next) {
            if (next == load) return;
            load = next;
            intervals.push_back(since.lap());
        }
    } raster, traced;
    raster.load = app.live().raster_frame()->load;
    traced.load = app.live().tracer_frame()->load;
    const Stopwatch watch;
    for (int i = 0; watch.seconds() < seconds; ++i) {
        if (!app.move_first_object({i % 2 == 0 ? step : -step, 0, 0})) return nullptr;
        draw_frame(app, window);
        raster.note(app.live().raster_frame()->load);
        traced.note(app.live().tracer_frame()->load);
    }
    if (raster.intervals.empty()) raster.intervals.push_back(seconds);
    if (traced.intervals.empty()) traced.intervals.push_back(seconds);
    return {{"raster", percentiles(raster.intervals)}, {"raytrace", percentiles(traced.intervals)}};
}

// Returns the samples per second of the path tracer, in the window at rest and in a render without a window.
json measure_rates(App& app, Window& window, double seconds) {
    const Wish& wish = app.wish();
    const double pixels = static_cast<double>(wish.view.width) * wish.view.height;
    const auto traced = [&] { return app.live().tracer_frame(); };
    while (!app.live().finished(wish) &&
           (traced()->version != wish.version || traced()->preview || traced()->seconds < seconds))
        draw_frame(app, window, 0.25);
    const double in_window = traced()->samples * pixels / traced()->seconds;
    app.live().pause(true);
    raytrace::PathTracerSettings settings = wish.raytrace;
    settings.time_limit = seconds;
    Control control;
    const Stopwatch watch;
    const Rendering alone = render(app.live().loaded().raytrace->prepared, wish.view, settings, control);
    const double rate = static_cast<double>(alone.statistics.camera_rays) / watch.seconds();
    return {{"window", in_window}, {"raytrace", rate}};
}

} // namespace

void measure(App& app, Window& window, const ViewOptions& options) {
    while (!app.live().raster_frame() || !app.live().tracer_frame()) draw_frame(app, window);
    json result{
        {"scene", options.scene.string()}, {"width", app.wish().view.width}, {"height", app.wish().view.height}};
    for (const bool paused : {true, false}) {
        app.live().pause(paused);
        result[paused ? "path_tracer_paused" : "path_tracer_running"] = measure_turn(app, window, options.measure);
    }
    result["samples_per_second"] = measure_rates(app, window, options.measure);
    app.live().pause(false);
    result["drag"] = measure_drag(app, window, options.measure);
    for (const char* turn : {"path_tracer_paused", "path_tracer_running"}) {
        const json& row = result[turn];
        std::cout << std::fixed << std::setprecision(1) << turn << ": " << row["images"] << " images, median "
                  << row["median_ms"].get<double>() << " ms, 95th percentile " << row["p95_ms"].get<double>()
                  << " ms, width " << std::setprecision(2) << row["scale"].get<double>() << " of the whole\n";
    }
    const json& rates = result["samples_per_second"];
    std::cout << "path tracer: " << std::setprecision(2)
              << rates["window"].get<double>() / rates["raytrace"].get<double>() << " of raytrace's samples a second\n";
    if (const json& drag = result["drag"]; !drag.is_null())
        for (const char* program : {"raster", "raytrace"})
            std::cout << "object dragged, " << program << ": " << drag[program]["images"] << " images, median "
                      << std::setprecision(1) << drag[program]["median_ms"].get<double>() << " ms, 95th percentile "
                      << drag[program]["p95_ms"].get<double>() << " ms\n";
    if (!options.stats.empty()) write_json(options.stats, result);
}

} // namespace duet::compare
