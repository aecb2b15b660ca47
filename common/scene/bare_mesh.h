// A scene around a mesh that comes alone: what `raster mesh.obj` shows.
#pragma once

#include "common/scene/scene.h"

namespace duet {

/// The mesh with its MTL materials (clay where it has none) and normals (computed where it has none: smooth_normals.h),
/// a ground just below it, a sky and a sun; the camera looks at it from the front, right and above, and all of it is in
/// the picture. Not finished yet. Throws Error as load_obj does.
Scene scene_around_mesh(const std::filesystem::path& path);

} // namespace duet
