// This file generates gyroid.obj: a hollow ball with a flat foot, cut from a gyroid, the minimal surface
// sin x cos y + sin y cos z + sin z cos x = 0 (Schoen 1970). A light inside casts the shadow of its lace.
#include "models/distance_field.h"
#include "models/generate.h"
#include "models/implicit.h"

namespace duet::models {
namespace {

constexpr double kRadius = 0.5, kThickness = 0.05; // of the ball, meters
constexpr double kFrequency = 31; // radians per meter: a period of 20 cm
constexpr double kWidth = 0.33; // of the sheet, as a value of the gyroid's function
constexpr double kFoot = -0.45; // height at which the ball is cut, and left open

double gyroid(Vec3d p) {
    return std::sin(p.x) * std::cos(p.y) + std::sin(p.y) * std::cos(p.z) + std::sin(p.z) * std::cos(p.x);
}

double lantern(Vec3d p) {
    const double shell = std::abs(length(p) - (kRadius - kThickness / 2)) - kThickness / 2;
    const double sheet = (std::abs(gyroid(p * kFrequency)) - kWidth) / kFrequency;
    // A rim holds the lace together where it stands.
    const double rim = std::hypot(std::hypot(p.x, p.z) - 0.205, p.y - kFoot - 0.02) - 0.03;
    return smooth_max(smooth_min(smooth_max(shell, sheet, 0.012), rim, 0.015), kFoot - p.y, 0.008);
}

} // namespace

void write_gyroid(const std::filesystem::path& folder) {
    constexpr double kBound = kRadius + 0.05;
    const Implicit surface{lantern, Vec3d(-kBound, -kBound, -kBound), Vec3d(kBound, kBound, kBound), 2};
    write_obj(folder / kGyroidFile, polygonize(surface, 0.0055), "A lantern of lace, made by models/gyroid.cpp.");
}

} // namespace duet::models
