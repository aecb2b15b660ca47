// Defines a grid of directions that covers the sphere: the pixels of a latitude-longitude image.
#pragma once

#include "common/vec/vec.h"

#include <cmath>

namespace duet::raster {

/// Rows go from +y to −y; the middle column is −z.
struct LatlongGrid {
    int width, height;

    /// Returns the unit direction of a pixel's center.
    Vec3d direction(int column, int row) const {
        const double theta = kPiDouble * (row + 0.5) / height; // angle from +y
        const double longitude = 2 * kPiDouble * ((column + 0.5) / width - 0.5);
        return {std::sin(theta) * std::sin(longitude), std::cos(theta), -std::sin(theta) * std::cos(longitude)};
    }
    /// Returns the solid angle of each pixel of a row, in sr.
    double solid_angle(int row) const {
        const double top = kPiDouble * row / height, bottom = kPiDouble * (row + 1) / height;
        return 2 * kPiDouble / width * (std::cos(top) - std::cos(bottom));
    }
};

} // namespace duet::raster
