// This header declares meshes under construction and their output as OBJ files.
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

/// Triangles index positions, texture coordinates and normals separately at each corner, as in OBJ files. A uv seam
/// or a crease thus leaves the surface closed. Triangles are counter-clockwise seen from outside.
struct MeshBuilder {
    struct Corner {
        std::uint32_t position = 0, uv = 0, normal = 0;
    };
    using Triangle = std::array<Corner, 3>;
    /// Triangles from index `first` on have this material of the MTL file.
    struct MaterialRun {
        std::size_t first = 0;
        std::string name;
    };

    std::vector<Vec3d> positions;
    std::vector<Vec2d> uvs; ///< empty: the file has none
    std::vector<Vec3d> normals; ///< empty: the file has none
    std::vector<Triangle> triangles;
    std::vector<MaterialRun> materials;

    /// Assigns this material to the triangles added from now on.
    void use_material(std::string name) { materials.push_back({triangles.size(), std::move(name)}); }
};

/// A ParametricSurface is a curved rectangular grid of columns × rows cells over (s, t) in [0, 1]²: a surface of
/// revolution, a swept tube, or a patch. ∂p/∂s × ∂p/∂t points outward.
struct ParametricSurface {
    int columns = 1, rows = 1;
    bool closed_s = false, closed_t = false; ///< s = 1 and s = 0 share vertices, although uv extends to 1
    bool pole_low = false, pole_high = false; ///< all of row t = 0 (t = 1) is one point
    std::function<Vec3d(double s, double t)> point;
    std::function<Vec2d(double s, double t)> uv = [](double s, double t) { return Vec2d(s, t); };
};

/// Adds a surface with two triangles per cell, or one at a pole. Vertices at closed sides and poles are shared.
void add_parametric_surface(MeshBuilder& mesh, const ParametricSurface& surface);

/// Adds the surface of revolution about the y axis of a profile of (radius, height), given upward along the outside.
/// The surface is closed if the profile's ends are on the axis (radius 0), or are the same point. u runs once around,
/// to the right seen from outside. v is v_of(row), or rises evenly from 0 to 1 without it.
void add_revolution(MeshBuilder& mesh, std::span<const Vec2d> profile, int columns,
                    const std::function<double(std::size_t row)>& v_of = nullptr);

/// A tube follows a curve and has domes at its ends, for handles, rims and branches. `center` and `radii` (along the
/// two axes of the cross-section's frame) are functions of t in [0, 1]. The frame's first axis is perpendicular to
/// `plane_normal`. The uvs are in [low, high].
struct Tube {
    int columns = 12, rows = 24;
    std::function<Vec3d(double t)> center;
    std::function<Vec2d(double t)> radii;
    Vec3d plane_normal{0, 0, 1};
    Vec2d uv_low{0, 0}, uv_high{1, 1};
};
/// Adds a tube, with its domes.
void add_tube(MeshBuilder& mesh, const Tube& tube);

/// Replaces the normals. Each corner gets the angle-weighted mean of the normals of those triangles around its
/// position that are within `crease_degrees` of this triangle's normal (Thürmer and Wüthrich 1998).
void compute_normals(MeshBuilder& mesh, double crease_degrees);

/// Writes an OBJ file with v, vt, vn and f, after the comment lines. Positions have `decimals` decimal places, uvs
/// and normals 5. `mtl` is the file's material library, or empty.
void write_obj(const std::filesystem::path& path, const MeshBuilder& mesh, const std::string& comment, int decimals = 5,
               const std::string& mtl = {});

} // namespace duet::models
