// Our scene in a form that a script in Blender can build it from: compare/peers/cycles.py.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

struct ExportSettings {
    int depth = 64;  ///< scattering events at most; at least 1
    int threads = 1; ///< of the peer
};

/// What an export could not keep exactly, each in a sentence.
using ExportNotes = std::vector<std::string>;

/// Writes scene.json, geometry.bin (meshes in world space as the path tracer sees them) and pictures (linear EXR) into
/// an existing folder. Throws Error that names what has no counterpart: noise textures, motion while the shutter is
/// open, spot lights wider than a half-space, depth 0.
ExportNotes export_scene(const std::filesystem::path& folder, const Scene& scene, const View& view,
                         const ExportSettings& settings);

} // namespace duet::compare
