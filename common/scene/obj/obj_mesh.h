// The faces of an OBJ file become a mesh: corners that agree in all three indices become one vertex, polygons
// triangles.
#pragma once

#include "common/geometry/shape.h"
#include "common/scene/obj/obj_check.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace duet {

/// Fed in the order of the file. Indices are as written: from 1, negative from the end so far, 0 where there is none.
///
/// Corners without a uv in a mesh that has some get (0, 0). Corners without a normal in a mesh that has some, and those
/// whose normal is zero, get their face's. A face whose corners name fewer than three vertices has no triangles and is
/// counted.
class ObjMeshBuilder {
public:
    /// `normals`: whether the file's are wanted.
    ObjMeshBuilder(const std::filesystem::path& path, const ObjCounts& counts, bool normals);

    void add_position(Vec3 p) { positions_.push_back(p); }
    void add_normal(Vec3 n);
    void add_uv(Vec2 uv) { uvs_.push_back(uv); }
    void begin_face(std::uint16_t slot) { slots_.push_back(slot); }
    void add_corner(int position, int uv, int normal);
    void end_face() { face_ends_.push_back(corners_.size()); }

    /// The mesh, and the number of faces left out. Throws Error where no face has a triangle.
    Mesh finish(std::size_t& degenerate_faces);

private:
    static constexpr std::uint32_t kNone = ~0u;
    struct Corner {
        std::uint32_t position, uv, normal; ///< from 0, or kNone
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

    std::vector<Vec3> polygon_; ///< of the face at hand
    std::vector<std::array<std::uint32_t, 3>> split_;
    std::vector<Corner> vertices_;
    std::vector<std::uint32_t> table_; ///< indices into vertices_ by hash, open addressing; its size is a power of two
    Mesh mesh_;
};

} // namespace duet
