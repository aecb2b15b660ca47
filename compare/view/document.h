// A SceneDocument is a scene file that is being edited: its text, the camera, and the history of both.
#pragma once

#include "common/program/scene_options.h"
#include "common/scene/file_cache.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace duet::compare {

/// A SceneReader reads a scene. With Transforms::kKept, scenes before and after an edit share their meshes.
using SceneReader = std::function<Scene(Transforms)>;

/// Holds a scene file while it is edited. Edits change the text, so that the rest of it is saved as it was typed. A
/// bare mesh has no text: its camera can be moved, and nothing can be saved.
class SceneDocument {
public:
    /// Reads the file. Throws Error if it cannot be read, or is no valid scene.
    SceneDocument(std::filesystem::path path, const SceneOptions& options);

    const std::filesystem::path& path() const { return path_; }
    bool editable() const { return !text().empty(); }
    const std::string& text() const { return *now().text; }
    /// Returns the parsed text; null for a bare mesh.
    const nlohmann::ordered_json& json() const { return json_; }
    const Camera& camera() const { return now().camera; }
    /// Returns the image size of the file. The next function returns its view transform.
    ImageSize image_size() const { return image_size_; }
    const ViewTransform& view_transform() const { return view_transform_; }

    /// Changes the camera. undo() reverts all changes of camera and text between two calls of commit() in one step.
    void set_camera(const Camera& camera);
    /// Replaces the text, which must be valid JSON.
    void set_text(std::string changed);
    /// Ends the current step of undo(), if one has begun.
    void commit();
    /// Undoes one step. Returns false if there is none.
    bool undo();
    /// Redoes one step. Returns false if there is none.
    bool redo();

    /// Returns whether there is something to save.
    bool changed() const;
    /// Writes the text, with the camera. Throws Error if the file cannot be written, or for a bare mesh.
    void save();
    /// Loads the file again, and clears the history.
    void reload();
    /// Returns a function that builds the scene of the current text. It may be called repeatedly, on any thread.
    SceneReader reader();
    /// Returns the scene of another text for this file, and changes nothing. Throws Error if it is no valid scene.
    Scene parsed(const std::string& text) { return parse_scene(path_, text, *cache_); }

private:
    struct State {
        std::shared_ptr<const std::string> text;
        Camera camera;
    };
    const State& now() const { return states_[current_]; }
    State& change(); // the state that changes apply to
    void parse();

    std::filesystem::path path_;
    SceneOptions options_;
    std::vector<State> states_; // the steps, from the file's state on
    std::size_t current_ = 0;
    bool open_ = false; // whether the current step has not been committed
    std::string saved_; // the text with the camera, as it is in the file
    nlohmann::ordered_json json_;
    ImageSize image_size_{};
    ViewTransform view_transform_;
    std::shared_ptr<FileCache> cache_;
    std::shared_ptr<const Scene> file_scene_; // the scene as reload() has read it; null once reader() has returned it
};

/// Returns the text of a scene file, whose camera is `before`, with another camera. Numbers that are equal stay as they
/// were typed. The projection, the up vector and the shutter of the new camera must be those of `before`.
std::string with_camera(std::string text, const Camera& before, const Camera& camera);

} // namespace duet::compare
