// This file generates hall.obj: a vaulted hall of three aisles, seen from inside. It has long thin walls and finely
// tessellated columns, with openings to the outside at one end, in the walls and above. Units are meters; the nave
// runs along z.
#include "models/distance_field.h"
#include "models/generate.h"
#include "models/mesh_builder.h"
#include "models/profile.h"

#include <array>

namespace duet::models {
namespace {

constexpr double kPi = kPiDouble;
constexpr double kHalfNave = 5, kHalfWidth = 9; // in x: the columns' axes, the outer walls
constexpr double kEnd = 18, kBay = 6; // in z: the end walls; from column to column
// These are the heights of the arches' springing, of the nave's walls, and of the aisles' roofs.
constexpr double kSpringingHeight = 4.2, kArcadeTop = 8, kRoof = 5.6;
constexpr double kWallThickness = 0.5; // wall thickness
constexpr int kBays = 6;
constexpr int kVaultColumns = 40; // cells from the vault's base to its crown

/// Adds a flat patch corner + s u + t v, divided into cells.
void add_patch(MeshBuilder& mesh, Vec3d corner, Vec3d u, Vec3d v, int columns, int rows) {
    ParametricSurface surface{.columns = columns, .rows = rows, .point = {}};
    surface.point = [=](double s, double t) { return corner + u * s + v * t; };
    add_parametric_surface(mesh, surface);
}

void add_box(MeshBuilder& mesh, Vec3d low, Vec3d high, int cells) {
    const Vec3d d = high - low, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
    add_patch(mesh, low, y, x, 2, cells);
    add_patch(mesh, low + z, x, y, cells, 2);
    add_patch(mesh, low, z, y, cells, 2);
    add_patch(mesh, low + x, y, z, 2, cells);
    add_patch(mesh, low, x, z, cells, cells / 2);
    add_patch(mesh, low + y, z, x, cells / 2, cells);
}

/// Returns a point on the border of an arched opening for s in [0, 1]: up one jamb (if there is one), around the
/// arch, and down the other jamb. The coordinates are (along, height), centered at along = 0.
Vec2d arch(double s, double half, double foot, double spring) {
    const double jamb = foot < spring ? 0.25 : 0; // fraction of s for each jamb
    if (s < jamb) return {-half, lerp(foot, spring, s / jamb)};
    if (s > 1 - jamb) return {half, lerp(spring, foot, (s - (1 - jamb)) / jamb)};
    const double angle = kPi * (1 - (s - jamb) / (1 - 2 * jamb));
    return Vec2d(half * std::cos(angle), spring + half * std::sin(angle));
}

/// An ArchedWall is a wall in the plane x = `x` with an arched opening, one bay long, centered at z = `middle`. It has
/// both faces and the sides of the opening.
struct ArchedWall {
    double x, middle;
    double half, foot, spring; ///< of the opening
    double low, high; ///< of the wall

    void add(MeshBuilder& mesh) const {
        for (const double side : {-0.5, 0.5}) {
            ParametricSurface face{.columns = 48, .rows = kRows, .point = {}};
            face.point = [*this, side](double s, double t) {
                s = side > 0 ? 1 - s : s; // so that normals point outward
                return lerp(at(arch(s, half, foot, spring), side), at(border(s), side), t);
            };
            add_parametric_surface(mesh, face);
        }
        ParametricSurface reveal{.columns = 48, .rows = 4, .point = {}};
        reveal.point = [*this](double s, double t) { return at(arch(s, half, foot, spring), t - 0.5); };
        add_parametric_surface(mesh, reveal);
        if (foot > low) add_sill(mesh);
    }

private:
    static constexpr int kRows = 10, kSillColumns = 4; ///< number of cells beside the opening, and in it

    /// Adds the sill and the wall below it. Its vertices match those of the wall beside the opening, so there are no
    /// cracks.
    void add_sill(MeshBuilder& mesh) const {
        add_patch(mesh, at({-half, foot}, -0.5), Vec3d(0, 0, 2 * half), Vec3d(kWallThickness, 0, 0), kSillColumns, 4);
        constexpr int kColumns = 2 * kRows + kSillColumns;
        const auto along = [&](int column) {
            if (column < kRows) return lerp(-half, -kBay / 2, (kRows - column) / double{kRows});
            if (column > kRows + kSillColumns)
                return lerp(half, kBay / 2, (column - kRows - kSillColumns) / double{kRows});
            return lerp(-half, half, (column - kRows) / double{kSillColumns});
        };
        for (const double side : {-0.5, 0.5}) {
            ParametricSurface below{.columns = kColumns, .rows = 4, .point = {}};
            below.point = [&](double s, double t) {
                return at({along(static_cast<int>(std::lround((side > 0 ? 1 - s : s) * kColumns))),
                           lerp(low, foot, t)}, side);
            };
            add_parametric_surface(mesh, below);
        }
    }
    Vec3d at(Vec2d along_and_height, double side) const {
        return {x + side * kWallThickness, along_and_height.y, middle + along_and_height.x};
    }
    /// Returns the point of the wall's border that corresponds to the opening's point s: on its sides or its top.
    Vec2d border(double s) const {
        constexpr double kSide = 0.25;
        if (s < kSide) return {-kBay / 2, lerp(foot, high, s / kSide)};
        if (s > 1 - kSide) return {kBay / 2, lerp(high, foot, (s - (1 - kSide)) / kSide)};
        return {lerp(-kBay / 2, kBay / 2, (s - kSide) / (1 - 2 * kSide)), high};
    }
};

/// Adds a fluted column with base and capital.
void add_column(MeshBuilder& mesh, double x, double z) {
    constexpr std::array kProfile = {Vec2d(0.62, 0), Vec2d(0.62, 0.25), Vec2d(0.5, 0.3), Vec2d(0.54, 0.42),
                                     Vec2d(0.42, 0.5), Vec2d(0.4, 1.5), Vec2d(0.36, 3.3), Vec2d(0.38, 3.45),
                                     Vec2d(0.44, 3.55), Vec2d(0.5, 3.9),
                                     // This is below all of the arches' springing points, whose corners are at 0.65.
                                     Vec2d(0.66, 4.0), Vec2d(0.66, kSpringingHeight)};
    constexpr int kFlutes = 16;
    const std::vector<Vec2d> profile = sample_profile(kProfile, 32);
    const std::size_t first = mesh.positions.size();
    add_revolution(mesh, profile, 4 * kFlutes);
    for (std::size_t i = first; i < mesh.positions.size(); ++i) {
        Vec3d& p = mesh.positions[i];
        const double shaft = smooth_step(0.5, 0.7, p.y) * (1 - smooth_step(3.2, 3.4, p.y));
        const double flute = 1 - 0.05 * shaft * (0.5 + 0.5 * std::cos(kFlutes * std::atan2(p.z, p.x)));
        p = {x + p.x * flute, p.y, z + p.z * flute};
    }
}

/// Adds the nave's vault: a half cylinder with coffers, open along the crown between the middle bays.
void add_vault(MeshBuilder& mesh) {
    for (const double side : {-1.0, 1.0}) {
        ParametricSurface surface{.columns = kVaultColumns, .rows = 240, .point = {}};
        surface.point = [side](double s, double t) {
            const double z = lerp(-kEnd, kEnd, t);
            // The gap is a fraction of the angle, on each side of the crown.
            const double gap = 0.1 * smooth_step(9.0, 7.5, std::abs(z));
            const double angle = kPi / 2 * (side > 0 ? s * (1 - gap) : 1 - (1 - s) * (1 - gap));
            const double coffer = std::max(std::sin(12 * angle) * std::sin(2 * kPi * z / kBay * 3), 0.0);
            const double radius = kHalfNave + 0.18 * std::sqrt(coffer);
            const double around = side > 0 ? angle : kPi / 2 + angle;
            return Vec3d(radius * std::cos(around), kArcadeTop + radius * std::sin(around), z);
        };
        add_parametric_surface(mesh, surface);
    }
}

/// Adds the far end wall with a round window.
void add_end_wall(MeshBuilder& mesh) {
    // The tessellation matches that of the vault's four surfaces, so there are no gaps between vertices.
    ParametricSurface surface{.columns = 4 * kVaultColumns, .rows = 24, .closed_s = true, .point = {}};
    surface.point = [](double s, double t) {
        const double angle = 2 * kPi * s;
        const Vec2d direction(std::cos(angle), std::sin(angle));
        const double up = direction.y >= 0 ? kHalfNave // the border is the vault above and a rectangle below
                                           : std::min(kArcadeTop / -direction.y,
                                                      kHalfNave / std::max(std::abs(direction.x), 1e-9));
        const double r = lerp(1.6, up, t);
        return Vec3d(r * direction.x, kArcadeTop + r * direction.y, -kEnd);
    };
    add_parametric_surface(mesh, surface);
    for (const double side : {-1.0, 1.0})
        add_patch(mesh, {side > 0 ? kHalfNave : -kHalfWidth, 0, -kEnd}, {kHalfWidth - kHalfNave, 0, 0}, {0, kRoof, 0},
                  16, 16);
}

void add_floor(MeshBuilder& mesh) {
    ParametricSurface surface{.columns = 60, .rows = 120, .point = {}};
    surface.point = [](double s, double t) { // floor of worn slabs
        const double x = lerp(-kHalfWidth, kHalfWidth, s), z = lerp(kEnd, -kEnd, t);
        return Vec3d(x, 0.012 * gradient_noise(Vec3d(x, 0, z) * 1.3), z);
    };
    add_parametric_surface(mesh, surface);
}

void add_bench(MeshBuilder& mesh, double x, double z) {
    constexpr double kHalf = 1.6;
    add_box(mesh, {x - kHalf, 0.42, z}, {x + kHalf, 0.46, z + 0.45}, 8);        // seat
    add_box(mesh, {x - kHalf, 0.5, z + 0.42}, {x + kHalf, 0.95, z + 0.46}, 8);  // back
    for (const double end : {-kHalf, kHalf})
        add_box(mesh, {x + end - 0.04, 0, z - 0.02}, {x + end + 0.04, 1, z + 0.48}, 4);
}

} // namespace

void write_hall(const std::filesystem::path& folder) {
    MeshBuilder mesh;
    add_floor(mesh);
    add_vault(mesh);
    add_end_wall(mesh);
    for (const double side : {-1.0, 1.0}) {
        for (int bay = 0; bay < kBays; ++bay) {
            const double middle = -kEnd + kBay * (bay + 0.5);
            ArchedWall{side * kHalfNave, middle, 2.4, kSpringingHeight, kSpringingHeight, kSpringingHeight, kArcadeTop}
                .add(mesh);
            ArchedWall{side * kHalfWidth, middle, 1.1, 1.6, 3.4, 0, kRoof}.add(mesh);
        }
        for (int i = 0; i <= kBays; ++i) add_column(mesh, side * kHalfNave, -kEnd + kBay * i);
        add_patch(mesh, {side > 0 ? kHalfNave : -kHalfWidth, kRoof, -kEnd}, {kHalfWidth - kHalfNave, 0, 0},
                  {0, 0, 2 * kEnd}, 20, 90);
        for (int row = 0; row < 12; ++row) add_bench(mesh, side * 2.4, -kEnd + 4 + 2.1 * row);
    }
    mesh.uvs.clear(); // the stone material uses no uvs
    compute_normals(mesh, 40);
    write_obj(folder / kHallFile, mesh, "A vaulted hall, made by models/hall.cpp.");
}

} // namespace duet::models
