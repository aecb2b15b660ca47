#include "common/program/scene_options.h"

namespace duet {

Scene load_scene(const std::filesystem::path& path, const SceneOptions& options) {
    Scene scene = load_scene(path, options.up);
    if (options.size.width > 0) scene.width = options.size.width, scene.height = options.size.height;
    return scene;
}

} // namespace duet
