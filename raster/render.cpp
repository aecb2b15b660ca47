#include "raster/render.h"

#include "raster/account.h"
#include "raster/cover.h"
#include "raster/geometry.h"
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

void shade_tile(const PreparedData& data, const Settings& settings, const HitTile& tile, Picture& picture) {
    const PixelRect& r = tile.rect();
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) picture.add(tile, x, y, shade(data, settings, tile, x, y));
}

/// One tile: each of its samples a pixel is covered, then shaded.
void render_tile(const PreparedData& data, const Settings& settings, const PassView& view, const Geometry& geometry,
                 const PixelRect& rect, std::size_t index, Picture& picture, Account& account) {
    for (const SampleOffset offset : view.samples) {
        Stopwatch watch;
        const HitTile tile = cover(rect, view, offset, geometry, index);
        account.cover_work += static_cast<std::int64_t>(watch.lap() * 1e9);
        shade_tile(data, settings, tile, picture);
        account.shade_work += static_cast<std::int64_t>(watch.lap() * 1e9);
    }
    account.tiles_done += 1;
}

} // namespace

Rendering render(const Prepared& prepared, const View& view, const Settings& settings, Control& control) {
    check(view, settings);
    const PreparedData& data = prepared.data();
    const CameraModel camera(view);
    const std::vector<Pass> passes = plan(data, view, camera, settings);
    const TileGrid grid{view.width, view.height};
    Picture picture(view, settings);
    Account account;
    Progress progress(control, grid.size() * passes.size());

    for (const Pass& pass : passes) {
        if (control.stopped()) break;
        const Pinhole pinhole = camera.through(pass.lens);
        const PassView pass_view{.pinhole = pinhole,
                                 .time = static_cast<float>(camera.time(pass.time)),
                                 .viewport = {view.width, view.height, pinhole.near},
                                 .samples = pass.samples};
        const Geometry geometry = process_geometry(data, grid, pass_view, settings);
        account.add(geometry);
        const Stopwatch watch;
        parallel_for(grid.size(), settings.threads, [&](std::size_t i) {
            if (control.stopped()) return;
            render_tile(data, settings, pass_view, geometry, grid.tile(i), i, picture, account);
            progress.step();
        });
        account.tiles += watch.seconds();
    }

    const Stopwatch watch;
    const std::size_t picture_bytes = picture.memory_bytes();
    Rendering result = picture.finish(settings.threads);
    account.resolve = watch.seconds();
    fill_statistics(result.statistics, data, settings, account, passes, grid, picture_bytes);
    return result;
}

void render(const Prepared& prepared, const View& view, const Settings& settings, Control& control, Rendering& result) {
    result = render(prepared, view, settings, control);
    result.srgb = Image<Rgba8>(view.width, view.height);
    result.nearness = ImageFloat(view.width, view.height);
    for (std::size_t i = 0; i < result.srgb.size(); ++i) {
        const Rgb c = result.radiance[i];
        result.srgb[i] = {srgb_encode_8bit(c.r), srgb_encode_8bit(c.g), srgb_encode_8bit(c.b), 255};
    }
}

} // namespace duet::raster
