#include "compare/view/document.h"

#include "common/image/image_file.h"
#include "common/system/error.h"
#include "common/system/file.h"
#include "compare/view/scene_text.h"

#include <array>
#include <utility>

namespace duet::compare {

using nlohmann::ordered_json;

SceneDocument::SceneDocument(std::filesystem::path path, const SceneOptions& options)
    : path_(std::move(path)), options_(options) {
    reload();
}

void SceneDocument::reload() {
    const bool editable_file = lower_case_extension(path_) == ".json" && options_.up == UpAxis::kGuessed;
    const auto cache = std::make_shared<FileCache>(); // a reader on another thread may still use the previous cache
    std::string file = editable_file ? read_file(path_, kMaxSceneBytes) : "";
    const auto scene = std::make_shared<const Scene>(editable_file ? parse_scene(path_, file, *cache)
                                                             : load_scene(path_, options_)); // a bare mesh; else throws
    cache_ = cache;
    states_.assign(1, State{std::make_shared<const std::string>(std::move(file)), scene->camera});
    image_size_ = {scene->width, scene->height};
    view_transform_ = scene->view_transform;
    file_scene_ = scene;
    current_ = 0;
    open_ = false;
    saved_ = text();
    parse();
}

void SceneDocument::parse() { json_ = editable() ? ordered_json::parse(text()) : ordered_json(); }

SceneDocument::State& SceneDocument::change() {
    if (!open_) {
        states_.resize(current_ + 1); // drops the steps that were undone
        states_.push_back(states_.back());
        ++current_;
        open_ = true;
    }
    return states_[current_];
}

void SceneDocument::set_camera(const Camera& camera) { change().camera = camera; }

void SceneDocument::set_text(std::string changed) {
    ordered_json json = ordered_json::parse(changed); // may throw; nothing has changed before
    change().text = std::make_shared<const std::string>(std::move(changed));
    json_ = std::move(json);
}

void SceneDocument::commit() { open_ = false; }

bool SceneDocument::undo() {
    open_ = false;
    if (current_ == 0) return false;
    --current_;
    parse();
    return true;
}

bool SceneDocument::redo() {
    open_ = false;
    if (current_ + 1 == states_.size()) return false;
    ++current_;
    parse();
    return true;
}

bool SceneDocument::changed() const {
    return editable() && with_camera(text(), states_.front().camera, now().camera) != saved_;
}

void SceneDocument::save() {
    if (!editable()) throw Error(message(path_.string(), ": a bare mesh has no scene file that could be saved"));
    std::string file = with_camera(text(), states_.front().camera, now().camera);
    write_file(path_, file);
    saved_ = std::move(file);
}

SceneReader SceneDocument::reader() {
    const std::shared_ptr<const Scene> scene = std::exchange(file_scene_, nullptr);
    if (scene && current_ == 0) return [scene](Transforms) { return *scene; };
    if (!editable()) return [path = path_, options = options_](Transforms) { return load_scene(path, options); };
    return [path = path_, file = now().text, cache = cache_](Transforms transforms) {
        return parse_scene(path, *file, *cache, transforms);
    };
}

std::string with_camera(std::string text, const Camera& before, const Camera& camera) {
    const auto set = [&](const char* key, auto value, auto old) {
        if (!(value == old)) text = with_value(text, {"camera", key}, value);
    };
    const auto set_point = [&](const char* key, Vec3d value, Vec3d old) {
        set(key, std::array{value.x, value.y, value.z}, std::array{old.x, old.y, old.z});
    };
    set_point("eye", camera.eye, before.eye);
    set_point("look_at", camera.look_at, before.look_at);
    set("fov_degrees", camera.fov_degrees, before.fov_degrees);
    set("height", camera.height, before.height);
    set("aperture_radius", camera.aperture_radius, before.aperture_radius);
    set("focus_distance", camera.focus_distance, before.focus_distance);
    return text;
}

} // namespace duet::compare
