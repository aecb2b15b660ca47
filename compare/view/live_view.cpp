#include "compare/view/live_view.h"

#include "common/system/stopwatch.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace duet::compare {

namespace {

/// While the camera moves, the rasterizer's images are made smaller until one takes at most this long, in seconds.
constexpr double kMovingFrameSeconds = 1.0 / 30;
/// The smaller images have at least this fraction of the width, at which shapes are still recognizable.
constexpr double kLeastScale = 0.25;
/// The path tracer's first image has this fraction of the width.
constexpr double kPreviewScale = 0.25;
/// A pass of the path tracer takes about kPassSeconds at first, in seconds, and later the fraction kPassPart of the
/// time so far. This is short enough to watch it converge, and long enough to make the cost of copying the image
/// negligible.
constexpr double kPassSeconds = 0.3, kPassPart = 0.1;
/// The preview first has one sample per pixel, which is shown in any case, and then this many. The full-size image
/// replaces it once it has as many samples.
constexpr std::uint32_t kPreviewSamples = 4;
/// Probes are rendered anew when there was no edit for this time, in seconds.
constexpr double kRestSeconds = 0.2;
/// A pass adds at most this many samples per pixel, as passes of raytrace do.
constexpr std::uint32_t kPassSamples = 16;

std::shared_ptr<const Scene> seen_in(const View& view, Scene scene) {
    scene.camera = view.camera;
    scene.width = view.width;
    scene.height = view.height;
    return std::make_shared<const Scene>(std::move(scene));
}

// Waits until no edit has come for kRestSeconds. Returns false if the next one comes before.
bool rests(const std::atomic<bool>& stop) {
    for (const Stopwatch watch; !stop && watch.seconds() < kRestSeconds;)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return !stop;
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

template <typename Settings> Settings LiveView::with_threads() const {
    Settings settings;
    settings.threads = threads_;
    return settings;
}

// Runs a job on a thread. If it throws, the message is stored in LoadedScene::error.
void LiveView::start(LatestJob& thread, LatestJob::Job job) {
    thread.start([this, job = std::move(job)](const std::atomic<bool>& stop) {
        try {
            job(stop);
        } catch (const std::exception& error) {
            publish([&] {
                loaded_.error = error.what();
                loading_ = false;
            });
        }
    });
}

unsigned LiveView::load(const View& view, SceneReader read, bool edited) {
    const unsigned load = ++loads_;
    loads_edit_ = edited;
    start(loader_, [=, this](const std::atomic<bool>&) {
        loading_ = true;
        LoadedScene next;
        next.scene = seen_in(view, read(edited ? Transforms::kKept : Transforms::kBaked));
        next.load = load;
        next.raytrace = prepare_traced(load, next.scene, edited ? hierarchies() : nullptr);
        edited_ = edited ? next.raytrace : nullptr;
        LoadedScene before; // freed outside of the lock
        publish([&] {
            next.raster = loaded_.raster;
            before = std::exchange(loaded_, next);
            loading_ = false;
        });
        const bool seen = edited && prepare_edited_raster(load, next.scene);
        start(preparer_, [=, this, scene = next.scene](const std::atomic<bool>& stop) {
            if (seen && !rests(stop)) return;
            if (edited)
                prepare_whole(load, seen_in(view, read(Transforms::kBaked)), stop);
            else
                prepare_raster(load, scene);
        });
    });
    return load;
}

void LiveView::expect_edits(const View& view, SceneReader read) {
    if (expected_ == loads_ || loader_.busy()) return;
    expected_ = loads_;
    start(loader_, [=, this, load = loads_](const std::atomic<bool>&) {
        if (!edited_) edited_ = prepare_traced(load, seen_in(view, read(Transforms::kKept)), hierarchies());
    });
}

// Prepares a scene for the path tracer. If `before` is not null, the scene is an edit of it, and takes its hierarchies.
std::shared_ptr<const LiveView::Traced> LiveView::prepare_traced(unsigned load,
                                                                 const std::shared_ptr<const Scene>& scene,
                                                                 const std::shared_ptr<const Traced>& before) {
    const Stopwatch watch;
    const auto settings = with_threads<raytrace::PathTracerSettings>();
    raytrace::PathTracerScene traced =
        before ? prepare_edited(*scene, settings, before->prepared) : prepare(*scene, settings);
    return std::make_shared<const Traced>(
        Traced{++preparations_, load, scene, std::move(traced), watch.seconds(), before == nullptr});
}

// Prepares an edited scene as the programs do, for both pipelines.
void LiveView::prepare_whole(unsigned load, const std::shared_ptr<const Scene>& scene, const std::atomic<bool>& stop) {
    const std::shared_ptr<const Traced> traced = prepare_traced(load, scene, nullptr);
    publish([&] {
        if (loaded_.load != load) return;
        loaded_.scene = scene;
        loaded_.raytrace = traced;
    });
    if (!stop) prepare_raster(load, scene);
}

void LiveView::prepare_raster(unsigned load, const std::shared_ptr<const Scene>& scene) {
    const Stopwatch watch;
    raster::RasterScene result = prepare(*scene, with_threads<raster::RasterSettings>());
    set_raster({++preparations_, load, scene, std::move(result), watch.seconds()});
}

// Prepares the rasterizer's scene with the probes of the previous scene. Returns false if they do not fit.
bool LiveView::prepare_edited_raster(unsigned load, const std::shared_ptr<const Scene>& scene) {
    const auto before = loaded().raster;
    if (!before) return false;
    const Stopwatch watch;
    std::optional<raster::RasterScene> result =
        prepare_edited(*scene, with_threads<raster::RasterSettings>(), before->prepared);
    if (!result) return false;
    set_raster({++preparations_, load, scene, std::move(*result), watch.seconds(), false});
    return true;
}

void LiveView::set_raster(PreparedScene<raster::RasterScene> next) {
    auto shared = std::make_shared<const PreparedScene<raster::RasterScene>>(std::move(next));
    publish([&] { // the previous scene is freed outside of the lock
        if (loaded_.load == shared->load) loaded_.raster.swap(shared);
    });
}

void LiveView::prepare_for(const View& view, const LoadedScene& loaded) {
    start(preparer_, [=, this](const std::atomic<bool>&) {
        prepare_raster(loaded.load, seen_in(view, *loaded.scene));
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
    if (!scene.raytrace) return;
    const Started started{wish.version, scene.load, scene.raytrace->id, 1};
    if (tracer_started_ == started) return;
    tracer_started_ = started;
    tracer_.start([=, this](const std::atomic<bool>& stop) { render_traced(wish, scene, stop); });
}

void LiveView::show_raster(const Wish& wish, const LoadedScene& scene) {
    const Started full{wish.version, scene.raster->load, scene.raster->id, 1};
    if (raster_started_ == full) {
        const bool outdated = !scene.raster->whole || scene.raster->load != scene.load ||
                              !(wish.view == scene_view(*scene.raster->scene));
        const bool tried = prepared_for_.version == wish.version && prepared_for_.load == scene.load;
        if (!outdated || tried || raster_.busy() || loader_.busy() || preparer_.busy()) return;
        prepared_for_ = {wish.version, scene.load};
        prepare_for(wish.view, scene);
        return;
    }
    const bool moving = raster_started_.version != wish.version || raster_started_.load != scene.raster->load;
    // The full-size image waits until the first small one is finished. It also waits while an edit is loaded, which
    // would make it outdated.
    if (!moving && raster_started_.scale < 1 && (raster_.busy() || (loads_edit_ && loader_.busy()))) return;
    Started next = full;
    if (moving && pixel_seconds_ > 0)
        next.scale =
            std::clamp(std::sqrt(kMovingFrameSeconds / (pixel_seconds_ * pixels(wish.view))), kLeastScale, 1.0);
    raster_started_ = next;
    raster_.start([=, this](const std::atomic<bool>& stop) {
        // The first frame of a new view runs to its end. Otherwise nothing would be shown while the camera or an object
        // moves.
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

void LiveView::render_traced(const Wish& wish, const LoadedScene& scene, const std::atomic<bool>& stop) {
    TracerFrame frame{.version = wish.version, .prepared = scene.raytrace->id, .load = scene.load};
    Stopwatch watch;
    double paused_seconds = 0;
    const auto wait = [&](const auto& condition) {
        const Stopwatch pause;
        while (condition() && !stop) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        paused_seconds += pause.seconds();
    };
    const auto seconds = [&] { return watch.seconds() - paused_seconds; };
    const auto publish_frame = [&] { publish([&] { tracer_frame_ = std::make_shared<const TracerFrame>(frame); }); };
    try {
        wait([&] { return paused_.load(); });
        Control to_the_end, stoppable{.stop = &stop, .progress = {}};
        // After an edit, the scene is prepared once more. The image that is shown stays until the new one has as many
        // samples.
        const auto shown = tracer_frame();
        const bool same = shown && shown->version == wish.version && shown->load == scene.load && !shown->preview;
        const std::uint32_t least_samples = same ? shown->samples : kPreviewSamples;
        raytrace::ProgressiveRender preview(scene.raytrace->prepared, scaled(wish.view, kPreviewScale), wish.raytrace);
        const auto limit = static_cast<std::uint32_t>(wish.raytrace.samples_per_pixel);
        frame.preview = true;
        for (const std::uint32_t end : {1u, std::min(kPreviewSamples, limit)}) {
            if (same || end <= frame.samples) break;
            if (!preview.add_samples(end - frame.samples, frame.samples == 0 ? to_the_end : stoppable)) return;
            frame.samples = end;
            frame.image = preview.film().image();
            frame.seconds = seconds();
            publish_frame();
        }
        if (stop) return;

        raytrace::ProgressiveRender render(scene.raytrace->prepared, wish.view, wish.raytrace);
        frame.preview = false;
        frame.samples = 0;
        for (double sample_seconds = 0; frame.samples < limit;) {
            wait([&] { return paused_ || loading_; }); // while an edit is loaded, the image is outdated
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
            if (frame.samples >= std::min(least_samples, limit)) publish_frame();
        }
    } catch (const std::exception& error) {
        frame.error = error.what();
        frame.image = {};
        publish_frame();
    }
}

bool LiveView::finished(const Wish& wish) const {
    if (loader_.busy() || preparer_.busy()) return false;
    const std::lock_guard lock(mutex_);
    if (!loaded_.raster || !loaded_.raster->whole || !loaded_.raytrace->whole ||
        loaded_.raster->load != loaded_.load || !raster_frame_ || !tracer_frame_ ||
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
