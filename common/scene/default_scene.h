// This file builds a default scene around a single mesh, which `raster mesh.obj` renders.
#pragma once

#include "common/scene/scene.h"

namespace duet {

/// UpAxis is the axis of a mesh file that points up in the scene. kGuessed is z if the mesh stands on a flat side there
/// and not in y, as models of scanners and CAD programs do; otherwise it is y.
enum class UpAxis { kGuessed, kX, kY, kZ };

/// Returns a scene with the mesh, a ground just below it, a sky and a sun. Faces without an MTL material are clay,
/// and missing normals are computed (smooth_normals.h). The camera looks at the mesh from the front, right and above,
/// and all of the mesh and of its shadow is in the image. finish_scene has not been called yet. Throws Error as
/// load_obj does.
Scene default_scene_for_mesh(const std::filesystem::path& path, UpAxis up = UpAxis::kGuessed);

/// Loads a scene like load_scene(path). Throws Error if `up` is given and the file is not a bare mesh.
Scene load_scene(const std::filesystem::path& path, UpAxis up);

} // namespace duet
