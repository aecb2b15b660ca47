#include "compare/frames/frames.h"

#include "common/image/image_file.h"
#include "common/program/program.h"
#include "common/program/statistics.h"
#include "common/system/error.h"
#include "common/system/file.h"
#include "compare/frames/bandwidth.h"
#include "compare/frames/cpu_affinity.h"
#include "compare/frames/lit_frames.h"
#include "compare/metrics/image_metrics.h"
#include "compare/report/text.h"

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

namespace duet::compare {

const char* name(FrameWork work) { return work == FrameWork::kPhong ? "phong" : "depth"; }

namespace {

using nlohmann::json;

/// Holds the rows of one mesh.
struct MeshRows {
    std::string mesh;
    std::size_t triangles = 0;
    std::vector<FrameRow> rows;
};

/// Returns the speedup over one processor; 0 if that was not measured.
double scaling(const MeshRows& mesh, const FrameRow& row) {
    for (const FrameRow& one : mesh.rows)
        if (one.threads == 1 && row.threads > 1 && one.work == row.work && one.view == row.view)
            return one.ours / row.ours;
    return 0;
}

json row_json(const MeshRows& mesh, const FrameRow& row) {
    json result = {{"mesh", mesh.mesh},          {"triangles", mesh.triangles},   {"work", name(row.work)},
                   {"view", name(row.view)},     {"threads", row.threads},        {"covered", row.covered},
                   {"ours", 1 / row.ours},       {"peer", nullptr},               {"peer_name", nullptr},
                   {"ratio", nullptr},           {"difference", nullptr},         {"scaling", nullptr}};
    if (const double times = scaling(mesh, row); times > 0) result["scaling"] = times;
    if (!row.difference) return result;
    result["peer"] = 1 / row.peer;
    result["peer_name"] = row.peer_name;
    result["ratio"] = {{"min", row.ratio.min}, {"median", row.ratio.median}, {"max", row.ratio.max}};
    const FrameDifference& d = *row.difference;
    result["difference"] = {{"coverage", d.coverage}, {"mean", d.mean}, {"flip", d.flip}, {"same", d.same()}};
    return result;
}

std::string difference_text(const FrameRow& row) {
    if (!row.difference) return "";
    const FrameDifference& d = *row.difference;
    std::string text = "coverage " + significant(100 * d.coverage, 2) + " %, mean " + significant(d.mean, 2);
    if (row.work == FrameWork::kPhong) text += ", FLIP " + significant(d.flip, 2);
    return text + (d.same() ? "" : " NOT THE SAME PICTURE");
}

void print_table(std::ostream& out, const FramesOptions& options, const std::vector<MeshRows>& meshes) {
    const ImageSize size = options.settings.size;
    out << size.width << "x" << size.height << " pixels, milliseconds a frame (medians of "
        << options.settings.repeats << " repeats in turns); ratio: the peer's time over ours\n";
    const std::vector<int> widths{-26, -7, -7, 8, 9, 9, 9, 8, 8, 8, 8, 2, 0};
    print_cells(out, widths,
                {"mesh", "view", "work", "threads", "covered", "ours", "peer", "min", "median", "max", "scaling", "",
                 "difference of the images"});
    for (const MeshRows& mesh : meshes)
        for (const FrameRow& row : mesh.rows) {
            const bool peer = row.difference.has_value();
            const auto ratio = [&](double value) { return peer ? fixed(value, 2) : "-"; };
            const double times = scaling(mesh, row);
            print_cells(out, widths,
                        {mesh.mesh + " " + std::to_string(mesh.triangles), name(row.view), name(row.work),
                         std::to_string(row.threads), fixed(100 * row.covered, 1) + " %", milliseconds(row.ours),
                         peer ? milliseconds(row.peer) : "-", ratio(row.ratio.min), ratio(row.ratio.median),
                         ratio(row.ratio.max), times > 0 ? fixed(times, 2) : "-", "", difference_text(row)});
        }
    for (const MeshRows& mesh : meshes)
        for (const FrameRow& row : mesh.rows)
            if (!row.peer_name.empty()) {
                out << "peer: " << row.peer_name << '\n';
                return;
            }
    out << (LlvmpipeRenderer::built() ? "no peer was requested\n" : "no peer: this program was built without EGL\n");
}

void write_images(const std::filesystem::path& folder, const MeshRows& mesh) {
    const auto write = [&](const FrameRow& row, const char* whose, const ImageRgb& image) {
        if (image.empty()) return;
        write_image(folder / (mesh.mesh + "-" + name(row.view) + "-" + whose + ".png"), decoded(image));
    };
    for (const FrameRow& row : mesh.rows) {
        if (row.threads != mesh.rows.front().threads) continue;
        write(row, "ours", row.image);
        write(row, "peer", row.peer_image);
    }
}

bool is_scene(const std::filesystem::path& file) { return lower_case_extension(file) == ".json"; }

/// Measures all rows of a mesh. Returns false after an interrupt signal.
bool measure_mesh(const FramesOptions& options, const FrameSettings& settings, const std::vector<int>& threads,
                  MeshRows& mesh, const Scene& scene, ProgressBar& bar, double first, double share) {
    raster::RasterSettings phong; // no frame here casts shadows
    phong.shading = raster::Shading::kPhong;
    const raster::RasterScene prepared = raster::prepare(scene, phong);
    double done = 0;
    for (const FrameView view : options.views)
        for (const int count : threads) {
            std::vector<FrameRow> rows = measure_frames(scene, prepared, view, count, options.works, settings);
            if (*settings.stop) return false;
            std::move(rows.begin(), rows.end(), std::back_inserter(mesh.rows));
            done += 1;
            bar.update(first + share * done / static_cast<double>(options.views.size() * threads.size()));
        }
    return true;
}

std::vector<int> thread_counts(const FramesOptions& options) {
    if (!options.threads.empty()) return options.threads;
    const int all = CpuAffinity::available();
    return all > 1 ? std::vector<int>{1, all} : std::vector<int>{1};
}

} // namespace

int frames(const FramesOptions& options) {
    check_json_path(options.stats);
    if (!options.texture.empty())
        for (const std::filesystem::path& file : options.files)
            if (is_scene(file)) throw Error(message("--texture: found the scene ", file, ", expected meshes alone"));
    const InterruptFlag interrupt;
    FrameSettings settings = options.settings;
    settings.stop = &interrupt.flag();
    settings.no_peer |= !options.texture.empty(); // the peer has no textures
    const std::vector<int> threads = thread_counts(options);
    if (!options.folder.empty()) std::filesystem::create_directories(options.folder);
    std::vector<MeshRows> meshes;
    std::vector<LitScene> scenes;
    {
        ProgressBar bar("frames", options.quiet);
        const double share = 1.0 / static_cast<double>(options.files.size());
        for (std::size_t i = 0; i < options.files.size(); ++i) {
            if (is_scene(options.files[i])) {
                scenes.push_back(measure_lit_frames(options.files[i], threads, settings));
                if (interrupt.raised()) return kExitInterrupted;
                if (!options.folder.empty())
                    write_image(options.folder / (scenes.back().name + "-lit.png"), decoded(scenes.back().image));
                bar.update(static_cast<double>(i + 1) * share);
                continue;
            }
            const Scene scene = frame_scene(options.files[i], options.texture);
            MeshRows mesh{options.files[i].stem().string(), std::get<Mesh>(scene.shapes[0]).triangles.size(), {}};
            if (!measure_mesh(options, settings, threads, mesh, scene, bar, static_cast<double>(i) * share, share))
                return kExitInterrupted;
            if (!options.folder.empty()) write_images(options.folder, mesh);
            meshes.push_back(std::move(mesh));
        }
    }
    if (!options.quiet && options.stats != "-") {
        if (!meshes.empty()) print_table(std::cout, options, meshes);
        if (!scenes.empty()) print_lit_frames(std::cout, scenes, options.settings);
    }
    json rows = json::array(), lit = json::array();
    for (const LitScene& scene : scenes) lit.push_back(lit_json(scene));
    int code = kExitOk;
    for (const MeshRows& mesh : meshes)
        for (const FrameRow& row : mesh.rows) {
            rows.push_back(row_json(mesh, row));
            if (!row.difference || row.difference->same()) continue;
            std::cerr << "compare: " << mesh.mesh << ", " << name(row.view) << ", " << name(row.work)
                      << ": our image and the peer's differ: " << difference_text(row) << '\n';
            code = kExitFailed;
        }
    if (!options.stats.empty())
        write_json(options.stats, {{"program", "compare frames"},
                                   {"version", DUET_VERSION},
                                   {"width", options.settings.size.width},
                                   {"height", options.settings.size.height},
                                   {"repeats", options.settings.repeats},
                                   {"copy_bytes_per_second", copy_bandwidth(threads.back())},
                                   {"rows", rows},
                                   {"lit", lit}});
    return code;
}

} // namespace duet::compare
