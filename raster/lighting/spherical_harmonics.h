// Defines the real spherical harmonics of orders 0, 1 and 2, in which irradiance is stored (Ramamoorthi and Hanrahan
// 2001, "An Efficient Representation for Irradiance Environment Maps").
#pragma once

#include "common/image/rgb.h"
#include "common/vec/vec.h"

#include <array>

namespace duet::raster {

/// Holds the coefficients of an irradiance in harmonics(): c0 + c1 y + c2 z + c3 x + c4 xy + c5 yz + c6 (3z² − 1) + c7
/// xz + c8 (x² − y²).
using IrradianceHarmonics = std::array<Rgb, 9>;

/// Returns the harmonics of a unit vector without constant factors (eq. 3). T is float, double or a batch of floats.
template <typename T> std::array<T, 9> harmonics(const Vec3T<T>& w) {
    return {T(1),      w.y,       w.z, w.x, w.x * w.y, w.y * w.z, T(3) * w.z * w.z - T(1), w.x * w.z,
            w.x * w.x - w.y * w.y};
}

/// These factors turn radiance projected to harmonics() into IrradianceHarmonics. Each is the square of the harmonic's
/// constant factor, which projection and evaluation apply together, times the factor of the clamped cosine (eq. 8).
inline constexpr std::array<double, 9> kIrradianceFactors = [] {
    std::array<double, 9> result{0.28209479177387814, 0.4886025119029199,  0.4886025119029199,
                                 0.4886025119029199,  1.0925484305920792,  1.0925484305920792,
                                 0.31539156525252005, 1.0925484305920792,  0.5462742152960396};
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = result[i] * result[i] * kPiDouble * (i == 0 ? 1.0 : i < 4 ? 2.0 / 3 : 0.25);
    return result;
}();

/// Returns the irradiance on a surface whose normal has the given harmonics. Negative values, which the harmonics of a
/// small bright light may have, are clamped to 0.
template <typename T> RgbT<T> irradiance_at(const IrradianceHarmonics& coefficients, const std::array<T, 9>& basis) {
    RgbT<T> sum(T(0.0f));
    for (std::size_t i = 0; i < 9; ++i) sum += broadcast<T>(coefficients[i]) * basis[i];
    return {max(sum.r, T(0.0f)), max(sum.g, T(0.0f)), max(sum.b, T(0.0f))};
}

} // namespace duet::raster
