// This file implements the commands of a PageSession.
#include "compare/web/page_session.h"

#include "common/system/error.h"
#include "common/system/stopwatch.h"
#include "common/system/suggestion.h"
#include "compare/view/camera_control.h"
#include "compare/view/edits.h"
#include "compare/view/inspect.h"
#include "raster/shading/built_in_shaders.h"
#include "raytrace/pixel_debug.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace duet::compare {

using Json = nlohmann::ordered_json;

namespace {

/// The first image after a change has this fraction of the width, and one sample per pixel.
constexpr double kPreviewScale = 0.25;
/// A side of an image has at most this many pixels.
constexpr int kMaxSide = 4096;

JsonPath path_of(const Json& command) { return command.at("path").get<JsonPath>(); }
Vec3d vector_of(const Json& v) { return {v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()}; }

/// Returns the map that turns and scales about a point: {"axis": 0 to 2, "degrees": …} or {"factor": …}.
Mat4d map_about(Vec3d center, const Json& command) {
    const Mat4d there = translation(center), back = translation(-center);
    if (command.contains("factor")) {
        const auto factor = command.at("factor").get<double>();
        return there * scaling(Vec3d(factor, factor, factor)) * back;
    }
    Vec3d axis;
    axis[command.at("axis").get<std::size_t>() % 3] = 1;
    return there * rotation(axis, radians(command.at("degrees").get<double>())) * back;
}

/// Returns the value of an image at a pixel that is given for the full size. The image may be smaller.
template <typename T> const T& at_pixel(const Image<T>& image, const Json& pixel, ImageSize full) {
    const auto index = [&](std::size_t axis, int size, int full_size) {
        return std::clamp(static_cast<int>(pixel.at(axis).get<double>() * size / full_size), 0, size - 1);
    };
    return image(index(0, image.width(), full.width), index(1, image.height(), full.height));
}

} // namespace

// Each function carries out a command and takes the members that its comment names in braces.
struct PageCommands {
    using Session = PageSession;

    // {"file"}: opens a file, by its path in the page's file system
    static Json open(Session& s, const Json& command) {
        SceneDocument opened(command.at("file").get<std::string>(), SceneOptions());
        s.document_ = std::move(opened);
        s.size_ = s.document_->image_size();
        s.view_transform_ = s.document_->view_transform();
        s.scene_changed(nullptr);
        s.image_ = {};
        s.quantity_ = kWholeImage;
        s.settings_ = s.whole_image_;
        return s.state();
    }
    static Json state(Session& s, const Json&) { return s.state(); }
    // {"width", "height"}: sets the size of the images, in pixels
    static Json size(Session& s, const Json& command) {
        const auto side = [&](const char* name) { return std::clamp(command.at(name).get<int>(), 1, kMaxSide); };
        s.size_ = {side("width"), side("height")};
        s.render_.reset();
        if (!s.prepared_) return {};
        s.prepared_->raster.reset(); // shadow maps are as fine as the image can show
        s.prepared_->scene.width = s.size_.width;
        s.prepared_->scene.height = s.size_.height;
        return {};
    }
    // {"exposure"} or {"tone"}: changes the view transform of the image
    static Json display(Session& s, const Json& command) {
        if (command.contains("tone")) s.view_transform_.tone = kTones.value(command["tone"].get<std::string>());
        if (command.contains("exposure"))
            s.view_transform_.exposure = std::clamp(command["exposure"].get<float>(), -kMaxExposure, kMaxExposure);
        return s.shown();
    }

    // {"orbit", "look", "pan": [right, up]}, {"dolly": factor}, {"fly": [forward, right, up]}, {"focus": [x, y] of a
    // pixel}, {"frame": entry of "objects", or −1 for the whole scene}: moves the camera by one or more of these.
    // "commit" ends a step of undo.
    static Json camera(Session& s, const Json& command) {
        Camera camera = s.document().camera();
        const auto two = [&](const char* name, Camera (*move)(Camera, double, double)) {
            if (command.contains(name)) camera = move(camera, command[name].at(0), command[name].at(1));
        };
        two("orbit", orbit);
        two("look", look_around);
        two("pan", [](Camera c, double right, double up) { return pan(c, right, up); });
        if (command.contains("dolly")) camera = dolly(camera, command["dolly"]);
        if (command.contains("fly")) {
            const Vec3d by = vector_of(command["fly"]);
            camera = fly(camera, by.x, by.y, by.z);
        }
        if (command.contains("focus")) {
            const Ray ray = s.ray_through(command["focus"]);
            const Hit hit = raytrace::trace(s.path_tracer_scene(), ray);
            if (hit.valid())
                camera = look_at_point(camera, Vec3d(ray.origin) + static_cast<double>(hit.t) * Vec3d(ray.direction));
        }
        if (command.contains("frame")) {
            const int entry = command["frame"];
            const Scene& scene = s.prepared().scene;
            camera = frame_box(camera, entry < 0 ? scene.bounds : s.bounds_of({"objects", std::to_string(entry)}),
                               static_cast<double>(s.size_.width) / s.size_.height);
        }
        const bool moved = !(camera == s.document().camera());
        if (moved) {
            s.document().set_camera(camera);
            s.render_.reset();
        }
        const bool commits = command.value("commit", false);
        if (commits) s.document().commit();
        Json result = commits ? s.state() : Json();
        result["moved"] = moved;
        return result;
    }

    // Replaces the text by edit(text).
    template <typename Edit> static Json edited(Session& s, const Edit& edit) {
        SceneDocument& document = s.document();
        if (!document.editable()) throw Error("a bare mesh has no scene file that could be edited");
        const std::string text = edit(document.text());
        Scene scene = document.parsed(text); // refuses a text that is no valid scene, before anything has changed
        document.commit();
        document.set_text(text);
        document.commit();
        s.scene_changed(s.unprepared(std::move(scene)));
        return s.state();
    }
    // {"path", "value"}: sets a value of the scene file
    static Json set(Session& s, const Json& command) {
        return edited(s,
                      [&](const std::string& text) { return with_value(text, path_of(command), command.at("value")); });
    }
    // {"path"}: removes an element of a list
    static Json remove(Session& s, const Json& command) {
        return edited(s, [&](const std::string& text) { return without_value(text, path_of(command)); });
    }
    static Json duplicate(Session& s, const Json& command) {
        return edited(s, [&](const std::string& text) { return duplicated(text, path_of(command)); });
    }
    // {"path", "by": [x, y, z]}: moves an element of "objects" or "lights" by a vector. {"path", "right", "up",
    // "pixel": [x, y]}: moves it parallel to the image by fractions of the image's height, so that the surface point at
    // this pixel follows the pointer.
    static Json move(Session& s, const Json& command) {
        const JsonPath path = path_of(command);
        Vec3d by;
        if (command.contains("by")) {
            by = vector_of(command["by"]);
        } else {
            const Ray ray = s.ray_through(command.at("pixel"));
            const Hit hit = raytrace::trace(s.path_tracer_scene(), ray);
            if (!hit.valid()) throw Error("there is no object at this pixel");
            // The camera is set to look at the depth of the point, because pan() moves by the height of the visible
            // region there.
            Camera camera = s.document().camera();
            const Vec3d forward = normalize(camera.look_at - camera.eye);
            const Vec3d point = Vec3d(ray.origin) + static_cast<double>(hit.t) * Vec3d(ray.direction);
            camera.look_at = camera.eye + forward * dot(point - camera.eye, forward);
            by = pan(camera, command.at("right"), command.at("up")).eye - camera.eye;
        }
        return edited(s, [&](const std::string& text) { return moved(text, path, by); });
    }
    // {"path", "axis", "degrees"} or {"path", "factor"}: turns or scales an element of "objects" about its center
    static Json transform(Session& s, const Json& command) {
        const JsonPath path = path_of(command);
        const Mat4d map = map_about(Vec3d(s.bounds_of(path).center()), command);
        return edited(s, [&](const std::string& text) { return transformed(text, path, map); });
    }
    // {"what": a name of kNewElementNames}: adds an element at the camera's look-at point. {"mesh"}: adds the mesh of a
    // file, named by its path from the scene's folder.
    static Json add(Session& s, const Json& command) {
        if (command.contains("mesh"))
            return edited(s, [&](const std::string& text) { return with_new_mesh(text, command["mesh"]); });
        const auto what = command.at("what").get<std::string>();
        const auto element =
            static_cast<NewElement>(name_index("what", what, {kNewElementNames.begin(), kNewElementNames.end()}));
        const Camera camera = s.document().camera();
        const double size = shown_height(camera, length(camera.look_at - camera.eye)) / 5;
        return edited(s,
                      [&](const std::string& text) { return with_new_element(text, element, camera.look_at, size); });
    }
    // {"back"}: undoes a step if `back` is true, and else redoes one
    static Json undo(Session& s, const Json& command) {
        const bool back = command.at("back").get<bool>();
        SceneDocument& document = s.document();
        const auto step = [&](bool to) { return to ? document.undo() : document.redo(); };
        const std::string before = document.text();
        if (!step(back)) throw Error(back ? "nothing to undo" : "nothing to redo");
        if (document.text() != before) s.scene_changed(nullptr);
        s.render_.reset();
        return s.state();
    }
    // Saves the scene in the page's file system. The result has its path as "saved".
    static Json save(Session& s, const Json&) {
        s.document().save();
        Json result = s.state();
        result["saved"] = s.document().path().string();
        return result;
    }

    // {"quantity"}, {"shading"} or {"integrator"}: chooses what is rendered
    static Json choose(Session& s, const Json& command) {
        const Session::Settings before = s.whole_image_;
        const std::string quantity = command.value("quantity", s.quantity_);
        try {
            if (command.contains("shading"))
                s.whole_image_.raster.shading = raster::kShadings.value(std::string(command["shading"]));
            if (command.contains("integrator"))
                s.whole_image_.raytrace.integrator = raytrace::integrator(std::string(command["integrator"]));
            s.settings_ = s.settings_of(quantity);
        } catch (...) {
            s.whole_image_ = before;
            throw;
        }
        s.quantity_ = quantity;
        s.render_.reset();
        return s.state();
    }
    // Returns the names that choose() and add() know.
    static Json choices(Session&, const Json&) {
        Json integrators = Json::array();
        for (const auto integrator : kIntegrators) integrators.push_back(raytrace::integrator_name(integrator));
        return {{"shadings", raster::kShadings.names()},
                {"integrators", integrators},
                {"tones", kTones.names()},
                {"additions", kNewElementNames}};
    }

    // Returns the names of the quantities that choose() knows for this scene.
    static Json quantities(Session& s, const Json&) {
        Json names = Json::array();
        for (const RungRenderers& quantity : s.quantities()) names.push_back(quantity.name);
        return {{"quantities", names}};
    }

    // {"scale", "rest"}: renders with the rasterizer, at a fraction of the width. At rest, the scene is prepared for
    // this camera and has more samples. A scene that is not prepared yet is first shown in Phong shading, which needs
    // no probes.
    static Json raster(Session& s, const Json& command) {
        Session::Prepared& scene = s.prepared();
        const bool rest = command.value("rest", true);
        if (rest && !(scene.scene.camera == s.document().camera())) scene.raster.reset();
        raster::RasterSettings settings = s.settings_.raster;
        if (!rest) settings.samples_per_pixel = 1;
        const bool preview = !rest && !scene.raster;
        if (preview && settings.shading == raster::Shading::kLit) settings.shading = raster::Shading::kPhong;
        const raster::RasterScene ready = preview ? raster::prepare(scene.scene, settings) : s.raster_scene();
        Control control;
        const Stopwatch watch;
        Rendering rendering = render(ready, scaled(s.view(), command.value("scale", 1.0)), settings, control);
        const double seconds = watch.seconds();
        s.image_ = std::move(rendering.radiance);
        s.hits_ = std::move(rendering.hit);
        Json result = s.shown();
        result["seconds"] = seconds;
        result["preview"] = preview;
        for (const auto& [stage, time] : rendering.statistics.seconds) result["stages"][stage] = time;
        return result;
    }
    // {"seconds", "preview", "others"}: adds samples for about this time. With `preview`, the first image after a
    // change is small. `others` is the number of samples of other_image(); if it is not 0, the image is the mean of all
    // samples.
    static Json trace(Session& s, const Json& command) {
        const raytrace::PathTracerScene& ready = s.path_tracer_scene();
        Control control;
        const bool starts = !s.render_, preview = starts && command.value("preview", true);
        if (preview) {
            raytrace::ProgressiveRender small(ready, scaled(s.view(), kPreviewScale), s.settings_.raytrace);
            small.add_samples(1, control);
            s.image_ = small.film().image();
        }
        if (starts) {
            s.render_ = std::make_unique<raytrace::ProgressiveRender>(ready, s.view(), s.settings_.raytrace);
            s.samples_ = 0;
            s.seconds_ = 0;
        }
        if (!preview && s.samples_ < PageSession::kMaxSamples) {
            const double per_sample = s.samples_ > 0 ? s.seconds_ / s.samples_ : 0;
            const double fitting = per_sample > 0 ? command.at("seconds").get<double>() / per_sample : 1;
            const auto more = static_cast<std::uint32_t>(
                std::clamp(std::floor(fitting), 1.0, std::min<double>(PageSession::kMaxSamples - s.samples_, 16)));
            const Stopwatch watch;
            s.render_->add_samples(more, control);
            s.samples_ += more;
            s.seconds_ += watch.seconds();
        }
        const std::uint32_t all = s.samples_ + (s.samples_ > 0 ? command.value("others", 0u) : 0);
        if (s.samples_ > 0) s.image_ = s.mean_of_all(static_cast<float>(s.samples_) / static_cast<float>(all));
        Json result = s.shown();
        result["samples"] = all;
        result["own"] = s.samples_; // without those of other_image()
        result["seconds"] = s.seconds_;
        result["finished"] = s.samples_ >= PageSession::kMaxSamples;
        if (s.samples_ > 0) result["relmse"] = s.render_->film().estimated_relmse() * s.samples_ / all;
        return result;
    }

    // {"pixel": [x, y]}: returns the value, what was hit, and the material
    static Json inspect(Session& s, const Json& command) {
        const Scene& scene = s.prepared().scene;
        Json result;
        if (!s.image_.empty()) result["color"] = color_text(at_pixel(s.image_, command.at("pixel"), s.size_));
        const bool rasterized = s.pipeline_ == Session::Pipeline::kRaster;
        if (rasterized && s.hits_.empty()) return result;
        const Hit hit = rasterized ? at_pixel(s.hits_, command.at("pixel"), s.size_)
                                   : raytrace::trace(s.path_tracer_scene(), s.ray_through(command.at("pixel")));
        result["hit"] = hit_text(scene, hit);
        if (hit.valid()) result["material"] = material_text(scene, hit);
        if (hit.valid()) result["entry"] = scene.objects[hit.object].entry;
        return result;
    }
    // {"pixel": [x, y]}: returns what happens along a path, as lines of text
    static Json path(Session& s, const Json& command) {
        const auto at = [&](std::size_t axis) { return static_cast<int>(command.at("pixel").at(axis).get<double>()); };
        return {
            {"text", raytrace::debug_pixel(s.path_tracer_scene(), s.view(), s.settings_.raytrace, {at(0), at(1), 0})}};
    }
    // {"show": "difference" or "FLIP"}: compares this image with other_image()
    static Json compare(Session& s, const Json& command) {
        const bool flip = command.at("show").get<std::string>() == "FLIP";
        if (s.image_.width() != s.other_image_.width() || s.image_.height() != s.other_image_.height())
            throw Error("the images differ in size");
        ImageComparison images = flip ? flip_comparison(s.other_image_, s.image_, s.view_transform_, 1)
                                      : signed_comparison(s.other_image_, s.image_, 1);
        s.bytes_ = std::move(images.bytes);
        return {{"width", s.image_.width()}, {"height", s.image_.height()}, {"figure", images.figure}};
    }
};

Json PageSession::call(const Json& command) {
    using Function = Json (*)(PageSession&, const Json&);
    static const std::map<std::string, Function> kCommands{
        {"open", PageCommands::open},       {"state", PageCommands::state},
        {"size", PageCommands::size},       {"display", PageCommands::display},
        {"camera", PageCommands::camera},   {"set", PageCommands::set},
        {"remove", PageCommands::remove},   {"duplicate", PageCommands::duplicate},
        {"move", PageCommands::move},       {"transform", PageCommands::transform},
        {"add", PageCommands::add},         {"undo", PageCommands::undo},
        {"save", PageCommands::save},       {"choose", PageCommands::choose},
        {"choices", PageCommands::choices}, {"quantities", PageCommands::quantities},
        {"raster", PageCommands::raster},   {"trace", PageCommands::trace},
        {"inspect", PageCommands::inspect}, {"path", PageCommands::path},
        {"compare", PageCommands::compare}};
    try {
        const auto found = kCommands.find(command.at("do").get<std::string>());
        if (found == kCommands.end()) throw Error(message("unknown command ", command.at("do").dump()));
        const Json answer = found->second(*this, command);
        return answer.is_null() ? Json::object() : answer;
    } catch (const std::exception& error) {
        return {{"error", error.what()}};
    }
}

} // namespace duet::compare
