// What `compare frames` draws: a mesh under one light, seen whole or close up.
#pragma once

#include "common/scene/scene.h"

#include <filesystem>
#include <string>

namespace duet::compare {

enum class FrameView {
    kWhole, ///< all of the mesh
    kClose, ///< so close that it fills most of the picture
};
const char* name(FrameView view);

/// The mesh alone, with smooth normals where its file has none, in one diffuse colour, under a sun and a faint ambient
/// light. With a picture (`texture` not empty) as its base colour instead, looked up by the mesh's texture coordinates.
/// Throws Error as load_scene does, and for a file that is no mesh.
Scene frame_scene(const std::filesystem::path& mesh, const std::filesystem::path& texture = {});
View frame_view(const Scene& scene, FrameView view, int width, int height);

} // namespace duet::compare
