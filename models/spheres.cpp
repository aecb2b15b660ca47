// This file generates spheres.json: the cover scene of Ray Tracing in One Weekend (Shirley, Black and Hollasch,
// §14.1), with our own random numbers.
#include "common/system/file.h"
#include "common/vec/vec.h"
#include "models/format_number.h"
#include "models/generate.h"
#include "models/random.h"

namespace duet::models {
namespace {

constexpr int kDecimals = 3;

std::string triple(Vec3d v) {
    return "[" + format_number(v.x, kDecimals) + ", " + format_number(v.y, kDecimals) + ", " +
           format_number(v.z, kDecimals) + "]";
}

/// Converts the book's fuzz to roughness. The book moves a mirrored direction by up to `fuzz` within a sphere:
/// ±fuzz/√3 along an axis. A microfacet tilted by δ moves it by 2δ, so the slopes spread by fuzz/(2√3) along an
/// axis. The microfacet width is √2 times that: α = 0.41·fuzz. Scene files give roughness = √α.
double roughness_of_fuzz(double fuzz) { return std::sqrt(0.41 * fuzz); }

/// Stores the two lists of the scene file and the number of spheres in them.
struct Lists {
    std::string materials, objects;
    int count = 0;

    void add(Vec3d center, double radius, const std::string& material) {
        const std::string name = "m" + std::to_string(count++);
        materials += std::string(materials.empty() ? "" : ",\n") + "    \"" + name + "\": {" + material + "}";
        objects += std::string(objects.empty() ? "" : ",\n") +
                   "    {\"type\": \"sphere\", \"center\": " + triple(center) +
                   ", \"radius\": " + format_number(radius, kDecimals) + ", \"material\": \"" + name + "\"}";
    }
};

std::string diffuse(Vec3d albedo) { return "\"type\": \"diffuse\", \"albedo\": " + triple(albedo); }
std::string metal(Vec3d reflectance, double fuzz) {
    return "\"type\": \"metal\", \"reflectance\": " + triple(reflectance) +
           ", \"roughness\": " + format_number(roughness_of_fuzz(fuzz), kDecimals);
}
std::string glass() { return "\"type\": \"dielectric\", \"ior\": 1.5"; }

Vec3d random_color(Random& random, double low, double high) {
    const double r = random.uniform(low, high), g = random.uniform(low, high), b = random.uniform(low, high);
    return {r, g, b};
}

/// Returns a random material: 80 % diffuse, 15 % metal, 5 % glass.
std::string random_material(Random& random) {
    const double choice = random.uniform();
    if (choice < 0.8) {
        const Vec3d a = random_color(random, 0, 1), b = random_color(random, 0, 1);
        return diffuse(a * b);
    }
    if (choice < 0.95) {
        const Vec3d reflectance = random_color(random, 0.5, 1);
        return metal(reflectance, random.uniform(0, 0.5));
    }
    return glass();
}

} // namespace

void write_spheres(const std::filesystem::path& folder) {
    Lists lists;
    lists.add({0, -1000, 0}, 1000, diffuse({0.5, 0.5, 0.5}));
    Random random(1);
    for (int a = -11; a < 11; ++a) {
        for (int b = -11; b < 11; ++b) {
            const double x = a + 0.9 * random.uniform(), z = b + 0.9 * random.uniform();
            const std::string material = random_material(random);
            const Vec3d center(x, 0.2, z);
            // The sphere must not intersect the metal sphere.
            if (length(center - Vec3d(4, 0.2, 0)) > 0.9) lists.add(center, 0.2, material);
        }
    }
    lists.add({0, 1, 0}, 1, glass());
    lists.add({-4, 1, 0}, 1, diffuse({0.4, 0.2, 0.1}));
    lists.add({4, 1, 0}, 1, metal({0.7, 0.6, 0.5}, 0));

    // A defocus angle of 0.6° at focus distance 10 corresponds to a lens of radius 10·tan 0.3°.
    const double aperture = 10 * std::tan(radians(0.3));
    write_file(
        folder / "spheres.json",
        "{\n  \"camera\": {\"eye\": [13, 2, 3], \"look_at\": [0, 0, 0], \"fov_degrees\": 20, \"aperture_radius\": " +
            format_number(aperture, 6) + ", \"focus_distance\": 10},\n" +
            "  \"image\": {\"width\": 1200, \"height\": 675},\n" + "  \"materials\": {\n" + lists.materials +
            "\n  },\n  \"objects\": [\n" + lists.objects +
            "\n  ],\n  \"environment\": {\"type\": \"sky\", \"down\": [1, 1, 1], \"up\": [0.5, 0.7, 1]}\n}\n");
}

} // namespace duet::models
