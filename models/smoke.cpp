// This file generates smoke.raw: the densities of a plume of smoke, a byte for each point of a grid.
#include "common/system/file.h"
#include "common/texture/noise.h"
#include "models/distance_field.h"
#include "models/generate.h"

#include <cmath>

namespace duet::models {
namespace {

constexpr int kWidth = 48, kHeight = 112; // numbers of points; the depth equals the width

/// Returns the density at a point; height y goes from 0 to 1, and x and z from −0.2 to 0.2.
double density(Vec3d p) {
    // The higher, the more the plume sways and curls.
    const auto noise = [](Vec3d q, std::uint32_t seed) { return gradient_noise(q, seed); };
    const Vec3d sway(noise({0.3, 2.2 * p.y, 0.7}, 1), 0, noise({0.1, 2.2 * p.y, 0.4}, 2));
    const Vec3d curl(noise(p * 9.0, 3), noise(p * 9.0, 4), noise(p * 9.0, 5));
    const Vec3d q = p - sway * (0.16 * p.y) + curl * (0.12 * std::sqrt(p.y) * p.y);
    const double radius = 0.015 + 0.1 * p.y;
    const double core = 1 - smooth_step(0.3, 1.0, std::sqrt(sqr(q.x) + sqr(q.z)) / radius);
    const double wisps = smooth_step(-0.25, 0.35, fractal_noise(Vec3d(q.x, 0.45 * q.y, q.z) * 16.0, 4) + 0.5 - p.y);
    return core * wisps * (1 - smooth_step(0.6, 1.0, p.y)) * (1 - 0.55 * p.y);
}

} // namespace

void write_smoke(const std::filesystem::path& folder) {
    std::string bytes;
    for (int z = 0; z < kWidth; ++z)
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const double across = 0.4 / (kWidth - 1);
                const Vec3d p(x * across - 0.2, y / (kHeight - 1.0), z * across - 0.2);
                bytes.push_back(static_cast<char>(std::lround(255 * clamp(density(p), 0.0, 1.0))));
            }
    write_file(folder / "textures/smoke.raw", bytes);
}

} // namespace duet::models
