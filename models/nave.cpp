// This file generates nave.obj: a Gothic hall church, seen from inside. A nave and two aisles of one height have rib
// vaults on clustered piers, and a traceried window in each bay. It is made of closed solids. Units are meters; the
// nave runs along z.
#include "models/nave.h"

#include "models/mesh_builder.h"

#include <algorithm>
#include <array>

namespace duet::models {
namespace {

constexpr double kPi = kPiDouble;
constexpr double kHalfNave = 4, kHalfWidth = 7.6;  // in x: the piers' axes, the walls' inner faces
constexpr double kBay = 4.6, kWallThickness = 0.9; // kBay in z, from pier to pier
constexpr int kBays = 6;
constexpr double kEnd = kBay * kBays / 2;                // in z: the end walls
constexpr double kSpringing = 6, kRise = 5, kTop = 11.4; // heights: of the capitals, of the vault on them, of the walls
constexpr double kSill = 2.3;                            // height of the windows' sills

/// A pointed arch of half span 1 has arcs of radius kRadius. Their centers are on the springing line.
constexpr double kSlope = 1.25; ///< rise over half span
constexpr double kRadius = (1 + kSlope * kSlope) / 2;
/// Returns the arch's height at distance u in [0, 1] from the middle, as a fraction of its rise.
double arch_height(double u) { return safe_sqrt(kRadius * kRadius - sqr(u + kRadius - 1)) / kSlope; }

/// Adds a closed solid whose rings, of `columns` points each, are given from end to end. The ends are capped.
void add_rings(MeshBuilder& mesh, int columns, int rings, const std::function<Vec3d(double s, int ring)>& point) {
    ParametricSurface surface{
        .columns = columns, .rows = rings + 1, .closed_s = true, .pole_low = true, .pole_high = true, .point = {}};
    surface.point = [&](double s, double t) {
        const int row = static_cast<int>(std::lround(t * surface.rows));
        if (row > 0 && row <= rings) return point(s, row - 1);
        Vec3d middle;
        for (int i = 0; i < columns; ++i) middle += point(i / double(columns), row == 0 ? 0 : rings - 1);
        return middle / double(columns);
    };
    add_parametric_surface(mesh, surface);
}

/// Returns a point on the border of the square |u|, |v| <= 1, for s in [0, 1]. Equal steps of s crowd toward the
/// corners.
Vec2d on_square(double s) {
    const double along = s * 4;
    const int side = std::min(static_cast<int>(along), 3);
    const double a = std::sin(kPi / 2 * (2 * (along - side) - 1));
    constexpr std::array kDirections{Vec2d(1, 0), Vec2d(0, 1), Vec2d(-1, 0), Vec2d(0, -1)};
    const Vec2d out = kDirections[static_cast<std::size_t>(side)];
    return out + Vec2d(-out.y, out.x) * a;
}

/// Adds the stone above a bay of nave or aisle, with a groin vault below and a flat top.
void add_vault(MeshBuilder& mesh, Vec2d middle, Vec2d half) {
    constexpr int kColumns = 4 * 32, kRings = 24;
    add_rings(mesh, kColumns, kRings + 1, [&](double s, int ring) {
        const bool above = ring == 0;
        const Vec2d p = on_square(s) * (above ? 1 : std::sin(kPi / 2 * (kRings + 1 - ring) / kRings));
        const double height = arch_height(min(std::abs(p.x), std::abs(p.y)));
        return Vec3d(middle.x + p.x * half.x, above ? kTop : kSpringing + kRise * height, middle.y + p.y * half.y);
    });
}

/// Adds one side of a pointed arch: a rib from a springing point to the crown, `span` away horizontally. The profile is
/// (across, down), counter-clockwise for a viewer who looks along the rib.
void add_rib(MeshBuilder& mesh, Vec3d from, Vec3d span, std::span<const Vec2d> profile) {
    constexpr int kRows = 28;
    const double end = std::acos((kRadius - 1) / kRadius);
    const Vec3d across = normalize(cross(span, Vec3d(0, 1, 0)));
    const auto at = [&](double angle) {
        return from + span * (1 - (kRadius * (std::cos(angle) - 1) + 1)) +
               Vec3d(0, kRise * kRadius * std::sin(angle) / kSlope, 0);
    };
    const int columns = static_cast<int>(profile.size());
    add_rings(mesh, columns, kRows + 1, [&](double s, int ring) {
        const double angle = end * ring / kRows;
        const Vec3d down = normalize(cross(at(angle + 1e-4) - at(angle - 1e-4), across));
        const Vec2d p = profile[static_cast<std::size_t>(std::lround(s * columns)) % profile.size()];
        return at(angle) + across * p.x + down * p.y;
    });
}

/// Returns a rib's profile: chamfers that end in hollows, and a roll below. The upper corners lie inside the vault.
std::vector<Vec2d> rib_profile(double half, double depth) {
    std::vector<Vec2d> right{{half, -0.12}, {half, depth * 0.42}};
    for (int i = 0; i <= 3; ++i) { // a hollow
        const double angle = kPi / 2 * i / 3;
        right.push_back({half * (0.86 - 0.34 * std::sin(angle)), depth * (0.5 + 0.14 * (1 - std::cos(angle)))});
    }
    const double roll = half * 0.56;
    for (int i = 0; i <= 6; ++i) {
        const double angle = -0.2 * kPi + 0.7 * kPi * i / 6;
        right.push_back({roll * std::cos(angle), depth - roll + roll * std::sin(angle)});
    }
    std::vector<Vec2d> profile = right;
    for (std::size_t i = right.size() - 1; i-- > 0;) profile.push_back({-right[i].x, right[i].y});
    return profile;
}

/// Adds the disc where a vault's ribs meet.
void add_boss(MeshBuilder& mesh, Vec3d crown) {
    constexpr std::array kProfile{Vec2d(0.12, -0.5),  Vec2d(0.18, -0.48), Vec2d(0.2, -0.44),
                                  Vec2d(0.24, -0.42), Vec2d(0.3, -0.4),   Vec2d(0.33, -0.36),
                                  Vec2d(0.33, -0.3),  Vec2d(0.3, -0.26),  Vec2d(0.3, 0.1)};
    add_rings(mesh, 48, static_cast<int>(kProfile.size()), [&](double s, int ring) {
        const Vec2d p = kProfile[static_cast<std::size_t>(ring)];
        return crown + Vec3d(p.x * std::sin(2 * kPi * s), p.y, p.x * std::cos(2 * kPi * s));
    });
}

/// Returns the radius of a pier's plan in a direction. The plan is a round core with four shafts.
double cluster(double angle) {
    constexpr double kCore = 0.4, kShaft = 0.15, kAxis = 0.42;
    const double off = std::remainder(angle, kPi / 2), beside = kAxis * std::sin(off);
    const double shaft = std::abs(beside) < kShaft ? kAxis * std::cos(off) + safe_sqrt(sqr(kShaft) - sqr(beside)) : 0;
    return std::max(kCore, shaft);
}
double octagon(double angle) { return 1 / std::cos(std::remainder(angle - kPi / 8, kPi / 4)); }

/// Adds a pier with its base and its capital, which is a bell with leaves under an abacus.
void add_pier(MeshBuilder& mesh, double x, double z) {
    struct Ring {
        double height, offset; // offset: from the plan of core and shafts
        double octagon = 0;    // above 0: the plan is an octagon of this inner radius instead
        double leaf = 0;       // how far the leaves stand out
    };
    static constexpr std::array kRings{Ring{0, 0, 0.86},
                                       Ring{0.3, 0, 0.86},
                                       Ring{0.34, 0, 0.82},
                                       Ring{0.345, 0.17},
                                       Ring{0.37, 0.205},
                                       Ring{0.41, 0.22},
                                       Ring{0.45, 0.205},
                                       Ring{0.475, 0.17},
                                       Ring{0.49, 0.12},
                                       Ring{0.53, 0.09},
                                       Ring{0.57, 0.09},
                                       Ring{0.6, 0.12},
                                       Ring{0.625, 0.135},
                                       Ring{0.655, 0.135},
                                       Ring{0.68, 0.11},
                                       Ring{0.69, 0.03},
                                       Ring{0.73, 0.01},
                                       Ring{0.8, 0},
                                       Ring{1.8, 0},
                                       Ring{3.4, 0},
                                       Ring{5, 0},
                                       Ring{5.02, 0.035},
                                       Ring{5.05, 0.055},
                                       Ring{5.08, 0.055},
                                       Ring{5.11, 0.035},
                                       Ring{5.125, 0.005},
                                       Ring{5.17, 0.01, 0, 0.02},
                                       Ring{5.25, 0.018, 0, 0.035},
                                       Ring{5.33, 0.03, 0, 0.045},
                                       Ring{5.41, 0.05, 0, 0.055},
                                       Ring{5.48, 0.075, 0, 0.075},
                                       Ring{5.54, 0.1, 0, 0.11},
                                       Ring{5.58, 0.11, 0, 0.13},
                                       Ring{5.61, 0.115, 0, 0.115},
                                       Ring{5.63, 0.12, 0, 0.05},
                                       Ring{5.64, 0.13},
                                       Ring{5.66, 0.15},
                                       Ring{5.69, 0.15},
                                       Ring{5.71, 0.13},
                                       Ring{5.715, 0, 0.66},
                                       Ring{5.74, 0, 0.665},
                                       Ring{5.77, 0, 0.69},
                                       Ring{5.8, 0, 0.74},
                                       Ring{5.82, 0, 0.77},
                                       Ring{5.84, 0, 0.78},
                                       Ring{5.97, 0, 0.78},
                                       Ring{kSpringing, 0, 0.76}};
    add_rings(mesh, 112, static_cast<int>(kRings.size()), [&](double s, int row) {
        const Ring& ring = kRings[static_cast<std::size_t>(row)];
        const double angle = 2 * kPi * s;
        const double leaf = ring.leaf * std::pow(std::abs(std::cos(8 * angle)), 1.5);
        const double r = ring.octagon > 0 ? ring.octagon * octagon(angle) : cluster(angle) + ring.offset + leaf;
        return Vec3d(x + r * std::sin(angle), ring.height, z + r * std::cos(angle));
    });
}

/// A wall's coordinates are along, up, and inward from its inner face.
struct Wall {
    Vec3d middle, along, inward;
    double half; ///< half of its length
    Vec3d at(double a, double height, double in) const {
        return middle + along * a + Vec3d(0, height, 0) + inward * in;
    }
};

/// Adds a wall without a window.
void add_blind_wall(MeshBuilder& mesh, const Wall& wall) {
    add_rings(mesh, 4, 2, [&](double s, int ring) {
        const int corner = static_cast<int>(std::lround(s * 4)) % 4;
        return wall.at(corner == 1 || corner == 2 ? wall.half : -wall.half, corner >= 2 ? kTop : 0,
                       ring == 0 ? -kWallThickness : 0);
    });
}

/// Adds a wall with a window of the tracery's form, enlarged by `scale`.
void add_window_wall(MeshBuilder& mesh, const Wall& wall, double scale) {
    constexpr int kSillColumns = 12, kJamb = 10, kArc = 20, kColumns = kSillColumns + 2 * kJamb + 2 * kArc;
    const double half = kWindowHalf * scale, springing = kSill + kWindowSpringing * scale;
    // Returns point i on the border of the opening, widened by `wider`: sill, right jamb, arch, left jamb.
    const auto opening = [&](int i, double wider) {
        const double foot = kSill - 0.8 * wider, w = half + wider;
        if (i <= kSillColumns) return Vec2d(lerp(-w, w, i / double(kSillColumns)), foot);
        i -= kSillColumns;
        if (i <= kJamb) return Vec2d(w, lerp(foot, springing, i / double(kJamb)));
        i -= kJamb;
        const bool left = i > kArc;
        const double radius = 2 * half + wider, apex = std::acos(half / radius);
        const double angle = apex * std::min(i, std::max(2 * kArc - i, 0)) / kArc;
        const Vec2d arc(radius * std::cos(angle) - half, springing + radius * std::sin(angle));
        if (i <= 2 * kArc) return Vec2d(left ? -arc.x : arc.x, arc.y);
        return Vec2d(-w, lerp(springing, foot, (i - 2 * kArc) / double(kJamb)));
    };
    // Returns the point of the wall's border that belongs to the opening's point i. The corners are among these points.
    const auto border = [&](int i) {
        if (i <= kSillColumns) return Vec2d(lerp(-wall.half, wall.half, i / double(kSillColumns)), 0);
        const int corner = kJamb + kArc / 2; // steps from the sill to the upper corner
        i -= kSillColumns;
        const int mirrored = std::min(i, 2 * (kJamb + kArc) - i);
        const Vec2d p = mirrored <= corner
                            ? Vec2d(wall.half, kTop * mirrored / corner)
                            : Vec2d(wall.half * (kJamb + kArc - mirrored) / (kJamb + kArc - corner), kTop);
        return Vec2d(i > kJamb + kArc ? -p.x : p.x, p.y);
    };
    // This is the jamb's profile, from the tracery out to the inner face: (wider, inward), with a hollow and a roll.
    std::vector<Vec2d> jamb{{0, -0.45}, {0, -0.36}, {0.05, -0.33}};
    for (int i = 0; i <= 6; ++i) {
        const double angle = kPi / 2 * i / 6;
        jamb.push_back({0.2 - 0.14 * std::cos(angle), -0.32 + 0.14 * std::sin(angle)});
    }
    jamb.push_back({0.215, -0.17});
    for (int i = 0; i <= 8; ++i) {
        const double angle = kPi * (1.25 - 1.5 * i / 8);
        jamb.push_back({0.285 + 0.065 * std::cos(angle), -0.09 + 0.075 * std::sin(angle)});
    }
    jamb.push_back({0.36, -0.13});
    jamb.push_back({0.42, 0});
    const int steps = static_cast<int>(jamb.size());
    ParametricSurface surface{.columns = kColumns, .rows = steps + 3, .closed_s = true, .closed_t = true, .point = {}};
    surface.point = [&](double s, double t) {
        const int i = static_cast<int>(std::lround((1 - s) * kColumns)),
                  row = static_cast<int>(std::lround(t * surface.rows));
        const auto on = [&](Vec2d p, double in) { return wall.at(p.x, p.y, in); };
        if (row == steps) return on(border(i), 0);
        if (row == steps + 1) return on(border(i), -kWallThickness);
        if (row == steps + 2) return on(opening(i, 0.25), -kWallThickness);
        return on(opening(i, jamb[static_cast<std::size_t>(row)].x), jamb[static_cast<std::size_t>(row)].y);
    };
    add_parametric_surface(mesh, surface);
}

void add_ribs(MeshBuilder& mesh) {
    const std::vector<Vec2d> wide = rib_profile(0.24, 0.42), narrow = rib_profile(0.15, 0.3);
    for (const double side : {-1.0, 1.0}) {
        const double aisle = (kHalfWidth - kHalfNave) / 2;
        for (int i = 0; i <= kBays; ++i) {
            const double z = -kEnd + kBay * i;
            const Vec3d pier(side * kHalfNave, kSpringing, z), wall(side * kHalfWidth, kSpringing, z);
            add_rib(mesh, pier, {-side * kHalfNave, 0, 0}, wide);
            add_rib(mesh, pier, {side * aisle, 0, 0}, wide);
            add_rib(mesh, wall, {-side * aisle, 0, 0}, wide);
            for (const double ahead : {-kBay / 2, kBay / 2}) {
                if (std::abs(z + ahead) > kEnd) continue;
                add_rib(mesh, pier, {0, 0, ahead}, wide);
                add_rib(mesh, wall, {0, 0, ahead}, narrow);
                add_rib(mesh, pier, {-side * kHalfNave, 0, ahead}, narrow);
                add_rib(mesh, pier, {side * aisle, 0, ahead}, narrow);
                add_rib(mesh, wall, {-side * aisle, 0, ahead}, narrow);
            }
        }
    }
}

} // namespace

void write_nave(const std::filesystem::path& folder) {
    MeshBuilder mesh;
    constexpr double kAisle = (kHalfNave + kHalfWidth) / 2, kHalfAisle = (kHalfWidth - kHalfNave) / 2;
    for (int bay = 0; bay < kBays; ++bay) {
        const double z = -kEnd + kBay * (bay + 0.5);
        for (const double x : {-kAisle, 0.0, kAisle}) {
            add_vault(mesh, {x, z}, {x == 0 ? kHalfNave : kHalfAisle, kBay / 2});
            add_boss(mesh, {x, kSpringing + kRise, z});
        }
        for (const double side : {-1.0, 1.0})
            add_window_wall(mesh, {{side * kHalfWidth, 0, z}, {0, 0, side}, {-side, 0, 0}, kBay / 2}, 1);
    }
    for (const double side : {-1.0, 1.0}) {
        for (int i = 0; i <= kBays; ++i)
            for (const double x : {kHalfNave, kHalfWidth}) add_pier(mesh, side * x, -kEnd + kBay * i);
        for (const double end : {-1.0, 1.0})
            add_blind_wall(mesh, {{side * kAisle, 0, end * kEnd}, {-end, 0, 0}, {0, 0, -end}, kHalfAisle});
    }
    add_window_wall(mesh, {{0, 0, -kEnd}, {1, 0, 0}, {0, 0, 1}, kHalfNave}, 1.6);
    add_blind_wall(mesh, {{0, 0, kEnd}, {-1, 0, 0}, {0, 0, -1}, kHalfNave});
    add_ribs(mesh);
    mesh.uvs.clear(); // the stone material uses no uvs
    compute_normals(mesh, 40);
    write_obj(folder / kNaveFile, mesh, "A Gothic hall church, made by models/nave.cpp.");
}

} // namespace duet::models
