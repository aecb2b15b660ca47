// This file declares LiveView, which renders a scene with both pipelines in the background for a window that shows the
// latest images.
#pragma once

#include "compare/renderer.h"
#include "compare/view/document.h"
#include "compare/view/latest_job.h"
#include "raytrace/progressive_render.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace duet::compare {

/// A PreparedScene is a scene as one pipeline has prepared it. It keeps the scene alive.
template <typename Prepared> struct PreparedScene {
    unsigned id;   ///< different for every preparation
    unsigned load; ///< LoadedScene::load
    std::shared_ptr<const Scene> scene;
    Prepared prepared;
    double seconds; ///< time of the preparation
    /// This is false after an edit until no edit has come for a moment. Then the rasterizer's scene has the previous
    /// one's probes, and the path tracer's has all transforms.
    bool whole = true;
};

/// Describes the scene that was loaded last.
struct LoadedScene {
    unsigned load = 0;                  ///< what LiveView::load returned for this scene
    std::shared_ptr<const Scene> scene; ///< null until a scene has been loaded
    std::shared_ptr<const PreparedScene<raytrace::PathTracerScene>> raytrace; ///< prepared from `scene`
    /// The rasterizer takes longer to prepare a scene. Until it has finished, this is the previous scene, or the new
    /// scene with the previous scene's probes. The rasterizer places probes and shadow maps for the scene's camera, so
    /// the scene is prepared anew when the camera has moved and come to rest.
    std::shared_ptr<const PreparedScene<raster::RasterScene>> raster;
    std::string error; ///< why the newest text could not be loaded; empty if `scene` is of that text
};

/// A Wish describes the images that the window requests. Its `version` differs from that of the previous wish if
/// anything else does.
struct Wish {
    unsigned version = 0;
    View view;
    raster::RasterSettings raster;
    raytrace::PathTracerSettings raytrace; ///< stops at samples_per_pixel
};

/// A RasterFrame is an image of the rasterizer.
struct RasterFrame {
    unsigned version = 0, prepared = 0, load = 0; ///< Wish::version, PreparedScene::id and PreparedScene::load
    double scale = 1;                             ///< width over the requested width; below 1 while the camera moves
    double seconds = 0;
    Rendering rendering{};
    std::string error{}; ///< why there is no image
};

/// A TracerFrame is the path tracer's image so far.
struct TracerFrame {
    unsigned version = 0, prepared = 0, load = 0;
    bool preview = false; ///< whether it is a preview of a quarter of the width
    std::uint32_t samples = 0;
    double seconds = 0; ///< time since the first sample
    ImageRgb image{};
    double estimated_relmse = -1;                   ///< see Film::estimated_relmse
    std::vector<std::pair<double, double>> curve{}; ///< seconds and estimated_relmse so far
    std::string error{};                            ///< why there is no image
};

/// A LiveView owns four threads. One loads and prepares scenes. One does what takes longer: it renders the rasterizer's
/// probes, and prepares edited scenes as the programs do. One for each pipeline renders images. They call `wake`
/// whenever there is a new result.
class LiveView {
public:
    LiveView(int threads, std::function<void()> wake);

    /// Loads a scene in the background, for this view. The previous scene stays until the new one is prepared, and if
    /// `read` throws. With `edited`, the new scene is an edit of the previous one. It is prepared fast, with what can
    /// be used again of the previous scene. When no edit has come for a moment, it is prepared once more as programs
    /// do. Returns a number that is different for every call (LoadedScene::load).
    unsigned load(const View& view, SceneReader read, bool edited = false);
    /// Prepares in the background for edits of the scene that was loaded last, which then show sooner. `read` reads
    /// that scene. A second call for the same scene does nothing.
    void expect_edits(const View& view, SceneReader read);
    LoadedScene loaded() const;

    /// Renders the requested images, unless this happens already. Call it for every frame of the window. A frame of the
    /// rasterizer is smaller while wishes change faster than it renders. Once the camera rests, the scene is prepared
    /// anew for this camera, so that the images are those that the programs render with it.
    void show(const Wish& wish);
    /// Pauses or resumes the path tracer. A paused path tracer renders nothing, and its image may show another view.
    void pause(bool paused) { paused_ = paused; }
    bool paused() const { return paused_; }

    /// Returns the rasterizer's latest image, and the next function the path tracer's; null at first.
    std::shared_ptr<const RasterFrame> raster_frame() const;
    std::shared_ptr<const TracerFrame> tracer_frame() const;
    /// Returns whether both images are complete: the rasterizer's in full size, the path tracer's with all samples.
    bool finished(const Wish& wish) const;

private:
    using Traced = PreparedScene<raytrace::PathTracerScene>;
    void publish(const std::function<void()>& change); // calls change() under the lock, then wake_
    template <typename Settings> Settings with_threads() const;
    void start(LatestJob& thread, LatestJob::Job job);
    std::shared_ptr<const Traced> hierarchies() const { return edited_ ? edited_ : loaded().raytrace; } // on loader_
    std::shared_ptr<const Traced> prepare_traced(unsigned load, const std::shared_ptr<const Scene>& scene,
                                                 const std::shared_ptr<const Traced>& before);
    void prepare_whole(unsigned load, const std::shared_ptr<const Scene>& scene, const std::atomic<bool>& stop);
    void prepare_raster(unsigned load, const std::shared_ptr<const Scene>& scene);
    bool prepare_edited_raster(unsigned load, const std::shared_ptr<const Scene>& scene);
    void set_raster(PreparedScene<raster::RasterScene> next);
    void prepare_for(const View& view, const LoadedScene& loaded);
    void show_raster(const Wish& wish, const LoadedScene& scene);
    void render_raster(const Wish& wish, const LoadedScene& scene, double scale, const std::atomic<bool>& stop);
    void render_traced(const Wish& wish, const LoadedScene& scene, const std::atomic<bool>& stop);

    const int threads_;
    unsigned loads_ = 0, expected_ = 0; // expected_: the load that expect_edits() was called for
    bool loads_edit_ = false; // whether the last load is one of an edited scene
    std::atomic<unsigned> preparations_ = 0;
    const std::function<void()> wake_;
    std::atomic<bool> paused_ = false;
    std::atomic<bool> loading_ = false; // true while a scene is read and prepared for the path tracer
    std::shared_ptr<const Traced> edited_; // of the last edit, with hierarchies that the next one uses; of loader_
    mutable std::mutex mutex_; // guards the results
    LoadedScene loaded_;
    std::shared_ptr<const RasterFrame> raster_frame_;
    std::shared_ptr<const TracerFrame> tracer_frame_;
    // These describe the last renders that were started.
    struct Started {
        unsigned version = 0, load = 0, prepared = 0;
        double scale = 1;
        friend bool operator==(const Started&, const Started&) = default;
    } raster_started_, tracer_started_;
    // This is the wish and the scene for which the rasterizer was last prepared anew.
    struct {
        unsigned version = 0, load = 0;
    } prepared_for_;
    std::atomic<double> pixel_seconds_ = 0; // seconds per pixel of a frame of the rasterizer; 0: unknown
    // These members come last, because their threads use the members above. The loader, which starts jobs of the
    // preparer, ends before it.
    LatestJob preparer_, loader_, raster_, tracer_;
};

} // namespace duet::compare
