// This file generates amphora.obj and amphora.png: a Greek vase with two handles, about 5,000 triangles.
#include "models/amphora.h"

#include "models/generate.h"
#include "models/mesh_builder.h"
#include "models/profile.h"

#include <array>

namespace duet::models {
namespace {

/// These are (radius, height) points along the wall, in meters: from the center of the foot's underside, up the
/// outside, over the lip, and down the inside to the center of the bottom. The first and last points are on the axis.
constexpr std::array kOutside = {Vec2d(0, 0.012),     Vec2d(0.07, 0.01),   Vec2d(0.105, 0.0),   Vec2d(0.118, 0.012),
                                 Vec2d(0.108, 0.036), Vec2d(0.082, 0.055), Vec2d(0.088, 0.085), Vec2d(0.145, 0.19),
                                 Vec2d(0.205, 0.32),  Vec2d(0.228, 0.44),  Vec2d(0.205, 0.55),  Vec2d(0.15, 0.63),
                                 Vec2d(0.1, 0.685),   Vec2d(0.084, 0.75),  Vec2d(0.09, 0.82),   Vec2d(0.115, 0.868),
                                 Vec2d(0.134, 0.878), Vec2d(0.140, 0.895), Vec2d(0.132, 0.91)};
constexpr std::array kInside = {Vec2d(0.132, 0.91), Vec2d(0.115, 0.906), Vec2d(0.096, 0.88), Vec2d(0.074, 0.82),
                                Vec2d(0.069, 0.75), Vec2d(0.085, 0.68),  Vec2d(0.14, 0.61),  Vec2d(0.19, 0.54),
                                Vec2d(0.21, 0.44),  Vec2d(0.188, 0.32),  Vec2d(0.125, 0.18), Vec2d(0.06, 0.1),
                                Vec2d(0, 0.085)};

constexpr int kOutsideRows = 36, kInsideRows = 12;

void add_wall(MeshBuilder& mesh) {
    std::vector<Vec2d> profile = sample_profile(kOutside, kOutsideRows);
    const std::vector<Vec2d> inside = sample_profile(kInside, kInsideRows);
    profile.insert(profile.end(), inside.begin() + 1, inside.end());
    add_revolution(mesh, profile, 44, [](std::size_t row) {
        const double j = static_cast<double>(row);
        return j <= kOutsideRows ? kAmphoraPaintedV * j / kOutsideRows
                                 : lerp(kAmphoraPaintedV, 1.0, (j - kOutsideRows) / kInsideRows);
    });
}

/// Adds the handle at x > 0 or x < 0, from the shoulder up and over to the neck below the lip.
void add_handle(MeshBuilder& mesh, double side) {
    constexpr std::array kHandleCurve = {Vec2d(0.152, 0.59), Vec2d(0.235, 0.70), Vec2d(0.235, 0.89),
                                         Vec2d(0.082, 0.806)};
    Tube tube;
    tube.columns = 8;
    tube.rows = 24;
    tube.center = [&](double t) { // a cubic Bézier curve
        const double s = 1 - t;
        const Vec2d p = kHandleCurve[0] * (s * s * s) + kHandleCurve[1] * (3 * s * s * t) +
                        kHandleCurve[2] * (3 * s * t * t) + kHandleCurve[3] * (t * t * t);
        return Vec3d(side * p.x, p.y, 0);
    };
    tube.radii = [](double) { return Vec2d(0.013, 0.021); };
    tube.uv_low = {0.0, 0.91};
    tube.uv_high = {1.0, 0.99};
    add_tube(mesh, tube);
}

} // namespace

void write_amphora(const std::filesystem::path& folder) {
    MeshBuilder mesh;
    add_wall(mesh);
    add_handle(mesh, 1);
    add_handle(mesh, -1);
    compute_normals(mesh, 60);
    write_obj(folder / "meshes/amphora.obj", mesh, "An amphora, made by models/amphora.cpp.");
    write_png(folder / "textures/amphora.png", paint_amphora());
}

} // namespace duet::models
