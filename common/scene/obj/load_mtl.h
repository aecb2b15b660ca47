// This file reads Wavefront MTL files, with the PBR extension, and maps their materials to Duet's. models/README.md
// has the table.
#pragma once

#include "common/image/channel_selection.h"
#include "common/material/material.h"
#include "common/material/surface_maps.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace duet {

/// An ObjTexture is an image that a material uses.
struct ObjTexture {
    std::filesystem::path file;
    Vec2 scale{1, 1};
    ChannelSelection selection{};
};

/// An MtlMaterial is a material of an MTL file with the images that it uses.
struct MtlMaterial {
    Material material; ///< its texture references are indices into `textures`
    SurfaceMaps maps;  ///< its texture references are indices into `textures`
    std::vector<ObjTexture> textures;
};

/// Adds the materials of an MTL file by name; the first of each name wins. Throws Error with path and line for
/// malformed numbers, and for a missing file.
void load_mtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials);

} // namespace duet
