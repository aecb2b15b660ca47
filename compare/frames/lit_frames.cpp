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

/// Collects the times of the frames of one number of threads.
class FrameTimes {
public:
    explicit FrameTimes(int threads) : threads_(threads) {}

    void measure(const raster::RasterScene& prepared, const View& view, const WorkStopwatch& clock, Rendering& image) {
        const CpuAffinity pinned(threads_);
        Control control;
        const double start = clock.seconds();
        const Stopwatch watch;
        raster::render(prepared, view, lit_settings(threads_), control, image);
        double rest = watch.seconds();
        frames_.push_back(clock.seconds() - start);
        std::vector<std::pair<std::string, double>> stages = image.statistics.seconds;
        for (const auto& [name, seconds] : stages) rest -= seconds;
        stages.emplace_back("other", rest);
        for (const auto& [name, seconds] : stages) {
            if (stages_[name].empty()) names_.push_back(name);
            stages_[name].push_back(seconds);
        }
    }
    LitRow medians() const {
        LitRow row{threads_, median(frames_), {}};
        for (const std::string& name : names_) row.stages.emplace_back(name, median(stages_.at(name)));
        return row;
    }

private:
    int threads_;
    std::vector<double> frames_;
    std::vector<std::string> names_; // of the stages, in the order of their first time
    std::map<std::string, std::vector<double>> stages_;
};

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
    std::vector<FrameTimes> rows;
    for (const int count : threads) {
        rows.emplace_back(count);
        FrameTimes(count).measure(prepared, view, clock, image); // touches the memory before it is timed
    }
    // The numbers of threads take turns, so that a change of the processor's speed meets all of them.
    for (int i = 0; i < settings.repeats && !(settings.stop != nullptr && *settings.stop); ++i)
        for (FrameTimes& row : rows) row.measure(prepared, view, clock, image);
    for (const FrameTimes& row : rows) result.rows.push_back(row.medians());
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
