// A PageSession is what one worker of the web page holds: the scene that is edited, and one pipeline's image of it.
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
/// share no memory, so that the page needs neither threads nor the isolation that browsers ask for them.
class PageSession {
public:
    enum class Pipeline { kRaster, kRaytrace };

    /// Path tracers with different seeds compute independent images, whose mean the command "trace" takes.
    explicit PageSession(Pipeline pipeline, std::uint64_t seed = 0);
    ~PageSession();

    /// Carries out a command, an object whose member "do" names it (the table kCommands in page_commands.cpp), and
    /// returns an object: what the command says of its result, or {"error": message}. After an error all is as before.
    nlohmann::ordered_json call(const nlohmann::ordered_json& command);

    /// The linear image that was rendered last; empty at first.
    const ImageRgb& image() const { return image_; }
    /// The bytes that the last command has made of an image, as display_bytes() returns them.
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }
    /// An image of another session, for the commands "compare" and "trace".
    ImageRgb& other_image() { return other_image_; }

private:
    friend struct PageCommands; // the functions of kCommands
    using Json = nlohmann::ordered_json;

    static constexpr int kMaxSamples = 4096; // the path tracer stops here

    // The scene as both pipelines have prepared it. Prepared scenes refer to the scene.
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
    Settings whole_image_, settings_;                     // settings_: of the quantity
    std::unique_ptr<Prepared> prepared_;                  // null after an edit
    std::unique_ptr<raytrace::ProgressiveRender> render_; // null after a change of what is seen
    std::uint32_t samples_ = 0;                           // of render_
    double seconds_ = 0;                                  // of render_
    Image<Hit> hits_;                                     // of the rasterizer's image
    ImageRgb image_, other_image_;
    std::vector<std::uint8_t> bytes_;
};

} // namespace duet::compare
