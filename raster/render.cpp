#include "raster/render.h"

#include "raster/account.h"
#include "raster/display.h"
#include "raster/geometry/geometry.h"
#include "raster/overlay/overlay.h"
#include "raster/picture.h"
#include "raster/screen/look.h"
#include "raster/screen/screen.h"
#include "raster/shade.h"
#include "raster/shading/deferred.h"
#include "raster/shadings/shadings.h"
#include "raster/split.h"
#include "raster/visibility/cover.h"
#include "raster/visibility/hit_lists.h"
#include "raster/visibility/layered_nearness.h"
#include "raster/visibility/layers.h"
#include "raster/visibility/multisample.h"
#include "raster/visibility/strip_samples.h"

#include "common/image/srgb.h"
#include "common/system/error.h"
#include "common/system/parallel.h"
#include "common/system/stopwatch.h"

#include <algorithm>
#include <optional>

namespace duet::raster {
namespace {

void check(const View& view, const Settings& settings) {
    if (view.width < 1 || view.height < 1 || view.width > kMaxPictureSide || view.height > kMaxPictureSide)
        throw Error(message("picture size ", view.width, "x", view.height, ": expected 1 to ", kMaxPictureSide,
                            " pixels a side"));
    if (settings.samples_per_pixel < 1)
        throw Error(message(settings.samples_per_pixel, " samples a pixel: expected at least 1"));
    if (settings.multisamples > 0 && settings.samples_per_pixel > 1)
        throw Error(message("multisampling with ", settings.samples_per_pixel,
                            " samples a pixel: expected 1 (sample shading takes each for itself)"));
    if (settings.multisamples > 0 && draws_edges(settings))
        throw Error("edges with multisampling: expected several samples a pixel instead");
}

std::vector<Pass> plan(const PreparedData& data, const View& view, const CameraModel& camera,
                       const Settings& settings) {
    if (settings.multisamples > 0) return {Pass{.samples = multisample_pattern(settings.multisamples)}};
    const bool shutter = view.camera.shutter_close != view.camera.shutter_open;
    // Edge detection needs exactly one sample of every pixel per pass.
    return plan_passes(settings.samples_per_pixel, settings.seed,
                       camera.has_lens() || !settings.skips.lens || draws_edges(settings),
                       (data.scene.needs.motion && shutter) || !settings.skips.motion);
}

/// Holds the state that all passes of a rendering share.
struct Frame {
    const PreparedData& data;
    const Settings& settings;
    const Program* program; ///< null for Shading::kLit
    TileGrid grid;
    Geometry& geometry;
    Geometry* layers; ///< alpha-masked and alpha-blended surfaces; null if there are none
    Account& account;
    Progress& progress;
    Control& control;
};

PassView pass_view_of(const CameraModel& camera, const View& view, const Pass& pass) {
    const Pinhole pinhole = camera.through(pass.lens);
    return {.pinhole = pinhole,
            .time = static_cast<float>(camera.time(pass.time)),
            .viewport = viewport_of(view, pinhole),
            .samples = pass.samples};
}

/// Renders one pass: processes its geometry, then calls render_tile(view, index) for each tile.
template <typename RenderTile>
void render_pass(const Frame& frame, const CameraModel& camera, const View& view, const Pass& pass,
                 const RenderTile& render_tile) {
    PassView pass_view = pass_view_of(camera, view, pass);
    process_geometry(frame.data, frame.grid, pass_view, frame.settings, frame.geometry);
    frame.account.add(frame.geometry);
    if (frame.layers != nullptr) {
        process_layers(frame.data, frame.grid, pass_view, frame.settings, *frame.layers);
        frame.account.add(*frame.layers);
    }
    const Stopwatch watch;
    const std::unique_ptr<const Screen> screen =
        look_at_screen(frame.data, frame.settings, frame.grid, pass_view, frame.control);
    pass_view.screen = screen.get();
    frame.account.prepass += watch.seconds();
    if (screen) frame.account.add(*screen, *frame.data.geometries);
    const Stopwatch tiles_watch;
    parallel_for(frame.grid.size(), frame.settings.threads, [&](std::size_t i) {
        if (frame.control.stopped()) return;
        render_tile(pass_view, i);
        frame.account.tiles_done += 1;
        frame.progress.step();
    });
    frame.account.tiles += tiles_watch.seconds();
}

/// Shades the samples of a tile with a program, one row of packets at a time.
void shade_tile(const Frame& frame, const PassView& view, const DepthTile& depths, Picture& picture) {
    const PixelRect& rect = depths.rect();
    const auto shader = frame.program->for_tile(frame.data, frame.geometry, view, rect);
    constexpr int kColumns = kStripWidth, kRows = DepthTile::kStripRows;
    std::array<StripPlace, TileGrid::kTileSize / kColumns> places;
    std::array<StripColors, TileGrid::kTileSize / kColumns> colors;
    std::array<std::uint32_t, TileGrid::kTileSize / kColumns> seen;
    for (int y0 = rect.y0; y0 < rect.y1; y0 += kRows) {
        std::size_t count = 0;
        for (int x0 = rect.x0; x0 < rect.x1; x0 += kColumns) places[count++] = strip_place(depths, x0, y0);
        shader->shade(std::span(places).first(count), colors.data(), seen.data());
        for (int y = y0; y < std::min(y0 + kRows, rect.y1); ++y)
            for (int x = rect.x0; x < rect.x1; ++x) {
                const auto strip = static_cast<std::size_t>((x - rect.x0) / kColumns);
                const auto i = static_cast<std::size_t>((y - y0) * kColumns + (x - rect.x0) % kColumns);
                const StripColors& own = colors[strip];
                picture.add(x, y, seen[strip] >> i & 1 ? Rgb(own.r[i], own.g[i], own.b[i]) : Rgb());
            }
    }
}

/// Returns true if alpha-masked or alpha-blended surfaces overlap the tile.
bool layered(const Frame& frame, std::size_t tile) { return frame.layers != nullptr && touches(*frame.layers, tile); }
/// Returns true if the tile's radiance is computed sample by sample: always for Shading::kLit, and for any shading
/// in front of which there are transparent layers.
bool all_one_by_one(const Frame& frame, std::size_t tile) { return frame.program == nullptr || layered(frame, tile); }
/// Returns true if any output of the tile is computed sample by sample, auxiliary images included.
bool one_by_one(const Frame& frame, std::size_t tile) {
    return all_one_by_one(frame, tile) || frame.settings.aovs.any();
}

/// Shades the samples of a tile one by one.
void shade_samples(const Frame& frame, const PassView& view, std::size_t index, const DepthTile& depths,
                   Picture& picture) {
    HitTile tile(depths, frame.geometry, view);
    std::optional<Layers> layers;
    if (layered(frame, index))
        layers.emplace(frame.data, frame.settings, frame.program, *frame.layers, view, depths.offset(), index, tile);
    const PixelRect& rect = depths.rect();
    const bool central =
        view.samples.size() == 1 && depths.offset().x == SampleOffset().x && depths.offset().y == SampleOffset().y;
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x) {
            const Rgb* known = central && !layers ? seen_before(frame.data, frame.settings, tile, x, y) : nullptr;
            if (known != nullptr) {
                picture.add(x, y, *known);
                continue;
            }
            Shaded shaded = shade(frame.data, frame.settings, tile, x, y);
            if (layers) {
                if (frame.program != nullptr && tile.hit(x, y).valid())
                    shaded.radiance =
                        frame.program->shade_hit(frame.data, view, tile.hit(x, y), depths.offset().position(x, y));
                shaded = layers->over(x, y, shaded);
            }
            if (frame.settings.aovs.any()) picture.add_auxiliary(tile, x, y, shaded);
            if (all_one_by_one(frame, index)) picture.add(x, y, shaded.radiance);
        }
}

/// Shades one layer of a multisampled tile. Each primitive is shaded once per pixel and weighted by its number of
/// samples.
void shade_layer(const Frame& frame, const PassView& view, const LayeredTile& tile, std::size_t layer,
                 Picture& picture) {
    const PixelRect& rect = tile.rect();
    const auto for_each = [&](const auto& visit) { // calls visit() for the pixels in the layer
        for (int y = rect.y0; y < rect.y1; ++y)
            for (int x = rect.x0; x < rect.x1; ++x)
                if (const int count = tile.layer(layer).count(tile.place(x, y)); count > 0) visit(x, y, count);
    };
    if (frame.program == nullptr || frame.settings.aovs.any()) {
        const HitTile hits(tile, layer, frame.geometry, view);
        const int samples = static_cast<int>(view.samples.size());
        for_each([&](int x, int y, int count) {
            if (const Rgb* known = count == samples ? seen_before(frame.data, frame.settings, hits, x, y) : nullptr) {
                picture.add(x, y, *known, count);
                return;
            }
            const Shaded shaded = shade(frame.data, frame.settings, hits, x, y);
            for (int i = 0; i < count && frame.settings.aovs.any(); ++i) picture.add_auxiliary(hits, x, y, shaded);
            if (frame.program == nullptr) picture.add(x, y, shaded.radiance, count);
        });
    }
    if (frame.program == nullptr) return;
    const auto shader = frame.program->for_tile(frame.data, frame.geometry, view, rect);
    LayeredTile::Strip strip;
    for (int y0 = rect.y0; y0 < rect.y1; y0 += DepthTile::kStripRows)
        for (int x0 = rect.x0; x0 < rect.x1; x0 += static_cast<int>(kStripWidth)) {
            tile.strip(layer, x0, y0, strip);
            if (strip.place.ids == nullptr) continue;
            StripColors colors;
            const std::uint32_t seen = shader->shade(strip.place, colors), first = tile.place(x0, y0);
            for (std::uint32_t i = 0; i < kStrip; ++i)
                if (const int count = tile.layer(layer).count(first + i); count > 0) {
                    const int x = x0 + static_cast<int>(i % kStripWidth), y = y0 + static_cast<int>(i / kStripWidth);
                    if (x < rect.x1 && y < rect.y1)
                        picture.add(x, y, seen >> i & 1 ? Rgb(colors.r[i], colors.g[i], colors.b[i]) : Rgb(), count);
                }
        }
}

/// Renders one tile with multisampling: determines the coverage of all samples, then shades each primitive once.
void render_layers(const Frame& frame, const PassView& view, std::size_t index, Picture& picture) {
    const PixelRect rect = frame.grid.tile(index);
    Stopwatch watch;
    LayeredTile tile(rect, static_cast<int>(view.samples.size()));
    DepthTile depths;
    for (const SampleOffset offset : view.samples) {
        cover(frame.geometry, view, offset, rect, index, depths);
        tile.add(depths);
    }
    frame.account.cover_work += static_cast<std::int64_t>(watch.lap() * 1e9);
    for (std::size_t layer = 0; layer < tile.layers(); ++layer) shade_layer(frame, view, tile, layer, picture);
    frame.account.shade_work += static_cast<std::int64_t>(watch.lap() * 1e9);
}

/// Renders one tile: determines the coverage of each sample, then shades it.
void render_tile(const Frame& frame, const PassView& view, std::size_t index, Picture& picture) {
    const PixelRect rect = frame.grid.tile(index);
    DepthTile depths;
    for (const SampleOffset offset : view.samples) {
        Stopwatch watch;
        cover(frame.geometry, view, offset, rect, index, depths);
        frame.account.cover_work += static_cast<std::int64_t>(watch.lap() * 1e9);
        if (one_by_one(frame, index)) shade_samples(frame, view, index, depths, picture);
        if (!all_one_by_one(frame, index)) shade_tile(frame, view, depths, picture);
        frame.account.shade_work += static_cast<std::int64_t>(watch.lap() * 1e9);
    }
}

/// Renders a pass with one sample per pixel, and adds its edges to the overlay.
void render_inked(const Frame& frame, const CameraModel& camera, const View& view, const Pass& pass, Picture& picture,
                  Overlay& overlay) {
    SeenPicture seen(view.width, view.height);
    const std::unique_ptr<Program> normals = smooth_normal_program(); // bumps are not edges
    render_pass(frame, camera, view, pass, [&](const PassView& pass_view, std::size_t i) {
        render_tile(frame, pass_view, i, picture);
        const SampleOffset offset = pass_view.samples.front();
        DepthTile depths;
        cover(frame.geometry, pass_view, offset, frame.grid.tile(i), i, depths);
        seen.add(depths, frame.geometry, *normals->for_tile(frame.data, frame.geometry, pass_view, frame.grid.tile(i)));
        if (layered(frame, i))
            seen.add_layers(frame.data, *frame.layers, pass_view, offset, i, HitTile(depths, frame.geometry, pass_view),
                            *normals);
    });
    if (!frame.control.stopped()) overlay.add_edges(seen);
}

bool is_deferred(const Frame& frame) {
    return frame.program == nullptr && frame.settings.quality == Quality::kRealtime;
}

/// Renders one pass of Shading::kLit by deferred shading, and calls use(radiance) for each sample of a pixel.
template <typename Use>
void render_deferred(const Frame& frame, const CameraModel& camera, const View& view, const Pass& pass,
                     const Use& use) {
    const PassView pass_view = pass_view_of(camera, view, pass);
    process_geometry(frame.data, frame.grid, pass_view, frame.settings, frame.geometry);
    frame.account.add(frame.geometry);
    const Stopwatch watch;
    DeferredFramePool& pool = *frame.data.deferred_frames;
    std::unique_ptr<DeferredFrame> images = pool.take();
    for (const SampleOffset offset : pass.samples) {
        if (frame.control.stopped()) break;
        shade_deferred(frame.data, frame.settings, frame.geometry, pass_view, frame.grid, offset, frame.control,
                       *images);
        for (const auto& [stage, seconds] : images->seconds) frame.account.add_stage(stage, seconds);
        use(images->radiance);
    }
    pool.give_back(std::move(images));
    frame.account.tiles += watch.seconds();
    for (std::size_t i = 0; i < frame.grid.size(); ++i) frame.account.tiles_done += 1, frame.progress.step();
}

/// Calls visit(x, y) for all pixels, in parallel.
template <typename Visit> void for_each_pixel(const View& view, int threads, const Visit& visit) {
    parallel_for(static_cast<std::size_t>(view.height), threads, [&](std::size_t row) {
        for (int x = 0; x < view.width; ++x) visit(x, static_cast<int>(row));
    });
}

/// Renders one pass per lens point or time, and averages them.
Rendering render_picture(const Frame& frame, const CameraModel& camera, const View& view,
                         const std::vector<Pass>& passes) {
    const bool lines = frame.settings.shading == Shading::kLines, edges = draws_edges(frame.settings);
    Picture picture(view, frame.settings, passes.size() > 1 || passes.front().samples.size() > 1);
    std::optional<Overlay> overlay;
    if (lines || edges) overlay.emplace(frame.data, frame.settings, view);
    for (const Pass& pass : passes) {
        if (frame.control.stopped()) break;
        if (edges) {
            render_inked(frame, camera, view, pass, picture, *overlay);
            continue;
        }
        if (lines) overlay->add_lines(pass_view_of(camera, view, pass));
        if (is_deferred(frame) && !frame.settings.aovs.any()) {
            render_deferred(frame, camera, view, pass, [&](const Planes3& radiance) {
                for_each_pixel(view, frame.settings.threads,
                               [&](int x, int y) { picture.add(x, y, radiance.color_at(x, y)); });
            });
            continue;
        }
        render_pass(frame, camera, view, pass, [&](const PassView& pass_view, std::size_t i) {
            // Transparent layers are sorted per sample, so each sample is shaded.
            if (frame.settings.multisamples > 0 && !frame.settings.sample_shading && frame.layers == nullptr)
                render_layers(frame, pass_view, i, picture);
            else
                render_tile(frame, pass_view, i, picture);
        });
    }
    const Stopwatch watch;
    frame.account.picture_bytes = picture.memory_bytes();
    Rendering result = picture.finish(frame.settings.threads);
    if (overlay) overlay->put(result.radiance);
    frame.account.resolve = watch.seconds();
    return result;
}

template <typename Pixel> void resize(Image<Pixel>& image, const View& view) {
    if (image.width() != view.width || image.height() != view.height) image = Image<Pixel>(view.width, view.height);
}

/// Renders one sample per pixel directly to the format of a display or a shadow map.
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
    if (!depths_only && is_deferred(frame)) {
        const SrgbEncoder& encoder = srgb_encoder();
        render_deferred(frame, camera, view, pass, [&](const Planes3& radiance) {
            for_each_pixel(view, frame.settings.threads, [&](int x, int y) {
                const Rgb c = radiance.color_at(x, y);
                result.srgb(x, y) = {encoder(c.r), encoder(c.g), encoder(c.b), 255};
            });
        });
        return;
    }
    render_pass(frame, camera, view, pass, [&](const PassView& pass_view, std::size_t i) {
        if (depths_only && frame.layers != nullptr)
            keep_layered_nearness(frame.data, frame.geometry, *frame.layers, pass_view, frame.grid.tile(i), i,
                                  result.nearness);
        else if (depths_only)
            keep_nearness(frame.geometry, pass_view, frame.grid.tile(i), i, result.nearness);
        else
            display_tile(frame.data, frame.settings, frame.program, frame.geometry, pass_view, frame.grid.tile(i), i,
                         result.srgb);
    });
}

void render_with(const Prepared& prepared, const View& view, const Settings& settings, const Program* program,
                 Control& control, Rendering& result) {
    check(view, settings);
    const PreparedData& data = prepared.data();
    const CameraModel camera(view);
    Settings used = settings;
    if (settings.output == Output::kNearness) used.samples_per_pixel = 1, used.multisamples = 0, used.edges = false;
    const std::vector<Pass> passes = plan(data, view, camera, used);
    const TileGrid grid{{0, 0, view.width, view.height}};
    Account account;
    Progress progress(control, grid.size() * passes.size());
    GeometryLoan geometry(*data.geometries);
    GeometryLoan layers(*data.geometries);
    const Frame frame{data,    used,     program, grid, *geometry, data.has_layers() ? &*layers : nullptr,
                      account, progress, control};

    const bool overlaid = draws_edges(used) || used.shading == Shading::kLines;
    const bool one_sample = passes.size() == 1 && passes.front().samples.size() == 1;
    if (used.output == Output::kNearness ||
        (used.output == Output::kSrgb8 && one_sample && !overlaid && !data.has_layers())) {
        render_display(frame, camera, view, passes.front(), result);
        result.statistics = {};
    } else {
        result = render_picture(frame, camera, view, passes);
        if (settings.output == Output::kSrgb8) encode(result.radiance, settings.threads, result.srgb);
    }
    fill_statistics(result.statistics, data, used, account, passes, grid);
}

} // namespace

std::shared_ptr<const Screen> screen_of(const Prepared& prepared, const View& view, const Settings& settings) {
    check(view, settings);
    const PreparedData& data = prepared.data();
    const TileGrid grid{{0, 0, view.width, view.height}};
    return look_at_screen(data, settings, grid, pass_view_of(CameraModel(view), view, Pass{}), Control{});
}

void render(const Prepared& prepared, const View& view, const Settings& settings, Control& control, Rendering& result) {
    const std::unique_ptr<Program> built_in = program(settings.shading, view.camera);
    render_with(prepared, view, settings, built_in.get(), control, result);
}

void render(const Prepared& prepared, const View& view, const Settings& settings, const Program& program,
            Control& control, Rendering& result) {
    Settings other = settings; // the environment must not be in the background, which only kLit shows
    if (other.shading == Shading::kLit) other.shading = Shading::kAlbedo;
    render_with(prepared, view, other, &program, control, result);
}

Rendering render(const Prepared& prepared, const View& view, const Settings& settings, Control& control) {
    Rendering result;
    render(prepared, view, settings, control, result);
    return result;
}

} // namespace duet::raster
