#include "raster/render.h"

#include "raster/forward_tiles.h"
#include "raster/output/display_tile.h"
#include "raster/output/framebuffer.h"
#include "raster/overlay/overlay.h"
#include "raster/shading/built_in_shaders.h"
#include "raster/shading/deferred.h"
#include "raster/visibility/depth_image.h"
#include "raster/visibility/hit_tile.h"
#include "raster/visibility/multisample.h"
#include "raster/visibility/rasterize_tile.h"

#include "common/image/srgb.h"
#include "common/system/error.h"
#include "common/system/parallel.h"
#include "common/system/stopwatch.h"

#include <algorithm>
#include <optional>

namespace duet::raster {
namespace {

void validate(const View& view, const RasterSettings& settings) {
    if (view.width < 1 || view.height < 1 || view.width > kMaxRenderSide || view.height > kMaxRenderSide)
        throw Error(message("framebuffer size ", view.width, "x", view.height, ": expected 1 to ", kMaxRenderSide,
                            " pixels a side"));
    if (settings.samples_per_pixel < 1)
        throw Error(message(settings.samples_per_pixel, " samples per pixel: expected at least 1"));
    if (settings.multisamples > 0 && settings.samples_per_pixel > 1)
        throw Error(message("found both multisampling and ", settings.samples_per_pixel,
                            " samples per pixel, expected one of them: leave out --spp or --msaa"));
    if (settings.multisamples > 0 && draws_edges(settings))
        throw Error("edges with multisampling: expected several samples per pixel instead");
}

std::vector<Pass> plan_view(const RasterSceneData& data, const View& view, const CameraModel& camera,
                            const RasterSettings& settings) {
    if (settings.multisamples > 0) return {Pass{.samples = multisample_pattern(settings.multisamples)}};
    const bool shutter = view.camera.shutter_close != view.camera.shutter_open;
    // Edge detection needs exactly one sample of every pixel per pass.
    return plan_passes(settings.samples_per_pixel, settings.seed,
                       camera.has_lens() || !settings.skips.lens || draws_edges(settings),
                       (data.scene.needs.motion && shutter) || !settings.skips.motion);
}

PassView pass_view_of(const CameraModel& camera, const View& view, const RasterSettings& settings, const Pass& pass) {
    const Pinhole pinhole = camera.pinhole(pass.lens);
    return {.pinhole = pinhole,
            .time = static_cast<float>(camera.time(pass.time)),
            .viewport = viewport_of(view, pinhole),
            .samples = pass.samples,
            .samples_per_pixel =
                std::max(settings.samples_per_pixel, settings.shades_each_sample() ? settings.multisamples : 1)};
}

/// Processes the geometry of a pass.
void process_pass(const FrameContext& frame, const PassView& pass_view) {
    process_geometry(frame.data, frame.grid, pass_view, frame.settings, frame.geometry);
    frame.collector.add(frame.geometry);
    if (frame.layers == nullptr) return;
    process_layers(frame.data, frame.grid, pass_view, frame.settings, *frame.layers);
    frame.collector.add(*frame.layers);
}

/// Renders one pass: processes its geometry, then calls render_tile(view, index) for each tile.
template <typename RenderTile>
void render_pass(const FrameContext& frame, const CameraModel& camera, const View& view, const Pass& pass,
                 const RenderTile& render_tile) {
    const PassView pass_view = pass_view_of(camera, view, frame.settings, pass);
    process_pass(frame, pass_view);
    const Stopwatch tiles_watch;
    parallel_for(frame.grid.size(), frame.settings.threads, [&](std::size_t i) {
        if (frame.control.stopped()) return;
        render_tile(pass_view, i);
        frame.collector.tiles_done += 1;
        frame.progress.step();
    });
    frame.collector.tiles += tiles_watch.seconds();
}

/// Adds the edges of a pass, whose geometry has been processed, to the overlay.
void add_edges(const FrameContext& frame, const CameraModel& camera, const View& view, const Pass& pass,
               Overlay& overlay) {
    EdgeBuffer edge_buffer(view.width, view.height);
    const std::unique_ptr<ShaderProgram> normals = smooth_normal_program(); // bump maps do not create edges
    const PassView pass_view = pass_view_of(camera, view, frame.settings, pass);
    const SampleOffset offset = pass_view.samples.front(); // the pass has one sample per pixel
    parallel_for(frame.grid.size(), frame.settings.threads, [&](std::size_t i) {
        DepthTile depths;
        rasterize_tile(frame.geometry, pass_view, offset, frame.grid.tile(i), i, depths);
        edge_buffer.add(depths, frame.geometry,
                        *normals->for_tile(frame.data, frame.geometry, pass_view, frame.grid.tile(i)));
        if (frame.has_layers_in(i))
            edge_buffer.add_layers(frame.data, *frame.layers, pass_view, offset, i,
                                   HitTile(depths, frame.geometry, pass_view), *normals);
    });
    overlay.add_edges(edge_buffer);
}

/// Calls visit(x, y) for all pixels, in parallel.
template <typename Visit> void for_each_pixel(const View& view, int threads, const Visit& visit) {
    parallel_for(static_cast<std::size_t>(view.height), threads, [&](std::size_t row) {
        for (int x = 0; x < view.width; ++x) visit(x, static_cast<int>(row));
    });
}

/// Calls use(sample) for each sample of a pixel of one pass of Shading::kLit.
template <typename Use>
void for_each_lit_sample(const FrameContext& frame, const CameraModel& camera, const View& view, const Pass& pass,
                         const Use& use) {
    const PassView pass_view = pass_view_of(camera, view, frame.settings, pass);
    process_pass(frame, pass_view);
    const Stopwatch watch;
    for (const SampleOffset offset : pass.samples) {
        if (frame.control.stopped()) break;
        use(SampleView{frame.data, frame.settings, frame.geometry, frame.layers, pass_view, frame.grid, offset,
                       frame.control});
    }
    frame.collector.tiles += watch.seconds();
    if (frame.control.stopped()) return; // the pass is incomplete
    for (std::size_t i = 0; i < frame.grid.size(); ++i) frame.collector.tiles_done += 1, frame.progress.step();
}

/// Adds the auxiliary values of a sample of every pixel to the framebuffer.
void add_aovs(const FrameContext& frame, const SampleView& sample, Framebuffer& framebuffer) {
    if (!frame.settings.aovs.any()) return;
    parallel_for(frame.grid.size(), frame.settings.threads, [&](std::size_t i) {
        DepthTile depths;
        rasterize_tile(frame.geometry, sample.view, sample.offset, frame.grid.tile(i), i, depths);
        visit_samples(frame, sample.view, i, depths, framebuffer);
    });
}

/// Renders one pass of Shading::kLit by deferred shading.
void render_lit(const FrameContext& frame, const CameraModel& camera, const View& view, const Pass& pass,
                Framebuffer& framebuffer) {
    const auto images = frame.data.deferred_frames->take();
    for_each_lit_sample(frame, camera, view, pass, [&](const SampleView& sample) {
        add_aovs(frame, sample, framebuffer);
        shade_deferred(sample, *images);
        if (!frame.control.stopped())
            for_each_pixel(view, frame.settings.threads,
                           [&](int x, int y) { framebuffer.add(x, y, images->radiance.color_at(x, y)); });
        frame.collector.add(*images);
    });
}

/// Renders one pass per sample of the lens and of time, and averages them.
Rendering render_image(const FrameContext& frame, const CameraModel& camera, const View& view,
                       const std::vector<Pass>& passes) {
    const bool lines = frame.settings.shading == Shading::kLines, edges = draws_edges(frame.settings);
    Framebuffer framebuffer(view, frame.settings, passes.size() > 1 || passes.front().samples.size() > 1);
    std::optional<Overlay> overlay;
    if (lines || edges) overlay.emplace(frame.data, frame.settings, view);
    for (const Pass& pass : passes) {
        if (frame.control.stopped()) break;
        if (lines) overlay->add_lines(pass_view_of(camera, view, frame.settings, pass));
        if (frame.program == nullptr)
            render_lit(frame, camera, view, pass, framebuffer);
        else
            render_pass(frame, camera, view, pass, [&](const PassView& pass_view, std::size_t i) {
                if (frame.is_multisampled())
                    render_multisampled_tile(frame, pass_view, i, framebuffer);
                else
                    render_tile(frame, pass_view, i, framebuffer);
            });
        if (edges && !frame.control.stopped()) add_edges(frame, camera, view, pass, *overlay);
    }
    const Stopwatch watch;
    frame.collector.framebuffer_bytes = framebuffer.memory_bytes();
    Rendering result = framebuffer.finish(frame.settings.threads);
    if (overlay) overlay->composite(result.radiance);
    frame.collector.resolve = watch.seconds();
    return result;
}

template <typename Pixel> void resize(Image<Pixel>& image, const View& view) {
    if (image.width() != view.width || image.height() != view.height) image = Image<Pixel>(view.width, view.height);
}

/// Renders one sample per pixel directly to the format of a display or a shadow map.
void render_direct_output(const FrameContext& frame, const CameraModel& camera, const View& view, const Pass& pass,
                          Rendering& result) {
    const bool depth_only = frame.settings.output == Output::kReversedDepth;
    if (depth_only) {
        resize(result.reversed_depth, view);
        frame.collector.framebuffer_bytes = result.reversed_depth.size() * sizeof(float);
    } else {
        resize(result.srgb, view);
        frame.collector.framebuffer_bytes = result.srgb.size() * sizeof(Rgba8);
    }
    if (!depth_only && frame.program == nullptr) {
        const SrgbEncoder& encoder = srgb_encoder();
        const auto images = frame.data.deferred_frames->take();
        for_each_lit_sample(frame, camera, view, pass, [&](const SampleView& sample) {
            shade_deferred(sample, *images);
            frame.collector.add(*images);
            if (frame.control.stopped()) return;
            for_each_pixel(view, frame.settings.threads, [&](int x, int y) {
                const Rgb c = images->radiance.color_at(x, y);
                result.srgb(x, y) = {encoder(c.r), encoder(c.g), encoder(c.b), 255};
            });
        });
        return;
    }
    render_pass(frame, camera, view, pass, [&](const PassView& pass_view, std::size_t i) {
        if (depth_only)
            render_depth_tile(frame.data, frame.geometry, frame.layers, pass_view, frame.grid.tile(i), i,
                              result.reversed_depth);
        else
            display_tile(frame.data, *frame.program, frame.geometry, pass_view, frame.grid.tile(i), i, result.srgb);
    });
}

void render_with(const RasterScene& prepared, const View& view, const RasterSettings& settings,
                 const ShaderProgram* program, Control& control, Rendering& result) {
    validate(view, settings);
    const RasterSceneData& data = prepared.data();
    const CameraModel camera(view);
    RasterSettings effective_settings = settings;
    if (settings.output == Output::kReversedDepth)
        effective_settings.samples_per_pixel = 1, effective_settings.multisamples = 0, effective_settings.edges = false;
    const std::vector<Pass> passes = plan_view(data, view, camera, effective_settings);
    const TileGrid grid{{0, 0, view.width, view.height}};
    StatisticsCollector collector;
    Progress progress(control, grid.size() * passes.size());
    const auto geometry = data.geometries->take(), layers = data.geometries->take();
    const FrameContext frame{data,      effective_settings, program,
                             grid,      *geometry,          data.has_layers() ? &*layers : nullptr,
                             collector, progress,           control};

    const bool has_overlay = draws_edges(effective_settings) || effective_settings.shading == Shading::kLines;
    const bool one_sample = passes.size() == 1 && passes.front().samples.size() == 1;
    if (effective_settings.output == Output::kReversedDepth ||
        (effective_settings.output == Output::kSrgb8 && one_sample && !has_overlay && !data.has_layers())) {
        render_direct_output(frame, camera, view, passes.front(), result);
        result.statistics = {};
    } else {
        result = render_image(frame, camera, view, passes);
        if (settings.output == Output::kSrgb8) encode(result.radiance, settings.threads, result.srgb);
    }
    fill_statistics(result.statistics, data, effective_settings, collector, passes, grid);
}

} // namespace

void render(const RasterScene& prepared, const View& view, const RasterSettings& settings, Control& control,
            Rendering& result) {
    const std::unique_ptr<ShaderProgram> built_in = built_in_program(settings.shading, view.camera);
    render_with(prepared, view, settings, built_in.get(), control, result);
}

void render(const RasterScene& prepared, const View& view, const RasterSettings& settings, const ShaderProgram& program,
            Control& control, Rendering& result) {
    RasterSettings other = settings; // only kLit shows the environment in the background, which must stay black here
    if (other.shading == Shading::kLit) other.shading = Shading::kAlbedo;
    render_with(prepared, view, other, &program, control, result);
}

std::vector<std::string> approximations(const RasterScene& prepared, const RasterSettings& settings) {
    return approximations(prepared.data(), settings);
}

Rendering render(const RasterScene& prepared, const View& view, const RasterSettings& settings, Control& control) {
    Rendering result;
    render(prepared, view, settings, control, result);
    return result;
}

} // namespace duet::raster
