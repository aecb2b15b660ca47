#include "models/mesh_builder.h"

#include "common/system/file.h"
#include "models/format_number.h"

#include <algorithm>

namespace duet::models {
namespace {

using Corner = MeshBuilder::Corner;

std::uint32_t index(std::size_t i) { return static_cast<std::uint32_t>(i); }

Vec3d face_normal(const MeshBuilder& mesh, const MeshBuilder::Triangle& t) {
    const Vec3d a = mesh.positions[t[0].position], b = mesh.positions[t[1].position], c = mesh.positions[t[2].position];
    return normalize(cross(b - a, c - a));
}

/// Returns the angle of a triangle at its corner k.
double angle_at(const MeshBuilder& mesh, const MeshBuilder::Triangle& t, std::size_t k) {
    const Vec3d p = mesh.positions[t[k].position];
    const Vec3d a = mesh.positions[t[(k + 1) % 3].position] - p, b = mesh.positions[t[(k + 2) % 3].position] - p;
    return std::atan2(length(cross(a, b)), dot(a, b));
}

void append_index(std::string& text, std::uint32_t i) { text += std::to_string(i + 1); }

void append_vector(std::string& text, const char* key, Vec3d v, int decimals) {
    text += key;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        text += ' ';
        append_number(text, v[axis], decimals);
    }
    text += '\n';
}

void append_face(std::string& text, const MeshBuilder& mesh, const MeshBuilder::Triangle& triangle) {
    text += 'f';
    for (const Corner& corner : triangle) {
        text += ' ';
        append_index(text, corner.position);
        if (mesh.uvs.empty() && mesh.normals.empty()) continue;
        text += '/';
        if (!mesh.uvs.empty()) append_index(text, corner.uv);
        if (mesh.normals.empty()) continue;
        text += '/';
        append_index(text, corner.normal);
    }
    text += '\n';
}

} // namespace

void add_parametric_surface(MeshBuilder& mesh, const ParametricSurface& surface) {
    const int columns = surface.columns, rows = surface.rows;
    const auto s_of = [&](double i) { return i / columns; };
    const auto t_of = [&](double j) { return j / rows; };
    std::vector<std::uint32_t> ids(static_cast<std::size_t>((columns + 1) * (rows + 1)));
    const auto id = [&](int i, int j) -> std::uint32_t& {
        return ids[static_cast<std::size_t>(j * (columns + 1) + i)];
    };
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const bool pole = (j == 0 && surface.pole_low) || (j == rows && surface.pole_high);
            if (i > 0 && pole)
                id(i, j) = id(0, j);
            else if (i == columns && surface.closed_s)
                id(i, j) = id(0, j);
            else if (j == rows && surface.closed_t)
                id(i, j) = id(i, 0);
            else {
                id(i, j) = index(mesh.positions.size());
                mesh.positions.push_back(surface.point(s_of(i), t_of(j)));
            }
        }
    }
    const auto first_uv = mesh.uvs.size();
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) mesh.uvs.push_back(surface.uv(s_of(i), t_of(j)));
    const auto corner = [&](int i, int j) {
        return Corner{id(i, j), index(first_uv) + static_cast<std::uint32_t>(j * (columns + 1) + i), 0};
    };
    // At a pole each triangle has its own uv, halfway along its edge.
    const auto pole_corner = [&](int i, int j) {
        mesh.uvs.push_back(surface.uv(s_of(i + 0.5), t_of(j)));
        return Corner{id(i, j), index(mesh.uvs.size() - 1), 0};
    };
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const Corner a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
            if (j == 0 && surface.pole_low)
                mesh.triangles.push_back({pole_corner(i, j), c, d});
            else if (j == rows - 1 && surface.pole_high)
                mesh.triangles.push_back({a, b, pole_corner(i, j + 1)});
            else {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({a, c, d});
            }
        }
    }
}

void add_revolution(MeshBuilder& mesh, std::span<const Vec2d> profile, int columns,
                    const std::function<double(std::size_t row)>& v_of) {
    ParametricSurface surface;
    surface.columns = columns;
    surface.rows = static_cast<int>(profile.size()) - 1;
    surface.closed_s = true;
    surface.pole_low = profile.front().x == 0;
    surface.pole_high = profile.back().x == 0;
    surface.closed_t = profile.front() == profile.back();
    const auto row = [&](double t) { return static_cast<std::size_t>(std::lround(t * surface.rows)); };
    surface.point = [&](double s, double t) {
        const double angle = 2 * kPiDouble * s;
        const Vec2d p = profile[row(t)];
        return Vec3d(p.x * std::sin(angle), p.y, p.x * std::cos(angle));
    };
    surface.uv = [&](double s, double t) {
        return Vec2d(s, v_of ? v_of(row(t)) : static_cast<double>(row(t)) / surface.rows);
    };
    add_parametric_surface(mesh, surface);
}

void add_tube(MeshBuilder& mesh, const Tube& tube) {
    // The first and last `kDome` of t form the rounded ends: there the radius decreases to zero along a quarter
    // ellipse.
    constexpr double kDome = 0.06;
    ParametricSurface surface;
    surface.columns = tube.columns;
    surface.rows = tube.rows;
    surface.closed_s = surface.pole_low = surface.pole_high = true;
    surface.point = [&](double s, double t) {
        const double end = std::min({t / kDome, (1 - t) / kDome, 1.0});
        const double swell = safe_sqrt(1 - sqr(1 - end));
        const Vec3d tangent = normalize(tube.center(std::min(t + 1e-4, 1.0)) - tube.center(std::max(t - 1e-4, 0.0)));
        const Vec3d across = normalize(cross(tube.plane_normal, tangent)), up = cross(tangent, across);
        const double angle = 2 * kPiDouble * s;
        const Vec2d r = tube.radii(t) * swell;
        return tube.center(t) + across * (r.x * std::cos(angle)) + up * (r.y * std::sin(angle));
    };
    surface.uv = [&](double s, double t) {
        return Vec2d(lerp(tube.uv_low.x, tube.uv_high.x, s), lerp(tube.uv_low.y, tube.uv_high.y, t));
    };
    add_parametric_surface(mesh, surface);
}

void compute_normals(MeshBuilder& mesh, double crease_degrees) {
    const double crease = std::cos(radians(crease_degrees));
    std::vector<Vec3d> faces;
    std::vector<std::vector<std::pair<std::size_t, double>>> around(mesh.positions.size()); // triangle, angle
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        faces.push_back(face_normal(mesh, mesh.triangles[t]));
        for (std::size_t k = 0; k < 3; ++k)
            around[mesh.triangles[t][k].position].emplace_back(t, angle_at(mesh, mesh.triangles[t], k));
    }
    mesh.normals.clear();
    // The corners of a position share a normal where their normals are equal.
    std::vector<std::vector<std::uint32_t>> known(mesh.positions.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (Corner& corner : mesh.triangles[t]) {
            Vec3d sum;
            for (const auto& [other, angle] : around[corner.position])
                if (dot(faces[other], faces[t]) >= crease) sum += faces[other] * angle;
            const Vec3d normal = normalize(sum);
            auto& candidates = known[corner.position];
            const auto same =
                std::ranges::find_if(candidates, [&](auto i) { return length(mesh.normals[i] - normal) < 1e-6; });
            if (same != candidates.end())
                corner.normal = *same;
            else {
                corner.normal = index(mesh.normals.size());
                candidates.push_back(corner.normal);
                mesh.normals.push_back(normal);
            }
        }
    }
}

void write_obj(const std::filesystem::path& path, const MeshBuilder& mesh, const std::string& comment, int decimals,
               const std::string& mtl) {
    constexpr int kUnitDecimals = 5;
    std::string text = "# " + comment + "\n";
    if (!mtl.empty()) text += "mtllib " + mtl + "\n";
    for (const Vec3d& p : mesh.positions) append_vector(text, "v", p, decimals);
    for (const Vec2d& uv : mesh.uvs)
        text += "vt " + format_number(uv.x, kUnitDecimals) + " " + format_number(uv.y, kUnitDecimals) + "\n";
    for (const Vec3d& n : mesh.normals) append_vector(text, "vn", n, kUnitDecimals);
    auto run = mesh.materials.begin();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (; run != mesh.materials.end() && run->first == t; ++run) text += "usemtl " + run->name + "\n";
        append_face(text, mesh, mesh.triangles[t]);
    }
    write_file(path, text);
}

} // namespace duet::models
