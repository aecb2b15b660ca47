// This file builds a default scene around a single mesh, which `raster mesh.obj` renders.
#pragma once

#include "common/scene/scene.h"

namespace duet {

/// Returns a scene with the mesh, a ground just below it, a sky and a sun. Faces without an MTL material are clay,
/// and missing normals are computed (smooth_normals.h). The camera looks at the mesh from the front, right and above,
/// and all of the mesh is in the image. finish_scene has not been called yet. Throws Error as load_obj does.
Scene default_scene_for_mesh(const std::filesystem::path& path);

} // namespace duet
