#include "raster/render.h"

#include "raster/account.h"
#include "raster/cover.h"
#include "raster/display.h"
#include "raster/geometry.h"
#include "raster/picture.h"
#include "raster/screen.h"
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
    Account& account;
    Progress& progress;
    Control& control;
};

/// The radiance at the pixels' centres, all parts of it, without reflections of the picture in itself.
void first_look(const Frame& frame, const View& view, const Geometry& geometry, PassView pass, Screen& screen) {
    Settings settings = frame.settings;
    settings.screen_reflections = false;
    settings.parts = {};
    settings.aovs = {};
    pass.screen = &screen;
    ImageRgb radiance(view.width, view.height);
    Image<std::uint8_t> lamps(view.width, view.height, 0);
    parallel_for(frame.grid.size(), settings.threads, [&](std::size_t i) {
        if (frame.control.stopped()) return;
        const PixelRect rect = frame.grid.tile(i);
        DepthTile depths;
        cover(geometry, pass, pass.samples.front(), rect, i, depths);
        const HitTile tile(depths, geometry, pass);
        for (int y = rect.y0; y < rect.y1; ++y)
            for (int x = rect.x0; x < rect.x1; ++x) {
                radiance(x, y) = shade(frame.data, settings, tile, x, y).radiance;
                lamps(x, y) = is_lamp(frame.data.scene, tile.hit(x, y));
            }
    });
    screen.set_radiance(std::move(radiance), std::move(lamps));
}

/// What the pass sees at the pixels' centres, wherever its samples are, if an effect needs it.
std::optional<Screen> look_at_screen(const Frame& frame, const View& view, const PassView& pass) {
    if (!needs_screen(frame.data, frame.settings)) return std::nullopt;
    const std::vector<SampleOffset> centers(1);
    const PassView central{.pinhole = pass.pinhole, .time = pass.time, .viewport = pass.viewport, .samples = centers};
    GeometryLoan geometry(*frame.data.geometries);
    process_geometry(frame.data, frame.grid, central, frame.settings, *geometry);
    ImageFloat nearness(view.width, view.height);
    parallel_for(frame.grid.size(), frame.settings.threads, [&](std::size_t i) {
        if (!frame.control.stopped()) keep_nearness(*geometry, central, frame.grid.tile(i), i, nearness);
    });
    Screen screen(central.pinhole, centers.front(), std::move(nearness));
    if (needs_screen_radiance(frame.data, frame.settings)) first_look(frame, view, *geometry, central, screen);
    return screen;
}

/// One pass: its geometry, then each tile, which render_tile(view, index) makes.
template <typename RenderTile>
void render_pass(const Frame& frame, const CameraModel& camera, const View& view, const Pass& pass,
                 const RenderTile& render_tile) {
    const Pinhole pinhole = camera.through(pass.lens);
    PassView pass_view{.pinhole = pinhole,
                             .time = static_cast<float>(camera.time(pass.time)),
                             .viewport = viewport_of(view, pinhole),
                             .samples = pass.samples};
    process_geometry(frame.data, frame.grid, pass_view, frame.settings, frame.geometry);
    frame.account.add(frame.geometry);
    const Stopwatch watch;
    const std::optional<Screen> screen = look_at_screen(frame, view, pass_view);
    pass_view.screen = screen ? &*screen : nullptr;
    frame.account.prepass += watch.seconds();
    const Stopwatch tiles_watch;
    parallel_for(frame.grid.size(), frame.settings.threads, [&](std::size_t i) {
        if (frame.control.stopped()) return;
        render_tile(pass_view, i);
        frame.account.tiles_done += 1;
        frame.progress.step();
    });
    frame.account.tiles += tiles_watch.seconds();
}

/// One tile of a picture: each of its samples a pixel is covered, then shaded.
void render_tile(const Frame& frame, const PassView& view, std::size_t index, Picture& picture) {
    const PixelRect rect = frame.grid.tile(index);
    DepthTile depths;
    for (const SampleOffset offset : view.samples) {
        Stopwatch watch;
        cover(frame.geometry, view, offset, rect, index, depths);
        const HitTile tile(depths, frame.geometry, view);
        frame.account.cover_work += static_cast<std::int64_t>(watch.lap() * 1e9);
        for (int y = rect.y0; y < rect.y1; ++y)
            for (int x = rect.x0; x < rect.x1; ++x)
                picture.add(tile, x, y, shade(frame.data, frame.settings, tile, x, y));
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
        if (depths_only)
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
    const Frame frame{data, used, grid, *geometry, account, progress, control};

    if (settings.output != Output::kRadiance && used.samples_per_pixel == 1) {
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
