// This file builds the scene that `compare frames` draws: a mesh under one light, seen whole or close up.
#pragma once

#include "common/program/command_line.h"
#include "common/scene/scene.h"

#include <filesystem>
#include <string>

namespace duet::compare {

enum class FrameView {
    kWhole, ///< the whole mesh is visible
    kClose, ///< so close that the mesh fills most of the image
};
/// Returns the name in tables, "whole" or "close".
const char* name(FrameView view);

/// Returns a scene of the mesh alone, in one diffuse color, under a sun and a faint ambient light. Smooth
/// normals are computed if the file has none. If `texture` is not empty, that image is the base color, sampled
/// by the mesh's texture coordinates. Throws Error as load_scene does, and for a file that is not a mesh.
Scene frame_scene(const std::filesystem::path& mesh, const std::filesystem::path& texture = {});
/// Returns a view of the mesh from above and to the right, of the given size in pixels.
View frame_view(const Scene& scene, FrameView view, ImageSize size);

} // namespace duet::compare
