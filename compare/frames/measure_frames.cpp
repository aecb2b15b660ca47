#include "compare/frames/measure_frames.h"

#include "common/image/srgb.h"
#include "compare/frames/cpu_affinity.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/image_metrics.h"
#include "compare/timing.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace duet::compare {
namespace {

raster::RasterSettings settings_for(FrameWork work, int threads) {
    raster::RasterSettings settings;
    settings.threads = threads;
    settings.front_faces_only = true; // like the peer
    settings.shading = raster::Shading::kPhong;
    settings.output = work == FrameWork::kPhong ? raster::Output::kSrgb8 : raster::Output::kReversedDepth;
    return settings;
}

double covered_fraction(const ImageFloat& reversed_depth) {
    return static_cast<double>(
               std::count_if(reversed_depth.begin(), reversed_depth.end(), [](float n) { return n > 0; })) /
           static_cast<double>(reversed_depth.size());
}

double mismatched_fraction(const ImageFloat& ours, const ImageFloat& peer) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) count += (ours[i] > 0) != (peer[i] > 0);
    return static_cast<double>(count) / static_cast<double>(ours.size());
}

FrameDifference difference(const ImageRgb& ours, const ImageRgb& peer, double coverage) {
    double sum = 0;
    for (std::size_t i = 0; i < ours.size(); ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            sum += std::abs(static_cast<double>(ours[i][channel] - peer[i][channel]));
    return {coverage, sum / (3 * static_cast<double>(ours.size())), flip(ours, peer).mean};
}

FrameDifference difference(const ImageFloat& ours, const ImageFloat& peer) {
    std::size_t common = 0;
    double sum = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        if (!(ours[i] > 0 && peer[i] > 0)) continue;
        ++common;
        sum += std::abs(static_cast<double>(ours[i]) / static_cast<double>(peer[i]) - 1);
    }
    return {mismatched_fraction(ours, peer), common > 0 ? sum / static_cast<double>(common) : 0, 0};
}

/// Draws frames for the duration of a burst and returns the seconds per frame.
double time_burst(const std::function<void()>& draw, const FrameSettings& settings) {
    const WorkStopwatch clock(settings.processor_time);
    const Stopwatch watch;
    int frames = 0;
    do {
        draw();
        ++frames;
    } while (watch.seconds() < settings.burst_seconds);
    return clock.seconds() / frames;
}

void measure(FrameRow& row, const std::function<void()>& ours, const std::function<void()>& peer,
             const FrameSettings& settings) {
    std::vector<double> our_seconds, peer_seconds, ratios;
    time_burst(ours, settings); // warms up memory, shaders and threads
    if (peer) time_burst(peer, settings);
    for (int i = 0; i < settings.repeats; ++i) {
        if (settings.stop != nullptr && *settings.stop) return;
        our_seconds.push_back(time_burst(ours, settings));
        if (!peer) continue;
        peer_seconds.push_back(time_burst(peer, settings));
        ratios.push_back(peer_seconds.back() / our_seconds.back());
    }
    row.ours = median(our_seconds);
    if (!peer) return;
    row.peer = median(peer_seconds);
    const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
    row.ratio = {*least, median(ratios), *most};
}

void compare_images_of_frame(FrameRow& row, const Rendering& ours, const ImageFloat& reversed_depth,
                             const std::optional<LlvmpipeRenderer>& peer) {
    if (row.work == FrameWork::kPhong) row.image = encoded_values(ours.srgb);
    if (!peer) return;
    row.peer_name = peer->name();
    if (row.work == FrameWork::kPhong) {
        row.peer_image = peer->image();
        row.difference =
            difference(row.image, row.peer_image, mismatched_fraction(reversed_depth, peer->reversed_depth()));
    } else {
        row.difference = difference(ours.reversed_depth, peer->reversed_depth());
    }
}

} // namespace

// Coverage may differ where an edge passes close to a sample: both renderers snap vertices to a grid of 1/256 pixel,
// but the peer transforms them in float first. Elsewhere both shade the same point. The peer's sRGB curve is an
// approximation that is often one code too low, which causes a FLIP error of up to 0.006 over an image's covered
// pixels.
bool FrameDifference::same() const { return coverage < 2e-3 && mean < 2e-3 && flip < 1e-2; }

std::vector<FrameRow> measure_frames(const Scene& scene, const raster::RasterScene& prepared, FrameView frame_kind,
                                     int threads, const std::vector<FrameWork>& works, const FrameSettings& settings) {
    const CpuAffinity pinned(threads);
    const View view = frame_view(scene, frame_kind, settings.size);
    std::optional<LlvmpipeRenderer> peer;
    if (!settings.no_peer && LlvmpipeRenderer::built()) peer.emplace(scene, view, threads);
    Control control;
    Rendering depth, image;
    raster::render(prepared, view, settings_for(FrameWork::kDepth, threads), control, depth);
    std::vector<FrameRow> rows;
    for (const FrameWork work : works) {
        FrameRow row;
        row.work = work;
        row.view = frame_kind;
        row.threads = threads;
        row.covered = covered_fraction(depth.reversed_depth);
        const raster::RasterSettings ours = settings_for(work, threads);
        const auto draw_ours = [&] { raster::render(prepared, view, ours, control, image); };
        std::function<void()> draw_peer;
        if (peer) draw_peer = [&] { peer->draw(work); };
        measure(row, draw_ours, draw_peer, settings);
        compare_images_of_frame(row, image, depth.reversed_depth, peer);
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace duet::compare
