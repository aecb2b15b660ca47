#include "raster/render.h"

#include "raster/account.h"
#include "raster/cover.h"
#include "raster/display.h"
#include "raster/geometry.h"
#include "raster/layers.h"
#include "raster/picture.h"
#include "raster/shade.h"

#include "common/image/srgb.h"
#include "common/system/error.h"
#include "common/system/parallel.h"
#include "common/system/stopwatch.h"

namespace duet::raster {
namespace {

void check(const View& view, const Settings& settings) {
    if (view.width < 1 || view.height < 1 || view.width > kMaxPictureSide || view.height > kMaxPictureSide)
        throw Error(message("picture size ", view.width, "x", view.height, ": expected 1 to ", kMaxPictureSide,
                            " pixels a side"));
    if (settings.samples_per_pixel < 1)
        throw Error(message(settings.samples_per_pixel, " samples a pixel: expected at least 1"));
}

std::vector<Pass> plan(const PreparedData& data, const View& view, const CameraModel& camera,
                       const Settings& settings) {
    const bool shutter = view.camera.shutter_close != view.camera.shutter_open;
    return plan_passes(settings.samples_per_pixel, settings.seed, camera.has_lens() || !settings.skips.lens,
                       (data.scene.needs.motion && shutter) || !settings.skips.motion);
}

/// What all passes of a rendering have in common.
struct Frame {
    const PreparedData& data;
    const Settings& settings;
    TileGrid grid;
    Geometry& geometry;
    Geometry* layers; ///< of the surfaces that may be seen through; null: there are none
    Account& account;
    Progress& progress;
    Control& control;
};

/// One pass: its geometry, then each tile, which render_tile(view, index) makes.
template <typename RenderTile>
void render_pass(const Frame& frame, const CameraModel& camera, const View& view, const Pass& pass,
                 const RenderTile& render_tile) {
    const Pinhole pinhole = camera.through(pass.lens);
    const PassView pass_view{.pinhole = pinhole,
                             .time = static_cast<float>(camera.time(pass.time)),
                             .viewport = viewport_of(view, pinhole),
                             .samples = pass.samples};
    process_geometry(frame.data, frame.grid, pass_view, frame.settings, frame.geometry);
    frame.account.add(frame.geometry);
    if (frame.layers != nullptr) {
        process_layers(frame.data, frame.grid, pass_view, frame.settings, *frame.layers);
        frame.account.add(*frame.layers);
    }
    const Stopwatch watch;
    parallel_for(frame.grid.size(), frame.settings.threads, [&](std::size_t i) {
        if (frame.control.stopped()) return;
        render_tile(pass_view, i);
        frame.account.tiles_done += 1;
        frame.progress.step();
    });
    frame.account.tiles += watch.seconds();
}

/// One tile of a picture: each of its samples a pixel is covered, then shaded.
void render_tile(const Frame& frame, const PassView& view, std::size_t index, Picture& picture) {
    const PixelRect rect = frame.grid.tile(index);
    DepthTile depths;
    for (const SampleOffset offset : view.samples) {
        Stopwatch watch;
        cover(frame.geometry, view, offset, rect, index, depths);
        HitTile tile(depths, frame.geometry, view);
        std::optional<Layers> layers;
        if (frame.layers != nullptr)
            layers.emplace(frame.data, frame.settings, *frame.layers, view, offset, index, tile);
        frame.account.cover_work += static_cast<std::int64_t>(watch.lap() * 1e9);
        for (int y = rect.y0; y < rect.y1; ++y)
            for (int x = rect.x0; x < rect.x1; ++x) {
                const Shaded shaded = shade(frame.data, frame.settings, tile, x, y);
                picture.add(tile, x, y, layers ? layers->over(x, y, shaded) : shaded);
            }
        frame.account.shade_work += static_cast<std::int64_t>(watch.lap() * 1e9);
    }
}

/// A pass a lens point or moment, all added up.
Rendering render_picture(const Frame& frame, const CameraModel& camera, const View& view,
                         const std::vector<Pass>& passes) {
    Picture picture(view, frame.settings);
    for (const Pass& pass : passes) {
        if (frame.control.stopped()) break;
        render_pass(frame, camera, view, pass, [&](const PassView& pass_view, std::size_t i) {
            render_tile(frame, pass_view, i, picture);
        });
    }
    const Stopwatch watch;
    frame.account.picture_bytes = picture.memory_bytes();
    Rendering result = picture.finish(frame.settings.threads);
    frame.account.resolve = watch.seconds();
    return result;
}

template <typename Pixel> void resize(Image<Pixel>& image, const View& view) {
    if (image.width() != view.width || image.height() != view.height) image = Image<Pixel>(view.width, view.height);
}

/// Where surfaces have holes: what is partly there counts as not there.
void keep_layered_nearness(const Frame& frame, const PassView& view, std::size_t index, ImageFloat& picture) {
    const PixelRect rect = frame.grid.tile(index);
    DepthTile depths;
    cover(frame.geometry, view, view.samples.front(), rect, index, depths);
    HitTile tile(depths, frame.geometry, view);
    const Layers layers(frame.data, frame.settings, *frame.layers, view, view.samples.front(), index, tile);
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x) picture(x, y) = tile.nearness(x, y);
}

/// A single sample a pixel, straight to what a display or a shadow map takes.
void render_display(const Frame& frame, const CameraModel& camera, const View& view, const Pass& pass,
                    Rendering& result) {
    const bool depths_only = frame.settings.output == Output::kNearness;
    if (depths_only) {
        resize(result.nearness, view);
        frame.account.picture_bytes = result.nearness.size() * sizeof(float);
    } else {
        resize(result.srgb, view);
        frame.account.picture_bytes = result.srgb.size() * sizeof(Rgba8);
    }
    render_pass(frame, camera, view, pass, [&](const PassView& pass_view, std::size_t i) {
        if (depths_only && frame.layers != nullptr)
            keep_layered_nearness(frame, pass_view, i, result.nearness);
        else if (depths_only)
            keep_nearness(frame.geometry, pass_view, frame.grid.tile(i), i, result.nearness);
        else
            display_tile(frame.data, frame.settings, frame.geometry, pass_view, frame.grid.tile(i), i, result.srgb);
    });
}

} // namespace

void render(const Prepared& prepared, const View& view, const Settings& settings, Control& control, Rendering& result) {
    check(view, settings);
    const PreparedData& data = prepared.data();
    const CameraModel camera(view);
    Settings used = settings;
    if (settings.output == Output::kNearness) used.samples_per_pixel = 1;
    const std::vector<Pass> passes = plan(data, view, camera, used);
    const TileGrid grid{{0, 0, view.width, view.height}};
    Account account;
    Progress progress(control, grid.size() * passes.size());
    GeometryLoan geometry(*data.geometries);
    GeometryLoan layers(*data.geometries);
    const Frame frame{data,    used,     grid,   *geometry, data.has_layers() ? &*layers : nullptr,
                      account, progress, control};

    const bool blends = data.has_layers() && settings.output == Output::kSrgb8;
    if (settings.output != Output::kRadiance && used.samples_per_pixel == 1 && !blends) {
        render_display(frame, camera, view, passes.front(), result);
        result.statistics = {};
    } else {
        result = render_picture(frame, camera, view, passes);
        if (settings.output == Output::kSrgb8) encode(result.radiance, settings.threads, result.srgb);
    }
    fill_statistics(result.statistics, data, used, account, passes, grid);
}

Rendering render(const Prepared& prepared, const View& view, const Settings& settings, Control& control) {
    Rendering result;
    render(prepared, view, settings, control, result);
    return result;
}

} // namespace duet::raster
