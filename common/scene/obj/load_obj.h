// Meshes from Wavefront OBJ files, with the materials of their MTL files. models/README.md says what is read and how.
#pragma once

#include "common/geometry/shape.h"
#include "common/image/image_content.h"
#include "common/material/material.h"
#include "common/material/surface_maps.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace duet {

enum class MeshNormals {
    kFile,   ///< as the file gives them; flat where it gives none
    kFlat,   ///< none: each triangle its own
    kSmooth, ///< computed, the file's ignored (smooth_normals.h)
    kAuto,   ///< the file's, or computed where it gives none
};

struct ObjOptions {
    MeshNormals normals = MeshNormals::kFile;
    bool materials = true; ///< false: no MTL file is read, and the mesh has one material slot
};

/// A picture that a material asks for.
struct ObjTexture {
    std::filesystem::path file;
    Vec2 scale{1, 1};
    ImageContent content{};
};

struct ObjMaterial {
    std::string name;
    Material material; ///< its references to textures index ObjFile::textures, to be mapped to the scene's
    SurfaceMaps maps{}; ///< likewise
};

struct ObjFile {
    Mesh mesh;                          ///< all groups and objects of the file; Mesh::closed is not set yet
    std::vector<ObjMaterial> materials; ///< one a material slot, in order of first use; at least one. Faces without a
                                        ///< material use the one named "" (default_obj_material)
    std::vector<ObjTexture> textures;
    std::vector<std::filesystem::path> files; ///< the OBJ file, then the MTL files that were read
    std::size_t degenerate_faces = 0; ///< left out: fewer than three different vertices
};

/// What a face without a material is made of: a clay-like diffuse.
Material default_obj_material();

/// Reads an OBJ file. Throws Error, with the line where there is one, for: a file that cannot be read, of more than 4
/// GiB or not text; a number that is malformed, not finite or beyond 1e18; an index of no vertex; a face of fewer than
/// three corners; no face at all; a concave face of more than kMaxConcaveCorners corners; a material of an MTL file
/// that is missing or does not have it.
ObjFile load_obj(const std::filesystem::path& path, const ObjOptions& options = {});

} // namespace duet
