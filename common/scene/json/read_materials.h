// Textures and materials of scene files.
#pragma once

#include "common/image/image_content.h"
#include "common/scene/json/json_reader.h"
#include "common/scene/scene.h"

#include <filesystem>
#include <map>
#include <string>

namespace duet {

/// The images of a scene, each stored once however often it is used.
class ImageCache {
public:
    explicit ImageCache(Scene& scene) : scene_(&scene) {}
    /// The index in TextureSet::images of the file's picture, its values limited to [0, 1] (it is a reflectance).
    /// Throws Error for a file that read_image refuses or that holds NaN.
    std::uint32_t load(const std::filesystem::path& file, ImageContent content = {});

private:
    Scene* scene_;
    std::map<std::string, std::uint32_t> index_; ///< by canonical path and content
};

/// The path a name in `owner` stands for: relative names are relative to the owner's folder.
std::filesystem::path beside(const std::filesystem::path& owner, const std::string& name);
/// A key that is equal for two paths of one file.
std::string canonical_key(const std::filesystem::path& path);

using NameIndex = std::map<std::string, std::uint32_t>;

/// Appends the textures of {"name": {…}, …} to the scene; their indices by name.
NameIndex read_textures(const JsonValue& textures, Scene& scene, ImageCache& images);
/// Appends the materials; their indices by name.
NameIndex read_materials(const JsonValue& materials, const NameIndex& textures, Scene& scene);
/// The index a name stands for; Error with a suggestion where it is unknown. `what`: "material", "texture".
std::uint32_t look_up(const JsonValue& name, const NameIndex& index, std::string_view what);

} // namespace duet
