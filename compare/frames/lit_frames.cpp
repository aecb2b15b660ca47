#include "compare/frames/lit_frames.h"

#include "common/scene/scene.h"
#include "compare/frames/cpu_affinity.h"
#include "compare/metrics/image_metrics.h"
#include "compare/report/text.h"
#include "compare/timing.h"

#include <map>
#include <nlohmann/json.hpp>

namespace duet::compare {
namespace {

raster::RasterSettings lit_settings(int threads) {
    raster::RasterSettings settings;
    settings.threads = threads;
    settings.output = raster::Output::kSrgb8;
    return settings;
}

LitRow measure_row(const raster::RasterScene& prepared, const View& view, int threads, const FrameSettings& settings,
                   Rendering& image) {
    const CpuAffinity pinned(threads);
    const raster::RasterSettings lit = lit_settings(threads);
    const WorkStopwatch clock(settings.processor_time);
    Control control;
    raster::render(prepared, view, lit, control, image); // touches the memory before it is timed
    std::vector<double> frames;
    std::vector<std::string> names;
    std::map<std::string, std::vector<double>> stages;
    for (int i = 0; i < settings.repeats && !(settings.stop != nullptr && *settings.stop); ++i) {
        const double start = clock.seconds();
        const Stopwatch watch;
        raster::render(prepared, view, lit, control, image);
        double rest = watch.seconds();
        frames.push_back(clock.seconds() - start);
        std::vector<std::pair<std::string, double>> these = image.statistics.seconds;
        for (const auto& [name, seconds] : these) rest -= seconds;
        these.emplace_back("other", rest);
        for (const auto& [name, seconds] : these) {
            if (stages[name].empty()) names.push_back(name);
            stages[name].push_back(seconds);
        }
    }
    LitRow row{threads, median(frames), {}};
    for (const std::string& name : names) row.stages.emplace_back(name, median(stages[name]));
    return row;
}

/// Returns the speedup of a row over one processor, or "-" if that was not measured.
std::string scaling(const LitScene& scene, const LitRow& row) {
    for (const LitRow& one : scene.rows)
        if (one.threads == 1 && row.threads > 1) return fixed(one.frame / row.frame, 2);
    return "-";
}

} // namespace

LitScene measure_lit_frames(const std::filesystem::path& path, const std::vector<int>& threads,
                            const FrameSettings& settings) {
    const Scene scene = load_scene(path);
    LitScene result;
    result.name = path.stem().string();
    const WorkStopwatch clock(settings.processor_time);
    const auto prepared = [&] {
        const CpuAffinity pinned(threads.back());
        return raster::prepare(scene, lit_settings(threads.back()));
    }();
    result.prepare = clock.seconds();
    const View view{scene.camera, settings.size.width, settings.size.height};
    Rendering image;
    for (const int count : threads) result.rows.push_back(measure_row(prepared, view, count, settings, image));
    result.image = encoded_values(image.srgb);
    return result;
}

void print_lit_frames(std::ostream& out, const std::vector<LitScene>& scenes, const FrameSettings& settings) {
    const std::vector<int> widths{-16, 9, 9, 9, 9};
    out << "Lit frames of " << settings.size.width << "x" << settings.size.height
        << " pixels, one sample per pixel: milliseconds ("
        << "medians of " << settings.repeats << ")\n";
    print_cells(out, widths, {"scene", "threads", "prepare", "frame", "scaling"});
    for (const LitScene& scene : scenes)
        for (const LitRow& row : scene.rows)
            print_cells(out, widths,
                        {scene.name, std::to_string(row.threads), milliseconds(scene.prepare), milliseconds(row.frame),
                         scaling(scene, row)});
    for (const LitScene& scene : scenes) {
        const LitRow& row = scene.rows.back();
        std::vector<std::string> stages;
        for (const auto& [name, seconds] : row.stages)
            if (seconds >= 5e-5) stages.push_back(name + ' ' + milliseconds(seconds));
        out << scene.name << ", " << row.threads << (row.threads == 1 ? " thread: " : " threads: ") << joined(stages)
            << '\n';
    }
}

nlohmann::json lit_json(const LitScene& scene) {
    nlohmann::json rows = nlohmann::json::array();
    for (const LitRow& row : scene.rows) {
        nlohmann::json stages = nlohmann::json::object();
        for (const auto& [name, seconds] : row.stages) stages[name] = seconds;
        rows.push_back({{"threads", row.threads}, {"frame_seconds", row.frame}, {"stages", stages}});
    }
    return {{"scene", scene.name}, {"prepare_seconds", scene.prepare}, {"rows", rows}};
}

} // namespace duet::compare
