// This header declares the unoccluded irradiance from the environment.
#pragma once

#include "common/light/environment.h"
#include "raster/screen_space/sky_visibility.h"

#include <array>

namespace duet::raster {

/// Computes ∫ L(w) max(0, n·w) dw over all directions. It uses a closed form where the environment has one. An image
/// is projected to spherical harmonics up to the second order, which give irradiance to within 1 % of its mean for
/// natural light (Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps"). A
/// small bright sun has a larger error, up to 9 %.
class Irradiance {
public:
    /// Projects an image in parallel; the result is the same for any number of threads.
    Irradiance(const Environment& environment, int threads);

    /// Returns the irradiance of a surface with unit normal n; never negative. `environment` must be the one given to
    /// the constructor.
    Rgb at(const Environment& environment, Vec3 n) const;
    /// Returns the irradiance where a fraction of the environment is occluded by black surfaces. The loss is exact
    /// for radiance that is constant or linear in the direction, hence for a sky. For an image it is exact for orders
    /// 0 and 1 of its harmonics; order 2 is scaled by the visible fraction.
    Rgb at(const Environment& environment, Vec3 n, const SkyVisibility& seen) const;
    /// Returns the nine coefficients of the irradiance, each with the constant factor of its harmonic: the irradiance
    /// is c0 + c1 y + c2 z + c3 x + c4 xy + c5 yz + c6 (3z² − 1) + c7 xz + c8 (x² − y²). Constant environments and
    /// skies
    /// are exact.
    std::array<Rgb, 9> scaled_coefficients(const Environment& environment) const;
    bool is_closed_form() const { return closed_form_; }

private:
    bool closed_form_ = true;
    std::array<Rgbd, 9> coefficients_{}; ///< of the irradiance in the real spherical harmonics
};

} // namespace duet::raster
