// Meshes under construction, and the OBJ files they become.
#pragma once

#include "common/vec/vec.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace duet::models {

/// Triangles whose corners index positions, texture coordinates and normals separately, as OBJ files do: a seam in uv
/// or a crease leaves the surface closed. Counter-clockwise seen from outside.
struct MeshBuilder {
    struct Corner {
        std::uint32_t position = 0, uv = 0, normal = 0;
    };
    using Triangle = std::array<Corner, 3>;
    /// Triangles from `first` on have the material (of the MTL file).
    struct MaterialRun {
        std::size_t first = 0;
        std::string name;
    };

    std::vector<Vec3d> positions;
    std::vector<Vec2d> uvs;     ///< or empty: the file has none
    std::vector<Vec3d> normals; ///< or empty: the file has none
    std::vector<Triangle> triangles;
    std::vector<MaterialRun> materials;

    /// Triangles added from now on have this material.
    void use_material(std::string name) { materials.push_back({triangles.size(), std::move(name)}); }
};

/// A bent rectangular grid of columns × rows cells over (s, t) in [0, 1]²: a surface of revolution, a swept tube, a
/// patch. ∂p/∂s × ∂p/∂t points outwards.
struct Sheet {
    int columns = 1, rows = 1;
    bool closed_s = false, closed_t = false;  ///< s = 1 is s = 0: no edge there, though uv go on to 1
    bool pole_low = false, pole_high = false; ///< the whole row t = 0 (t = 1) is one point
    std::function<Vec3d(double s, double t)> point;
    std::function<Vec2d(double s, double t)> uv = [](double s, double t) { return Vec2d(s, t); };
};

/// Adds a sheet: two triangles a cell, one where a pole is. Vertices at closed sides and poles are shared.
void add_sheet(MeshBuilder& mesh, const Sheet& sheet);

/// Adds the surface of revolution about the y axis of a profile of (radius, height), upwards along the outside. Where
/// its ends lie on the axis (radius 0) the surface is closed there. u runs once around, to the right seen from outside;
/// v is v_of(row).
void add_revolution(MeshBuilder& mesh, std::span<const Vec2d> profile, int columns,
                    const std::function<double(std::size_t row)>& v_of);

/// A tube along a curve, its ends closed by domes: for handles, rims and branches. `center` and `radii` (across: along
/// the frame's two axes) are functions of t in [0, 1]; the frame's first axis stays perpendicular to `plane_normal`. uv
/// lie in [low, high].
struct Tube {
    int columns = 12, rows = 24;
    std::function<Vec3d(double t)> center;
    std::function<Vec2d(double t)> radii;
    Vec3d plane_normal{0, 0, 1};
    Vec2d uv_low{0, 0}, uv_high{1, 1};
};
void add_tube(MeshBuilder& mesh, const Tube& tube);

/// Replaces the normals: at each corner the mean, weighted by angle, of the normals of the triangles around that
/// position that are within `crease_degrees` of this triangle's (Thürmer and Wüthrich 1998).
void compute_normals(MeshBuilder& mesh, double crease_degrees);

/// Writes an OBJ file: v, vt, vn, f; first the comment, a line each. Positions have `decimals` places, uvs and
/// normals 5. `mtl` is the material library named in it, or empty.
void write_obj(const std::filesystem::path& path, const MeshBuilder& mesh, const std::string& comment, int decimals = 5,
               const std::string& mtl = {});

} // namespace duet::models
