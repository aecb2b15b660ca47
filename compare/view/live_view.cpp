#include "compare/view/live_view.h"

#include "common/system/stopwatch.h"

#include <algorithm>
#include <chrono>
#include <cmath>

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
/// The image of a scene that was edited replaces the one before from this many samples per pixel on.
constexpr std::uint32_t kSamplesToReplace = 4;
/// A pass adds at most this many samples per pixel, as passes of raytrace do.
constexpr std::uint32_t kPassSamples = 16;

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
void LiveView::start_loading(std::function<void()> job) {
    loader_.start([this, job = std::move(job)](const std::atomic<bool>&) {
        try {
            job();
        } catch (const std::exception& error) {
            publish([&] { loaded_.error = error.what(); });
        }
    });
}

unsigned LiveView::load(const View& view, std::function<Scene()> read) {
    const unsigned load = ++loads_;
    start_loading([=, this] {
        LoadedScene next;
        next.scene = std::make_shared<const Scene>(seen_in(view, read()));
        next.load = load;
        next.raytrace = prepared<raytrace::PathTracerScene, raytrace::PathTracerSettings>(next.load, next.scene);
        LoadedScene before; // is freed outside of the lock
        publish([&] {
            next.raster = loaded_.raster;
            before = std::exchange(loaded_, next);
        });
        prepare_raster(next.load, next.scene); // also if the next edit waits: edits are seen while they go on
    });
    return load;
}

void LiveView::prepare_raster(unsigned load, const std::shared_ptr<const Scene>& scene) {
    const auto next = prepared<raster::RasterScene, raster::RasterSettings>(load, scene);
    publish([&] {
        if (loaded_.load == load) loaded_.raster = next;
    });
}

void LiveView::prepare_for(const View& view, const LoadedScene& loaded) {
    start_loading(
        [=, this] { prepare_raster(loaded.load, std::make_shared<const Scene>(seen_in(view, *loaded.scene))); });
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
    const bool same_view = tracer_started_.prepared != 0 && wish.view == traced_view_;
    tracer_started_ = Started{wish.version, scene.raytrace->id, 1};
    traced_view_ = wish.view;
    tracer_.start([=, this](const std::atomic<bool>& stop) { render_traced(wish, scene, same_view, stop); });
}

void LiveView::show_raster(const Wish& wish, const LoadedScene& scene) {
    const Started full{wish.version, scene.raster->id, 1};
    if (raster_started_ == full) {
        const bool outdated = scene.raster->load != scene.load || !(wish.view == scene_view(*scene.raster->scene));
        const bool tried = prepared_for_.version == wish.version && prepared_for_.load == scene.load;
        if (!outdated || tried || raster_.busy() || loader_.busy()) return;
        prepared_for_ = {wish.version, scene.load};
        prepare_for(wish.view, scene);
        return;
    }
    const bool moving = raster_started_.version != wish.version;
    if (!moving && raster_started_.scale < 1 && raster_.busy()) return;
    Started next = full;
    if (moving && pixel_seconds_ > 0)
        next.scale =
            std::clamp(std::sqrt(kMovingFrameSeconds / (pixel_seconds_ * pixels(wish.view))), kLeastScale, 1.0);
    raster_started_ = next;
    raster_.start([=, this](const std::atomic<bool>& stop) {
        // A frame of a new view runs to its end, or nothing would be seen while the camera moves.
        const std::atomic<bool> go_on = false;
        render_raster(wish, scene, next.scale, moving ? go_on : stop);
    });
}

void LiveView::render_raster(const Wish& wish, const LoadedScene& scene, double scale, const std::atomic<bool>& stop) {
    RasterFrame frame{wish.version, scene.raster->id, scene.raster->load, scale, 0, {}, {}};
    try {
        const Stopwatch watch;
        const View view = scaled(wish.view, scale);
        Control control{&stop, {}};
        frame.rendering = render(scene.raster->prepared, view, wish.raster, control);
        frame.seconds = watch.seconds();
        if (control.stopped()) return;
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

void LiveView::render_traced(const Wish& wish, const LoadedScene& scene, bool same_view,
                             const std::atomic<bool>& stop) {
    TracerFrame frame{.version = wish.version, .prepared = scene.raytrace->id, .load = scene.load};
    Stopwatch watch;
    double paused_seconds = 0;
    const auto wait = [&] {
        const Stopwatch pause;
        wait_while_paused(stop);
        paused_seconds += pause.seconds();
    };
    const auto seconds = [&] { return watch.seconds() - paused_seconds; };
    const auto publish_frame = [&] { publish([&] { tracer_frame_ = std::make_shared<const TracerFrame>(frame); }); };
    try {
        wait();
        Control to_the_end, stoppable{.stop = &stop, .progress = {}};
        if (!same_view) {
            raytrace::ProgressiveRender preview(scene.raytrace->prepared, scaled(wish.view, kPreviewScale),
                                                wish.raytrace);
            preview.add_samples(1, to_the_end);
            frame.preview = true;
            frame.samples = 1;
            frame.image = preview.film().image();
            frame.seconds = seconds();
            publish_frame();
        }
        if (stop) return;

        raytrace::ProgressiveRender render(scene.raytrace->prepared, wish.view, wish.raytrace);
        const auto limit = static_cast<std::uint32_t>(wish.raytrace.samples_per_pixel);
        frame.preview = false;
        frame.samples = 0;
        for (double sample_seconds = 0; frame.samples < limit;) {
            wait();
            const double pass_seconds = std::max(kPassSeconds, kPassPart * seconds());
            const auto fitting = static_cast<std::uint32_t>(sample_seconds > 0 ? pass_seconds / sample_seconds : 1);
            const std::uint32_t more =
                std::min({std::max(fitting, 1u), kPassSamples, std::max(frame.samples, 1u), limit - frame.samples});
            const Stopwatch pass;
            if (!render.add_samples(more, stoppable)) return;
            sample_seconds = pass.seconds() / more;
            frame.samples += more;
            frame.image = render.film().image();
            frame.estimated_relmse = render.film().estimated_relmse();
            frame.seconds = seconds();
            if (frame.estimated_relmse > 0) frame.curve.emplace_back(frame.seconds, frame.estimated_relmse);
            // After an edit the picture before stays until this one is less noisy.
            if (!same_view || frame.samples >= std::min(kSamplesToReplace, limit)) publish_frame();
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
        !(wish.view == scene_view(*loaded_.raster->scene)))
        return false;
    const bool raster = raster_frame_->version == wish.version && raster_frame_->prepared == loaded_.raster->id &&
                        raster_frame_->scale == 1;
    const bool traced = tracer_frame_->version == wish.version && tracer_frame_->prepared == loaded_.raytrace->id &&
                        (tracer_frame_->samples == static_cast<std::uint32_t>(wish.raytrace.samples_per_pixel) ||
                         !tracer_frame_->error.empty());
    return raster && traced;
}

} // namespace duet::compare
