// This file defines the options with which all programs load a scene.
#pragma once

#include "common/image/stored_image.h"
#include "common/scene/default_scene.h"

namespace duet {

/// SceneOptions say how a scene is loaded.
struct SceneOptions {
    ImageSize size{0, 0}; ///< 0 × 0: the scene's
    UpAxis up = UpAxis::kGuessed;
};

/// Loads a scene like load_scene(path). Preparation depends on the size: the rasterizer renders no shadow map finer
/// than the image can show.
Scene load_scene(const std::filesystem::path& path, const SceneOptions& options);

} // namespace duet
