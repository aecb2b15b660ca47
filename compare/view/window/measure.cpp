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

// Draws a frame. Throws Error if the window was closed or the scene cannot be loaded: there is nothing to measure.
void draw_frame(App& app, Window& window, double wait = 0) {
    window.begin_frame(wait);
    app.draw();
    window.end_frame();
    if (window.closing()) throw Error("the window was closed before its speed was measured");
    if (const LoadedScene loaded = app.live().loaded(); !loaded.error.empty()) throw Error(loaded.error);
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
    const auto at = [&](double part) {
        const auto i = static_cast<std::ptrdiff_t>(part * (count - 1));
        std::nth_element(intervals.begin(), intervals.begin() + i, intervals.end());
        return 1000 * intervals[static_cast<std::size_t>(i)];
    };
    return {{"images", intervals.size()}, {"median_ms", at(0.5)}, {"p95_ms", at(0.95)}, {"scale", scales / count}};
}

// Returns samples of pixels per second, of the window at rest and of a render without one.
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
    for (const char* turn : {"path_tracer_paused", "path_tracer_running"}) {
        const json& row = result[turn];
        std::cout << std::fixed << std::setprecision(1) << turn << ": " << row["images"] << " images, median "
                  << row["median_ms"].get<double>() << " ms, 95th percentile " << row["p95_ms"].get<double>()
                  << " ms, width " << std::setprecision(2) << row["scale"].get<double>() << " of the whole\n";
    }
    const json& rates = result["samples_per_second"];
    std::cout << "path tracer: " << std::setprecision(2)
              << rates["window"].get<double>() / rates["raytrace"].get<double>() << " of raytrace's samples a second\n";
    if (!options.stats.empty()) write_json(options.stats, result);
}

} // namespace duet::compare
