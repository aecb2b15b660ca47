#include "compare/view/live_view.h"

#include "common/system/stopwatch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

namespace duet::compare {

namespace {

/// While the camera moves, the rasterizer's images are made smaller until one takes at most this long, in seconds.
constexpr double kMovingFrameSeconds = 1.0 / 30;
/// They have at least this fraction of the width, in which shapes can still be made out.
constexpr double kLeastScale = 0.25;
/// The path tracer's first image has this fraction of the width.
constexpr double kPreviewScale = 0.25;
/// A pass of the path tracer takes about this long at first, in seconds, and later this part of the time so far: short
/// enough to watch it converge, and long enough for copies of the image not to count.
constexpr double kPassSeconds = 0.3, kPassPart = 0.1;
/// A pass adds at most this many samples per pixel, as passes of raytrace do.
constexpr std::uint32_t kPassSamples = 16;

View scaled(View view, double scale) {
    const auto side = [scale](int pixels) { return std::max(1, static_cast<int>(std::lround(pixels * scale))); };
    view.width = side(view.width);
    view.height = side(view.height);
    return view;
}

bool same(const View& view, const Scene& scene) {
    const auto values = [](const Camera& c) {
        return std::tie(c.projection, c.eye, c.look_at, c.up, c.fov_degrees, c.height, c.near, c.aperture_radius,
                        c.focus_distance, c.shutter_open, c.shutter_close);
    };
    return view.width == scene.width && view.height == scene.height && values(view.camera) == values(scene.camera);
}

Scene seen_in(const View& view, Scene scene) {
    scene.camera = view.camera;
    scene.width = view.width;
    scene.height = view.height;
    return scene;
}

double pixels(const View& view) { return static_cast<double>(view.width) * view.height; }

} // namespace

LiveView::LiveView(int threads, std::function<void()> wake) : threads_(threads), wake_(std::move(wake)) {}

void LiveView::publish(const std::function<void()>& change) {
    {
        const std::lock_guard lock(mutex_);
        change();
    }
    wake_();
}

template <typename Prepared, typename Settings>
std::shared_ptr<const PreparedScene<Prepared>> LiveView::prepared(unsigned load,
                                                                  const std::shared_ptr<const Scene>& scene) {
    Settings settings;
    settings.threads = threads_;
    const Stopwatch watch;
    Prepared result = prepare(*scene, settings);
    return std::make_shared<const PreparedScene<Prepared>>(
        PreparedScene<Prepared>{++preparations_, load, scene, std::move(result), watch.seconds()});
}

// Runs a job on the loader's thread, and reports why it failed.
void LiveView::start_loading(LatestJob::Job job) {
    loader_.start([this, job = std::move(job)](const std::atomic<bool>& stop) {
        try {
            job(stop);
        } catch (const std::exception& error) {
            publish([&] { loaded_.error = error.what(); });
        }
    });
}

void LiveView::load(const View& view, std::function<Scene()> read) {
    start_loading([=, this](const std::atomic<bool>& stop) {
        const Stopwatch watch;
        LoadedScene next;
        next.scene = std::make_shared<const Scene>(seen_in(view, read()));
        next.load_seconds = watch.seconds();
        next.load = ++loads_;
        next.raytrace = prepared<raytrace::PathTracerScene, raytrace::PathTracerSettings>(next.load, next.scene);
        publish([&] {
            next.raster = loaded_.raster;
            loaded_ = next;
        });
        if (!stop) prepare_raster(next.load, next.scene);
    });
}

void LiveView::prepare_raster(unsigned load, const std::shared_ptr<const Scene>& scene) {
    const auto next = prepared<raster::RasterScene, raster::RasterSettings>(load, scene);
    publish([&] {
        if (loaded_.load == load) loaded_.raster = next;
    });
}

void LiveView::prepare_for(const View& view, const LoadedScene& loaded) {
    start_loading([=, this](const std::atomic<bool>&) {
        prepare_raster(loaded.load, std::make_shared<const Scene>(seen_in(view, *loaded.scene)));
    });
}

LoadedScene LiveView::loaded() const {
    const std::lock_guard lock(mutex_);
    return loaded_;
}

std::shared_ptr<const RasterFrame> LiveView::raster_frame() const {
    const std::lock_guard lock(mutex_);
    return raster_frame_;
}

std::shared_ptr<const TracerFrame> LiveView::tracer_frame() const {
    const std::lock_guard lock(mutex_);
    return tracer_frame_;
}

void LiveView::show(const Wish& wish) {
    const LoadedScene scene = loaded();
    if (scene.raster) show_raster(wish, scene);
    if (!scene.raytrace || tracer_started_ == Started{wish.version, scene.raytrace->id, 1}) return;
    tracer_started_ = Started{wish.version, scene.raytrace->id, 1};
    tracer_.start([=, this](const std::atomic<bool>& stop) { render_traced(wish, scene, stop); });
}

void LiveView::show_raster(const Wish& wish, const LoadedScene& scene) {
    const Started full{wish.version, scene.raster->id, 1};
    if (raster_started_ == full) {
        const bool outdated = scene.raster->load != scene.load || !same(wish.view, *scene.raster->scene);
        if (outdated && !raster_.busy() && !loader_.busy()) prepare_for(wish.view, scene);
        return;
    }
    if (raster_started_.version == wish.version && raster_started_.scale < 1 && raster_.busy()) return;
    Started next = full;
    if (raster_started_.version != wish.version && pixel_seconds_ > 0)
        next.scale =
            std::clamp(std::sqrt(kMovingFrameSeconds / (pixel_seconds_ * pixels(wish.view))), kLeastScale, 1.0);
    raster_started_ = next;
    raster_.start([=, this](const std::atomic<bool>& stop) { render_raster(wish, scene, next.scale, stop); });
}

void LiveView::render_raster(const Wish& wish, const LoadedScene& scene, double scale, const std::atomic<bool>& stop) {
    RasterFrame frame{wish.version, scene.raster->id, scale, 0, {}, {}};
    try {
        const Stopwatch watch;
        const View view = scaled(wish.view, scale);
        Control control;
        // A smaller frame runs to its end, or nothing would be seen while the camera moves.
        if (scale == 1) control.stop = &stop;
        frame.rendering = render(scene.raster->prepared, view, wish.raster, control);
        frame.seconds = watch.seconds();
        if (frame.rendering.statistics.interrupted || control.stopped()) return;
        publish([&] {
            pixel_seconds_ = frame.seconds / pixels(view);
            raster_frame_ = std::make_shared<const RasterFrame>(std::move(frame));
        });
    } catch (const std::exception& error) {
        frame.error = error.what();
        publish([&] { raster_frame_ = std::make_shared<const RasterFrame>(std::move(frame)); });
    }
}

void LiveView::wait_while_paused(const std::atomic<bool>& stop) const {
    while (paused_ && !stop) std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

void LiveView::render_traced(const Wish& wish, const LoadedScene& scene, const std::atomic<bool>& stop) {
    TracerFrame frame{.version = wish.version, .prepared = scene.raytrace->id};
    const Stopwatch watch;
    const auto publish_frame = [&] { publish([&] { tracer_frame_ = std::make_shared<const TracerFrame>(frame); }); };
    try {
        wait_while_paused(stop);
        Control to_the_end, stoppable{.stop = &stop, .progress = {}};
        raytrace::ProgressiveRender preview(scene.raytrace->prepared, scaled(wish.view, kPreviewScale), wish.raytrace);
        preview.add_samples(1, to_the_end);
        frame.preview = true;
        frame.samples = 1;
        frame.image = preview.film().image();
        frame.seconds = watch.seconds();
        publish_frame();
        if (stop) return;

        raytrace::ProgressiveRender render(scene.raytrace->prepared, wish.view, wish.raytrace);
        const auto limit = static_cast<std::uint32_t>(wish.raytrace.samples_per_pixel);
        frame.preview = false;
        frame.samples = 0;
        for (double sample_seconds = 0; frame.samples < limit;) {
            wait_while_paused(stop);
            const double pass_seconds = std::max(kPassSeconds, kPassPart * watch.seconds());
            const auto fitting = static_cast<std::uint32_t>(sample_seconds > 0 ? pass_seconds / sample_seconds : 1);
            const std::uint32_t more =
                std::min({std::max(fitting, 1u), kPassSamples, std::max(frame.samples, 1u), limit - frame.samples});
            const Stopwatch pass;
            if (!render.add_samples(more, stoppable)) return;
            sample_seconds = pass.seconds() / more;
            frame.samples += more;
            frame.image = render.film().image();
            frame.estimated_relmse = render.film().estimated_relmse();
            frame.seconds = watch.seconds();
            if (frame.estimated_relmse > 0) frame.curve.emplace_back(frame.seconds, frame.estimated_relmse);
            publish_frame();
        }
    } catch (const std::exception& error) {
        frame.error = error.what();
        frame.image = {};
        publish_frame();
    }
}

bool LiveView::finished(const Wish& wish) const {
    if (loader_.busy()) return false;
    const std::lock_guard lock(mutex_);
    if (!loaded_.raster || loaded_.raster->load != loaded_.load || !raster_frame_ || !tracer_frame_ ||
        !same(wish.view, *loaded_.raster->scene))
        return false;
    const bool raster = raster_frame_->version == wish.version && raster_frame_->prepared == loaded_.raster->id &&
                        raster_frame_->scale == 1;
    const bool traced = tracer_frame_->version == wish.version && tracer_frame_->prepared == loaded_.raytrace->id &&
                        (tracer_frame_->samples == static_cast<std::uint32_t>(wish.raytrace.samples_per_pixel) ||
                         !tracer_frame_->error.empty());
    return raster && traced;
}

} // namespace duet::compare
