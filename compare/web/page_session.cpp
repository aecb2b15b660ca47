#include "compare/web/page_session.h"

#include "common/system/error.h"
#include "compare/view/inspect.h"
#include "raster/shading/built_in_shaders.h"

#include <cmath>
#include <utility>

namespace duet::compare {

using Json = nlohmann::ordered_json;

namespace {

/// This is the number of samples per pixel of the rasterizer's image at rest.
constexpr int kRasterSamples = 4;

} // namespace

PageSession::PageSession(Pipeline pipeline, std::uint64_t seed) : pipeline_(pipeline), quantity_(kWholeImage) {
    const ComparisonSettings settings{
        .raster_spp = kRasterSamples, .raytrace_spp = kMaxSamples, .threads = 1, .seed = seed};
    whole_image_ = {raster_settings(settings), path_tracer_settings(settings)};
    whole_image_.raster.aovs.hit = true;
    whole_image_.raytrace.aovs.variance = true; // two replicates, from which the error is estimated
    settings_ = whole_image_;
}
PageSession::~PageSession() = default;

SceneDocument& PageSession::document() {
    if (!document_) throw Error("no scene is open");
    return *document_;
}

std::unique_ptr<PageSession::Prepared> PageSession::unprepared(Scene scene) const {
    auto result = std::make_unique<Prepared>(Prepared{std::move(scene), {}, {}});
    result->scene.width = size_.width;
    result->scene.height = size_.height;
    return result;
}

PageSession::Prepared& PageSession::prepared() {
    if (!prepared_) prepared_ = unprepared(document().reader()(Transforms::kBaked));
    return *prepared_;
}

// The rasterizer places probes and shadow maps for the camera that the scene has when it is prepared.
const raster::RasterScene& PageSession::raster_scene() {
    Prepared& scene = prepared();
    if (!scene.raster) {
        scene.scene.camera = document().camera();
        raster::RasterSettings settings = whole_image_.raster;
        settings.shading = raster::Shading::kLit; // other shadings can be chosen without preparing anew
        scene.raster = raster::prepare(scene.scene, settings);
    }
    return *scene.raster;
}

const raytrace::PathTracerScene& PageSession::path_tracer_scene() {
    Prepared& scene = prepared();
    if (!scene.raytrace) scene.raytrace = raytrace::prepare(scene.scene, whole_image_.raytrace);
    return *scene.raytrace;
}

View PageSession::view() { return {document().camera(), size_.width, size_.height}; }

Ray PageSession::ray_through(const Json& pixel) {
    const auto center = [&](std::size_t axis) { return std::floor(pixel.at(axis).get<double>()) + 0.5; };
    return CameraModel(view()).ray({center(0), center(1)});
}

// Returns the bounds of an element of "objects"; empty for any other path.
Box3 PageSession::bounds_of(const JsonPath& path) {
    if (path.size() != 2 || path[0] != "objects") return {};
    return entry_bounds(prepared().scene, std::stoul(path[1]));
}

// Replaces the scene by that of the document's new text, or by none yet, and drops the results of the previous scene.
void PageSession::scene_changed(std::unique_ptr<Prepared> scene) {
    render_.reset(); // render_ refers to the previous scene
    prepared_ = std::move(scene);
    hits_ = {};
}

// Returns all quantities that both pipelines can render separately, by plan_rungs().
std::vector<RungRenderers> PageSession::quantities() {
    return color_quantities(prepared().scene,
                            {raster_scene(), whole_image_.raster, path_tracer_scene(), whole_image_.raytrace});
}

// Returns the settings of the quantity. Throws Error for an unknown one.
PageSession::Settings PageSession::settings_of(const std::string& quantity) {
    if (quantity == kWholeImage) return whole_image_;
    for (const RungRenderers& renderers : quantities())
        if (renderers.name == quantity) return {renderers.raster_settings, renderers.raytrace_settings};
    throw Error(message("the scene has no quantity ", quantity));
}

// Returns the mean of the film's image, with the weight `part`, and other_image().
ImageRgb PageSession::mean_of_all(float part) {
    ImageRgb image = render_->film().image();
    if (part == 1) return image;
    if (image.width() != other_image_.width() || image.height() != other_image_.height())
        throw Error("the images differ in size");
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = image[i] * part + other_image_[i] * (1 - part);
    return image;
}

// Returns a description of the scene for the page's panel.
Json PageSession::state() {
    const SceneDocument& scene = document();
    return {{"file", scene.path().filename().string()},
            {"folder", scene.path().parent_path().string()},
            {"scene", scene.json()},
            {"editable", scene.editable()},
            {"changed", scene.changed()},
            {"width", scene.image_size().width},
            {"height", scene.image_size().height},
            {"quantity", quantity_},
            {"shading", raster::kShadings.name(whole_image_.raster.shading)},
            {"integrator", raytrace::integrator_name(whole_image_.raytrace.integrator)},
            {"exposure", std::round(static_cast<double>(view_transform_.exposure) * 1000) / 1000},
            {"tone", kTones.name(view_transform_.tone)}};
}

// Computes the bytes of the image that the page shows, and returns the image's size.
Json PageSession::shown() {
    bytes_ = display_bytes(image_, view_transform_, 1);
    return {{"width", image_.width()}, {"height", image_.height()}};
}

} // namespace duet::compare
