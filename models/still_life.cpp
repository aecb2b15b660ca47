// This file generates the objects of still lifes: pear.obj (three materials: pear.mtl), bowl.obj, plinth.obj and
// ring.obj.
#include "common/system/file.h"
#include "models/distance_field.h"
#include "models/generate.h"
#include "models/image.h"
#include "models/mesh_builder.h"
#include "models/profile.h"

#include <array>

namespace duet::models {
namespace {

void add_pear_body(MeshBuilder& mesh) {
    constexpr std::array kProfile = {Vec2d(0, 0.006),      Vec2d(0.012, 0.003), Vec2d(0.026, 0.004),
                                     Vec2d(0.042, 0.02),   Vec2d(0.046, 0.045), Vec2d(0.038, 0.068),
                                     Vec2d(0.026, 0.088),  Vec2d(0.019, 0.105), Vec2d(0.011, 0.1155),
                                     Vec2d(0.004, 0.1165), Vec2d(0, 0.114)};
    const std::vector<Vec2d> profile = sample_profile(kProfile, 24);
    const std::size_t first = mesh.positions.size();
    mesh.use_material("skin");
    add_revolution(mesh, profile, 32);
    for (std::size_t i = first; i < mesh.positions.size(); ++i) { // makes the pear slightly irregular
        Vec3d& p = mesh.positions[i];
        const double swell = 1 + 0.05 * gradient_noise(p * 22.0);
        p = {p.x * swell + 0.9 * sqr(p.y), p.y, p.z * swell};
    }
}

void add_pear_stem(MeshBuilder& mesh) {
    Tube stem;
    stem.columns = 8;
    stem.rows = 10;
    stem.center = [](double t) { return Vec3d(0.0125 + 0.010 * t * t, 0.108 + 0.034 * t, 0.004 * t * t); };
    stem.radii = [](double t) { return Vec2d(1, 1) * (0.0019 + 0.0011 * t * t); };
    mesh.use_material("stem");
    add_tube(mesh, stem);
}

void add_pear_leaf(MeshBuilder& mesh) {
    Tube leaf;
    leaf.columns = 12;
    leaf.rows = 18;
    leaf.plane_normal = {0, 1, 0};
    leaf.center = [](double t) {
        return Vec3d(0.016 - 0.052 * t, 0.124 + 0.016 * std::sin(2.6 * t), 0.002 - 0.022 * t);
    };
    leaf.radii = [](double t) {
        return Vec2d(0.0145 * std::pow(std::sin(kPiDouble * std::pow(t, 0.8)), 1.2) + 0.0008, 0.0006);
    };
    mesh.use_material("leaf");
    add_tube(mesh, leaf);
}

/// Paints green-gold skin with a red cheek and freckles.
Image<Rgb8> paint_pear() {
    constexpr int kSize = 256;
    Image<Rgb8> image(kSize, kSize);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const double angle = 2 * kPiDouble * (x + 0.5) / kSize, v = 1 - (y + 0.5) / kSize;
            const Vec3d p(std::cos(angle), 3 * v, std::sin(angle));
            const double cheek =
                smooth_step(-0.1, 0.9, p.x + 0.5 * gradient_noise(p * 2.0)) * smooth_step(0.95, 0.5, v);
            const double freckle = smooth_step(0.42, 0.55, gradient_noise(p * 14.0)),
                         mottle = 8 * gradient_noise(p * 5.0);
            Vec3d color = lerp(Vec3d(196, 188, 74), Vec3d(196, 74, 44), 0.8 * cheek);
            color = lerp(color, Vec3d(128, 96, 48), 0.6 * freckle) + Vec3d(mottle, mottle, 0);
            const auto byte = [](double c) { return static_cast<std::uint8_t>(std::lround(clamp(c, 0.0, 255.0))); };
            image(x, y) = {byte(color.x), byte(color.y), byte(color.z)};
        }
    }
    return image;
}

} // namespace

void write_pear(const std::filesystem::path& folder) {
    MeshBuilder mesh;
    add_pear_body(mesh);
    add_pear_stem(mesh);
    add_pear_leaf(mesh);
    compute_normals(mesh, 70);
    write_obj(folder / "meshes/pear.obj", mesh, "A pear with stem and leaf, made by models/still_life.cpp.", 6,
              "pear.mtl");
    write_file(folder / "meshes/pear.mtl", "# Made by models/still_life.cpp.\n"
                                           "newmtl skin\nKd 1 1 1\nmap_Kd ../textures/pear.png\n\n"
                                           "newmtl stem\nKd 0.16 0.09 0.04\n\n"
                                           "newmtl leaf\nKd 0.10 0.26 0.05\n");
    write_png(folder / "textures/pear.png", paint_pear());
}

void write_bowl(const std::filesystem::path& folder) {
    constexpr std::array kProfile = {Vec2d(0, 0.006),     Vec2d(0.05, 0.004),  Vec2d(0.062, 0.0),   Vec2d(0.066, 0.006),
                                     Vec2d(0.058, 0.014), Vec2d(0.1, 0.03),    Vec2d(0.15, 0.065),  Vec2d(0.178, 0.112),
                                     Vec2d(0.182, 0.118), Vec2d(0.179, 0.121), Vec2d(0.173, 0.114), Vec2d(0.145, 0.07),
                                     Vec2d(0.098, 0.038), Vec2d(0.04, 0.024),  Vec2d(0, 0.022)};
    MeshBuilder mesh;
    add_revolution(mesh, sample_profile(kProfile, 30), 64);
    compute_normals(mesh, 70);
    write_obj(folder / "meshes/bowl.obj", mesh, "A bowl, made by models/still_life.cpp.");
}

void write_plinth(const std::filesystem::path& folder) {
    // The plinth is a cylinder of radius 1 and height 1 with a rounded upper edge.
    std::vector<Vec2d> profile{{0, 0}, {1, 0}, {1, 0.92}};
    for (int i = 1; i <= 6; ++i) {
        const double angle = i * kPiDouble / 12;
        profile.push_back({0.96 + 0.04 * std::cos(angle), 0.92 + 0.08 * std::sin(angle)});
    }
    profile.push_back({0, 1});
    MeshBuilder mesh;
    add_revolution(mesh, profile, 96);
    compute_normals(mesh, 40);
    write_obj(folder / "meshes/plinth.obj", mesh,
              "A round plinth of radius and height 1, made by models/still_life.cpp.");
}

void write_ring(const std::filesystem::path& folder) {
    constexpr std::array kProfile = {Vec2d(0.95, 0), Vec2d(1, 0), Vec2d(1, 0.35), Vec2d(0.95, 0.35), Vec2d(0.95, 0)};
    MeshBuilder mesh;
    add_revolution(mesh, kProfile, 192);
    compute_normals(mesh, 40);
    write_obj(folder / "meshes/ring.obj", mesh, "A ring of radius 1, made by models/still_life.cpp.");
}

} // namespace duet::models
