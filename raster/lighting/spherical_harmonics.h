// The real spherical harmonics of orders 0, 1 and 2, in which irradiance is stored (Ramamoorthi and Hanrahan 2001, "An
// Efficient Representation for Irradiance Environment Maps").
#pragma once

#include "common/vec/vec.h"

#include <array>

namespace duet::raster {

/// Returns the harmonics of a unit vector without constant factors (eq. 3). Irradiance::scaled_coefficients() has the
/// factors. T is float or a batch of floats.
template <typename T> std::array<T, 9> harmonics(const Vec3T<T>& w) {
    return {T(1),      w.y,       w.z, w.x, w.x * w.y, w.y * w.z, T(3) * w.z * w.z - T(1), w.x * w.z,
            w.x * w.x - w.y * w.y};
}

} // namespace duet::raster
