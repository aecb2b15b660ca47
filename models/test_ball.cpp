// This file generates the material test ball meshes/test-ball.obj, with a groove, a knob and a foot, and one scene in
// balls/ for each material. The scenes differ only in the material.
#include "common/system/file.h"
#include "models/mesh_builder.h"
#include "models/profile.h"
#include "models/test_ball.h"

#include <cmath>

namespace duet::models {
namespace {

constexpr double kRadius = 0.8, kHeight = 0.92; ///< radius of the ball; height of its center above the ground

/// Appends points of (radius, height) on the ball between two angles above the horizon.
void add_arc(std::vector<Vec2d>& profile, double from_degrees, double to_degrees, int steps) {
    for (int i = 0; i <= steps; ++i) {
        const double angle = radians(from_degrees + (to_degrees - from_degrees) * i / steps);
        profile.push_back({kRadius * std::cos(angle), kHeight + kRadius * std::sin(angle)});
    }
}

/// Appends a convex (or concave) bend about a point of the profile, from its right to its left.
void add_bend(std::vector<Vec2d>& profile, double degrees, double radius, bool hollow) {
    const double middle = radians(degrees);
    const Vec2d center(kRadius * std::cos(middle), kHeight + kRadius * std::sin(middle));
    constexpr int kSteps = 8;
    for (int i = 0; i <= kSteps; ++i) {
        const double turn = kPiDouble * i / kSteps;
        const double angle = middle + (hollow ? -kPiDouble / 2 - turn : -kPiDouble / 2 + turn);
        profile.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
    }
}

} // namespace

std::span<const BallScene> ball_scenes() {
    static const std::vector<BallScene> all{
        {"diffuse", "Lambert's reflection", R"("type": "diffuse", "albedo": [0.6, 0.25, 0.15])", ""},
        {"clay", "the same albedo, rough", R"("type": "diffuse", "albedo": [0.6, 0.25, 0.15], "roughness": 1)", ""},
        {"gold", "a conductor by name", R"("type": "metal", "conductor": "gold", "roughness": 0.1)", ""},
        {"copper-rough", "copper, rough", R"("type": "metal", "conductor": "copper", "roughness": 0.6)", ""},
        {"aluminium", "aluminum, satin", R"("type": "metal", "conductor": "aluminium", "roughness": 0.3)", ""},
        {"glass", "smooth glass", R"("type": "dielectric", "ior": 1.5)", ""},
        {"glass-green", "glass that absorbs",
         R"("type": "dielectric", "ior": 1.5, "absorption": {"color": [0.35, 0.8, 0.5], "distance": 0.8})", ""},
        {"glass-frosted", "frosted glass", R"("type": "dielectric", "ior": 1.5, "roughness": 0.4)", ""},
        {"glass-thin", "a bubble of thin glass", R"("type": "dielectric", "ior": 1.5, "thin": true)", ""},
        {"glass-carved", "glass out of which air of a higher priority takes a bite",
         R"("type": "dielectric", "ior": 1.5, "priority": 1, )"
         R"("absorption": {"color": [0.8, 0.5, 0.3], "distance": 0.8})",
         R"(    {"name": "bite", "type": "sphere", "center": [0.42, 1.2, 0.62], "radius": 0.42, "material": "air"},)"},
        {"plastic", "a coat over a diffuse color", R"("type": "coated", "albedo": [0.1, 0.25, 0.7], "roughness": 0.1)",
         ""},
        {"plastic-satin", "the same, satin", R"("type": "coated", "albedo": [0.1, 0.25, 0.7], "roughness": 0.5)", ""},
        {"principled-dielectric", "principled, no metal",
         R"("type": "principled", "base_color": [0.8, 0.55, 0.1], "metallic": 0, "roughness": 0.35)", ""},
        {"principled-metal", "principled, a metal",
         R"("type": "principled", "base_color": [0.8, 0.55, 0.1], "metallic": 1, "roughness": 0.35)", ""},
        {"car-paint", "principled, half a metal, under a clear coat",
         R"("type": "principled", "base_color": [0.55, 0.02, 0.04], "metallic": 0.6, "roughness": 0.5, "clearcoat": 1)",
         ""},
        {"mask", "metal by a texture: where the checker is white",
         R"("type": "principled", "base_color": [0.9, 0.7, 0.4], "metallic": {"texture": "squares"}, "roughness": 0.3)",
         ""},
    };
    return all;
}

void write_test_ball(const std::filesystem::path& folder) {
    std::vector<Vec2d> profile{{0, 0}, {0.2, 0}, {0.4, 0}, {0.42, 0.006}, {0.426, 0.02}, {0.42, 0.034}, {0.39, 0.06},
                               {0.35, 0.1}};
    add_arc(profile, -58, 22, 20);
    add_bend(profile, 28, 0.06, true);
    add_arc(profile, 34, 80, 12);
    add_bend(profile, 86, 0.05, false);
    profile.push_back({0, kHeight + kRadius + 0.012});
    MeshBuilder mesh;
    add_revolution(mesh, profile, 64);
    compute_normals(mesh, 50);
    write_obj(folder / "meshes/test-ball.obj", mesh, "A ball to see materials on, made by models/test_ball.cpp.");

    // The floor is one millimeter below the ball. If glass touched the floor, rounding would decide which of the two
    // is hit.
    for (const BallScene& ball : ball_scenes())
        write_file(folder / "balls" / (ball.name + ".json"), R"({
  "description": ")" + ball.description + R"(",
  "camera": {"eye": [0, 1.9, 5.2], "look_at": [0, 0.86, 0], "fov_degrees": 24},
  "image": {"width": 480, "height": 480},
  "textures": {
    "squares": {"type": "checker", "even": 1, "odd": 0, "scale": 8},
    "floor": {"type": "checker", "even": 0.62, "odd": 0.2, "scale": 32}
  },
  "materials": {
    "ball": {)" + ball.material + R"(},
    "air": {"type": "dielectric", "ior": 1, "priority": 2},
    "floor": {"type": "diffuse", "albedo": {"texture": "floor"}},
    "wall": {"type": "diffuse", "albedo": [0.42, 0.41, 0.4]},
    "lamp": {"type": "emissive", "radiance": 12}
  },
  "objects": [
    {"name": "ball", "type": "mesh", "file": "../meshes/test-ball.obj", "material": "ball"},
)" + ball.objects + (ball.objects.empty() ? "" : "\n") +
               R"(    {"name": "floor", "type": "quad", "corner": [-6, -0.001, 6], "u": [12, 0, 0], "v": [0, 0, -9], )"
               R"("material": "floor"},
    {"name": "wall", "type": "quad", "corner": [-6, 0, -3], "u": [12, 0, 0], "v": [0, 6, 0], "material": "wall"},
    {"name": "lamp", "type": "quad", "corner": [-3.2, 2.0, 0.3], "u": [1.2, 1.6, 0], "v": [0, 0, 2], "material": "lamp"}
  ],
  "environment": {"type": "sky", "down": [0.2, 0.19, 0.18], "up": [0.42, 0.46, 0.52]}
}
)");
}

} // namespace duet::models
