// This file generates menger.obj: a Menger sponge of four levels (Menger 1926), cut in half by the plane through its
// center that is perpendicular to a diagonal. The section is a hexagon full of six-pointed stars.
#include "models/generate.h"
#include "models/mesh_builder.h"

#include <map>

namespace duet::models {
namespace {

constexpr int kCells = 81; // number of cells along a side
// Coordinates count half cells, so that the plane cuts edges at whole numbers and passes through no corner.
using Point = std::array<int, 3>;
constexpr int kPlane = 3 * kCells; // the sum of the coordinates, on the plane

/// Returns whether a cell is solid: at no level do two of its coordinates lie in the middle third.
bool solid(int i, int j, int k) {
    for (const int c : {i, j, k})
        if (c < 0 || c >= kCells) return false;
    for (; i + j + k > 0; i /= 3, j /= 3, k /= 3)
        if ((i % 3 == 1) + (j % 3 == 1) + (k % 3 == 1) >= 2) return false;
    return true;
}

int sum(const Point& p) { return p[0] + p[1] + p[2]; }

class Sponge {
public:
    void add_cell(const Point& cell) {
        std::map<Point, Point> section; // maps each corner of the section to the next
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const int side : {0, 1}) {
                Point beside = cell;
                beside[axis] += side == 1 ? 1 : -1;
                add_face(cell, axis, side, !solid(beside[0], beside[1], beside[2]), section);
            }
        }
        if (section.empty()) return;
        std::vector<Point> corners{section.begin()->first};
        while (corners.size() < section.size()) corners.push_back(section.at(corners.back()));
        add_polygon(corners);
    }
    MeshBuilder mesh;

private:
    /// Adds what the plane leaves of a face, if it is `visible`, and notes the edge that it shares with the section.
    void add_face(const Point& cell, std::size_t axis, int side, bool visible, std::map<Point, Point>& section) {
        std::vector<Point> corners;
        for (const auto& [u, v] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
            Point p{2 * cell[0], 2 * cell[1], 2 * cell[2]};
            p[axis] += 2 * side;
            p[(axis + 1) % 3] += 2 * (side == 1 ? u : v); // counter-clockwise seen from outside
            p[(axis + 2) % 3] += 2 * (side == 1 ? v : u);
            corners.push_back(p);
        }
        std::vector<Point> left;
        Point out{}, in{};
        for (std::size_t i = 0; i < 4; ++i) {
            const Point &a = corners[i], &b = corners[(i + 1) % 4];
            if (sum(a) < kPlane) left.push_back(a);
            if ((sum(a) < kPlane) == (sum(b) < kPlane)) continue;
            const Point middle{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
            left.push_back(middle);
            (sum(a) < kPlane ? out : in) = middle;
        }
        if (out != in) section[in] = out;
        if (visible && !left.empty()) add_polygon(left);
    }

    void add_polygon(const std::vector<Point>& corners) {
        for (std::size_t i = 2; i < corners.size(); ++i)
            mesh.triangles.push_back({corner(corners[0]), corner(corners[i - 1]), corner(corners[i])});
    }

    MeshBuilder::Corner corner(const Point& p) {
        const auto [at, added] = vertices_.try_emplace(p, static_cast<std::uint32_t>(mesh.positions.size()));
        if (added) mesh.positions.push_back(Vec3d(p[0], p[1], p[2]) * (1.0 / kCells) - Vec3d(1, 1, 1));
        return {at->second, 0, 0};
    }

    std::map<Point, std::uint32_t> vertices_;
};

} // namespace

void write_menger(const std::filesystem::path& folder) {
    Sponge sponge;
    for (int i = 0; i < kCells; ++i)
        for (int j = 0; j < kCells; ++j)
            for (int k = 0; k < kCells && 2 * (i + j + k) < kPlane; ++k)
                if (solid(i, j, k)) sponge.add_cell({i, j, k});
    compute_normals(sponge.mesh, 1);
    write_obj(folder / kMengerFile, sponge.mesh, "Half a Menger sponge, made by models/menger.cpp.");
}

} // namespace duet::models
