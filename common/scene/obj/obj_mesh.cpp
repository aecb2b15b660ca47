#include "common/scene/obj/obj_mesh.h"

#include "common/sampling/hash.h"
#include "common/scene/obj/triangulate.h"
#include "common/system/error.h"

#include <algorithm>

namespace duet {

ObjMeshBuilder::ObjMeshBuilder(const std::filesystem::path& path, const ObjCounts& counts, bool normals)
    : path_(&path), counts_(counts), normals_wanted_(normals), table_(1024, kNone) {
    positions_.reserve(counts.positions);
    uvs_.reserve(counts.texture_coordinates);
    normals_.reserve(counts.normals);
    corners_.reserve(counts.corners);
    face_ends_.reserve(counts.faces);
    slots_.reserve(counts.faces);
}

// The normal may have any length that float represents. Its square in double neither overflows nor underflows.
void ObjMeshBuilder::add_normal(Vec3 n) { normals_.emplace_back(normalize_or_zero(Vec3d(n))); }

/// Converts an index of the file to one that counts from 0. check_obj has already refused indices out of range by its
/// own parsing of the text; this second check guards against a different reading by tinyobjloader.
std::uint32_t ObjMeshBuilder::resolve(int index, std::size_t so_far, std::size_t total) const {
    if (index == 0) return kNone;
    const long long at = index > 0 ? index - 1LL : static_cast<long long>(so_far) + index;
    if (at < 0 || at >= static_cast<long long>(total))
        throw Error(message(path_->string(), ": face ", slots_.size(), ": the index ", index, " is out of range"));
    return static_cast<std::uint32_t>(at);
}

void ObjMeshBuilder::add_corner(int position, int uv, int normal) {
    Corner corner{resolve(position, positions_.size(), counts_.positions),
                  resolve(uv, uvs_.size(), counts_.texture_coordinates), kNone};
    if (normals_wanted_) corner.normal = resolve(normal, normals_.size(), counts_.normals);
    if (corner.position == kNone)
        throw Error(message(path_->string(), ": face ", slots_.size(), ": a corner without a vertex"));
    any_uv_ = any_uv_ || corner.uv != kNone;
    any_normal_ = any_normal_ || corner.normal != kNone;
    corners_.push_back(corner);
}

Mesh ObjMeshBuilder::finish(std::size_t& degenerate_faces) {
    if (positions_.size() != counts_.positions || uvs_.size() != counts_.texture_coordinates ||
        normals_.size() != counts_.normals || face_ends_.size() != counts_.faces)
        throw Error(path_->string() + ": changed while it was read");
    mesh_.triangles.reserve(corners_.size() - 2 * face_ends_.size());
    mesh_.material_slots.reserve(corners_.size() - 2 * face_ends_.size());
    degenerate_faces = 0;
    std::vector<Corner> face;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < face_ends_.size(); begin = face_ends_[i++]) {
        face.assign(corners_.begin() + static_cast<std::ptrdiff_t>(begin),
                    corners_.begin() + static_cast<std::ptrdiff_t>(face_ends_[i]));
        if (!add_face(face, slots_[i])) ++degenerate_faces;
    }
    if (mesh_.triangles.empty()) throw Error(path_->string() + ": has no face of three different vertices");
    mesh_.positions.reserve(vertices_.size());
    if (any_uv_) mesh_.uvs.reserve(vertices_.size());
    if (any_normal_) mesh_.normals.reserve(vertices_.size());
    for (const Corner& v : vertices_) {
        mesh_.positions.push_back(positions_[v.position]);
        if (any_uv_) mesh_.uvs.push_back(v.uv == kNone ? Vec2() : uvs_[v.uv]);
        if (any_normal_) mesh_.normals.push_back(normals_[v.normal]);
    }
    return std::move(mesh_);
}

bool ObjMeshBuilder::add_face(std::vector<Corner>& face, std::uint16_t slot) {
    // Adjacent corners with the same vertex are merged into one corner.
    face.erase(std::unique(face.begin(), face.end(),
                           [](const Corner& a, const Corner& b) { return a.position == b.position; }),
               face.end());
    while (face.size() > 1 && face.front().position == face.back().position) face.pop_back();
    if (face.size() < 3) return false;

    polygon_.clear();
    for (const Corner& corner : face) polygon_.push_back(positions_[corner.position]);
    if (any_normal_) use_face_normal(face);
    triangulation_.clear();
    if (!triangulate(polygon_, triangulation_))
        throw Error(message(path_->string(), ": a concave face of ", face.size(), " corners, expected at most ",
                            kMaxConcaveCorners));
    bool any = false;
    for (const auto& [a, b, c] : triangulation_) {
        if (face[a].position == face[b].position || face[b].position == face[c].position ||
            face[c].position == face[a].position)
            continue;
        mesh_.triangles.push_back({vertex(face[a]), vertex(face[b]), vertex(face[c])});
        mesh_.material_slots.push_back(slot);
        any = true;
    }
    return any;
}

void ObjMeshBuilder::use_face_normal(std::vector<Corner>& face) {
    const auto lacks_normal = [&](const Corner& corner) {
        return corner.normal == kNone || normals_[corner.normal] == Vec3();
    };
    if (std::none_of(face.begin(), face.end(), lacks_normal)) return;
    const Vec3 normal(normalize_or_zero(newell_normal(polygon_)));
    normals_.push_back(normal == Vec3() ? Vec3(0, 1, 0) : normal); // a face without area is never visible
    for (Corner& corner : face)
        if (lacks_normal(corner)) corner.normal = static_cast<std::uint32_t>(normals_.size() - 1);
}

std::size_t ObjMeshBuilder::find(const Corner& corner) const {
    const std::uint64_t position_and_uv = static_cast<std::uint64_t>(corner.position) << 32 | corner.uv;
    std::size_t at = hash_combine(position_and_uv, corner.normal) & (table_.size() - 1);
    while (table_[at] != kNone && vertices_[table_[at]] != corner) at = (at + 1) & (table_.size() - 1);
    return at;
}

std::uint32_t ObjMeshBuilder::vertex(const Corner& corner) {
    std::size_t at = find(corner);
    if (table_[at] != kNone) return table_[at];
    if (2 * vertices_.size() >= table_.size()) {
        grow_table();
        at = find(corner);
    }
    table_[at] = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back(corner);
    return table_[at];
}

void ObjMeshBuilder::grow_table() {
    table_.assign(4 * table_.size(), kNone);
    for (std::uint32_t i = 0; i < vertices_.size(); ++i) table_[find(vertices_[i])] = i;
}

} // namespace duet
