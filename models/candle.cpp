// This file generates candle.obj, flame.obj and wick.obj: a candle that has burned for a while.
#include "models/distance_field.h"
#include "models/generate.h"
#include "models/mesh_builder.h"
#include "models/profile.h"

#include <array>
#include <cmath>

namespace duet::models {
namespace {

/// Returns the wax, 12 cm high, whose rim has melted unevenly around a hollow.
MeshBuilder wax() {
    constexpr std::array kProfile = {Vec2d(0, 0),         Vec2d(0.033, 0),     Vec2d(0.035, 0.002), Vec2d(0.035, 0.06),
                                     Vec2d(0.035, 0.11),  Vec2d(0.0335, 0.12), Vec2d(0.030, 0.12),  Vec2d(0.026, 0.115),
                                     Vec2d(0.016, 0.111), Vec2d(0.006, 0.111), Vec2d(0, 0.112)};
    MeshBuilder mesh;
    add_revolution(mesh, sample_profile(kProfile, 48), 72);
    for (Vec3d& p : mesh.positions) {
        const double angle = std::atan2(p.z, p.x), radius = std::hypot(p.x, p.z);
        const double rim = smooth_step(0.085, 0.12, p.y) * smooth_step(0.012, 0.03, radius);
        p.y += rim * (0.003 * std::sin(angle + 0.6) + 0.0015 * std::sin(3 * angle + 1.9));
        const double swell = 1 + 0.012 * std::sin(2 * angle + 40 * p.y);
        p.x *= swell, p.z *= swell;
    }
    compute_normals(mesh, 70);
    return mesh;
}

MeshBuilder flame() {
    constexpr std::array kProfile = {Vec2d(0, 0),           Vec2d(0.0032, 0.002), Vec2d(0.0052, 0.008),
                                     Vec2d(0.0045, 0.0165), Vec2d(0.002, 0.026),  Vec2d(0, 0.032)};
    MeshBuilder mesh;
    add_revolution(mesh, sample_profile(kProfile, 10), 12);
    compute_normals(mesh, 90);
    return mesh;
}

MeshBuilder wick() {
    Tube tube;
    tube.columns = 10;
    tube.rows = 10;
    tube.center = [](double t) { return Vec3d(0.004 * t * t, 0.1 + 0.032 * t, 0); };
    tube.radii = [](double) { return Vec2d(0.0009, 0.0009); };
    MeshBuilder mesh;
    add_tube(mesh, tube);
    compute_normals(mesh, 70);
    return mesh;
}

} // namespace

void write_candle(const std::filesystem::path& folder) {
    write_obj(folder / "meshes/candle.obj", wax(), "The wax of a candle, made by models/candle.cpp.", 6);
    write_obj(folder / "meshes/flame.obj", flame(), "A flame, made by models/candle.cpp.", 6);
    write_obj(folder / "meshes/wick.obj", wick(), "A wick, made by models/candle.cpp.", 6);
}

} // namespace duet::models
