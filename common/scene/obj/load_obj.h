// This file reads meshes from Wavefront OBJ files, with the materials of their MTL files. models/README.md describes
// which parts of the formats are read.
#pragma once

#include "common/geometry/shape.h"
#include "common/scene/obj/load_mtl.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace duet {

enum class MeshNormals {
    kFile,   ///< the file's normals; flat shading where it has none
    kFlat,   ///< no vertex normals: flat shading
    kSmooth, ///< computed normals; the file's are ignored (smooth_normals.h)
    kAuto,   ///< the file's normals; computed where it has none
};

/// Selects what load_obj takes from the files.
struct ObjOptions {
    MeshNormals normals = MeshNormals::kFile;
    bool materials = true; ///< false: no MTL file is read, and the mesh has one material slot
};

/// Holds a material of the MTL files, converted.
struct ObjMaterial {
    std::string name;
    Material material; ///< texture references are indices into ObjFile::textures, to be remapped to the scene's
    SurfaceMaps maps{}; ///< texture references are indices into ObjFile::textures
};

/// Holds what load_obj returns.
struct ObjFile {
    Mesh mesh;                          ///< all groups and objects of the file; Mesh::closed is not set
    /// There is one material per slot, in order of first use, and at least one. Faces without a material use the one
    /// named "" (default_obj_material).
    std::vector<ObjMaterial> materials;
    std::vector<ObjTexture> textures;
    std::vector<std::filesystem::path> files; ///< the OBJ file, then the MTL files read
    std::size_t degenerate_faces = 0; ///< number of omitted faces of fewer than three distinct vertices
};

/// Returns the material of faces without a material, a clay-like diffuse.
Material default_obj_material();

/// Reads an OBJ file. Throws Error, with the line number where there is one, in these cases:
/// - The file cannot be read, is larger than 4 GiB, or is not text.
/// - A number is malformed, not finite, or beyond 1e18.
/// - An index refers to no vertex.
/// - A face has fewer than three corners, or there is no face at all.
/// - A concave face has more than kMaxConcaveCorners corners.
/// - A used material is not in the MTL files, or its MTL file is missing.
ObjFile load_obj(const std::filesystem::path& path, const ObjOptions& options = {});

} // namespace duet
