// This file converts the faces of an OBJ file to a mesh. Corners with the same three indices become one vertex, and
// polygons become triangles.
#pragma once

#include "common/geometry/shape.h"
#include "common/scene/obj/obj_check.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace duet {

/// An ObjMeshBuilder receives the elements in the order of the file. Indices are those of the file: they count from
/// 1, negative ones count back from the last element so far, and 0 means none.
///
/// In a mesh with uvs, corners without a uv get (0, 0). In a mesh with normals, corners without a normal or with a
/// zero normal get their face's normal. A face with fewer than three distinct vertices has no triangles and is
/// counted as degenerate.
class ObjMeshBuilder {
public:
    /// `normals` selects whether the file's normals are used.
    ObjMeshBuilder(const std::filesystem::path& path, const ObjCounts& counts, bool normals);

    void add_position(Vec3 p) { positions_.push_back(p); }
    /// Adds a normal of any length, also zero.
    void add_normal(Vec3 n);
    void add_uv(Vec2 uv) { uvs_.push_back(uv); }
    void begin_face(std::uint16_t slot) { slots_.push_back(slot); }
    /// Adds a corner to the face. Throws Error for an index that is out of range, and for a corner without a position.
    void add_corner(int position, int uv, int normal);
    void end_face() { face_ends_.push_back(corners_.size()); }

    /// Returns the mesh, and sets the number of omitted faces. Throws Error where no face has a triangle.
    Mesh finish(std::size_t& degenerate_faces);

private:
    static constexpr std::uint32_t kNone = ~0u;
    struct Corner {
        std::uint32_t position, uv, normal; ///< indices from 0, or kNone
        friend bool operator==(const Corner&, const Corner&) = default;
    };

    std::uint32_t resolve(int index, std::size_t so_far, std::size_t total) const;
    bool add_face(std::vector<Corner>& face, std::uint16_t slot);
    void use_face_normal(std::vector<Corner>& face);
    std::uint32_t vertex(const Corner& corner);
    std::size_t find(const Corner& corner) const;
    void grow_table();

    const std::filesystem::path* path_;
    ObjCounts counts_;
    bool normals_wanted_;
    std::vector<Vec3> positions_, normals_;
    std::vector<Vec2> uvs_;
    std::vector<Corner> corners_;
    std::vector<std::size_t> face_ends_; ///< indices into corners_
    std::vector<std::uint16_t> slots_;
    bool any_uv_ = false, any_normal_ = false;

    std::vector<Vec3> polygon_; ///< polygon of the current face
    std::vector<std::array<std::uint32_t, 3>> triangulation_;
    std::vector<Corner> vertices_;
    /// This is a hash table of indices into vertices_ with open addressing. Its size is a power of two.
    std::vector<std::uint32_t> table_;
    Mesh mesh_;
};

} // namespace duet
