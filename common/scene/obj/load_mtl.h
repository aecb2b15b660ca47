// MTL files: Wavefront materials, with the PBR extension, mapped to ours. models/README.md has the table.
#pragma once

#include "common/scene/obj/load_obj.h"

#include <map>
#include <string>
#include <vector>

namespace duet {

/// A material of an MTL file and the pictures it asks for.
struct MtlMaterial {
    Material material; ///< its references to textures index `textures`
    SurfaceMaps maps;  ///< likewise
    std::vector<ObjTexture> textures;
};

/// Adds the materials of an MTL file by name; the first of a name stands. Throws Error with path and line for malformed
/// numbers, and for a file that is missing.
void load_mtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials);

} // namespace duet
