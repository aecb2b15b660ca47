// This file exports a scene in a form from which a Blender script (compare/peers/blender/main.py) can rebuild it.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

/// Holds the peer's render settings.
struct ExportSettings {
    int depth = 64;  ///< maximum number of scattering events; at least 1
    int threads = 1; ///< threads of the peer
};

/// Lists what an export could not represent exactly, in one sentence each.
using ExportNotes = std::vector<std::string>;

/// Writes scene.json, geometry.bin (meshes in world space as the path tracer uses them) and images (linear EXR) to an
/// existing folder. Throws an Error that names any feature without a counterpart: noise textures, motion while the
/// shutter is open, spot lights wider than a half-space, depth 0, and others.
ExportNotes export_scene(const std::filesystem::path& folder, const Scene& scene, const View& view,
                         const ExportSettings& settings);

} // namespace duet::compare
