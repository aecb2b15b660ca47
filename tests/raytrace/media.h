// This header provides media for tests.
#pragma once

#include "common/medium/density_grid.h"
#include "common/medium/medium.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace duet::raytrace {

/// Returns the cube of this half side around the origin.
inline Box3 cube(float half) { return {Vec3(-half, -half, -half), Vec3(half, half, half)}; }

/// Returns an even medium.
inline Medium fog(const Box3& box, Rgb scattering, Rgb absorption, float asymmetry = 0) {
    return {box, scattering, absorption, Rgb(), asymmetry};
}

/// Returns a medium whose density is highest in the middle of its box and 0 on its sides.
inline Medium bell(const Box3& box, float scattering, float absorption = 0) {
    constexpr int kPoints = 21;
    std::vector<float> densities;
    const auto height = [](int i) { return std::sin(kPi * static_cast<float>(i) / (kPoints - 1)); };
    for (int z = 0; z < kPoints; ++z)
        for (int y = 0; y < kPoints; ++y)
            for (int x = 0; x < kPoints; ++x) densities.push_back(std::max(height(x) * height(y) * height(z), 0.0f));
    Medium medium = fog(box, Rgb(scattering), Rgb(absorption));
    medium.density = std::make_shared<const DensityGrid>(std::array{kPoints, kPoints, kPoints}, std::move(densities));
    return medium;
}

} // namespace duet::raytrace
