// This file reads the textures of scene files.
#pragma once

#include "common/image/channel_selection.h"
#include "common/scene/json/json_reader.h"
#include "common/scene/scene.h"

#include <filesystem>
#include <map>
#include <string>

namespace duet {

class FileCache; // common/scene/file_cache.h

/// An ImageCache loads the images of a scene and stores each only once.
class ImageCache {
public:
    /// With `files`, images come from that cache, which must outlive this one.
    explicit ImageCache(Scene& scene, FileCache* files = nullptr) : scene_(&scene), files_(files) {}
    /// Returns the index in TextureSet::images of the file's image, loading it if necessary. Values are clamped to
    /// [0, 1], because they are reflectances. Throws Error for a file that cannot be read or holds a value that is
    /// not finite.
    std::uint32_t load(const std::filesystem::path& file, ChannelSelection selection = {});

    /// Returns the cache of files, or null if there is none.
    FileCache* files() const { return files_; }

private:
    Scene* scene_;
    FileCache* files_;
    std::map<std::string, std::uint32_t> index_; ///< index by canonical path and selection
};

/// Returns the path for a name in the file `owner`. Relative names are relative to the owner's folder.
std::filesystem::path resolve_path(const std::filesystem::path& owner, const std::string& name);
/// Returns a key that is equal for different paths of the same file.
std::string canonical_key(const std::filesystem::path& path);

using NameIndex = std::map<std::string, std::uint32_t>;

/// Appends the textures of {"name": {…}, …} to the scene. Returns their indices by name.
NameIndex read_textures(const JsonValue& textures, Scene& scene, ImageCache& images);
/// Returns the index for a name. Throws Error with a suggestion where the name is unknown. `what` is "material" or
/// "texture", for the message.
std::uint32_t look_up(const JsonValue& name, const NameIndex& index, std::string_view what);

} // namespace duet
