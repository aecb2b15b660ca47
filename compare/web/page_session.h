// A PageSession is the state of one worker of the web page: the scene that is edited, and one pipeline's image of it.
#pragma once

#include "compare/view/document.h"
#include "compare/view/image_comparison.h"
#include "compare/view/quantities.h"
#include "compare/view/scene_text.h"
#include "raytrace/progressive_render.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

/// The page has a worker for each pipeline, and sends each edit to both, so that both hold the same scene. Workers
/// share no memory, so that the page needs neither threads nor the cross-origin isolation that browsers require for
/// them.
class PageSession {
public:
    enum class Pipeline { kRaster, kRaytrace };

    /// Path tracers with different seeds compute independent images, whose mean the command "trace" takes.
    explicit PageSession(Pipeline pipeline, std::uint64_t seed = 0);
    ~PageSession();

    /// Carries out a command: an object whose member "do" is a name of the table kCommands (page_commands.cpp). Returns
    /// an object: the command's result, or {"error": message}. After an error the session is unchanged.
    nlohmann::ordered_json call(const nlohmann::ordered_json& command);

    /// Returns the linear image that was rendered last; empty at first.
    const ImageRgb& image() const { return image_; }
    /// Returns the image of the last command as bytes, as display_bytes() returns them.
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }
    /// Returns a buffer for an image of another session, for the commands "compare" and "trace".
    ImageRgb& other_image() { return other_image_; }

private:
    friend struct PageCommands; // the functions of kCommands
    using Json = nlohmann::ordered_json;

    static constexpr int kMaxSamples = 4096; // the path tracer stops here

    // A Prepared is the scene as both pipelines have prepared it. Prepared scenes refer to the scene.
    struct Prepared {
        Scene scene;
        std::optional<raster::RasterScene> raster;
        std::optional<raytrace::PathTracerScene> raytrace;
    };

    struct Settings {
        raster::RasterSettings raster{};
        raytrace::PathTracerSettings raytrace{};
    };

    SceneDocument& document();
    Prepared& prepared();
    const raster::RasterScene& raster_scene();
    const raytrace::PathTracerScene& path_tracer_scene();
    View view();
    Ray ray_through(const Json& pixel);
    Box3 bounds_of(const JsonPath& path);
    std::unique_ptr<Prepared> unprepared(Scene scene) const;
    void scene_changed(std::unique_ptr<Prepared> scene);
    std::vector<RungRenderers> quantities();
    Settings settings_of(const std::string& quantity);
    ImageRgb mean_of_all(float part);
    Json state();
    Json shown();

    const Pipeline pipeline_;
    std::optional<SceneDocument> document_;
    ImageSize size_{};
    ViewTransform view_transform_;
    std::string quantity_;                                // a name of plan_rungs()
    Settings whole_image_, settings_;                     // settings_: those of the quantity
    std::unique_ptr<Prepared> prepared_;                  // null until it is needed
    std::unique_ptr<raytrace::ProgressiveRender> render_; // null after a change of what is rendered
    std::uint32_t samples_ = 0;                           // samples of render_
    double seconds_ = 0;                                  // seconds of render_
    Image<Hit> hits_;                                     // hits of the rasterizer's image
    ImageRgb image_, other_image_;
    std::vector<std::uint8_t> bytes_;
};

} // namespace duet::compare
