// Irradiance from the environment, nothing in between.
#pragma once

#include "common/light/environment.h"
#include "raster/screen/sky_seen.h"

#include <array>

namespace duet::raster {

/// ∫ L(w) max(0, n·w) dw over all directions: in closed form where the environment has one; of a picture by its
/// spherical harmonics up to the second order, which hold irradiance to 1 % of its mean for natural light (Ramamoorthi
/// and Hanrahan 2001, «An Efficient Representation for Irradiance Environment Maps»; a small bright sun is worse: up to
/// 9 %).
class Irradiance {
public:
    /// Projects a picture, in parallel; the result is the same for any number of threads.
    Irradiance(const Environment& environment, int threads);

    /// At a surface with unit normal n; never negative. `environment` is the one it was made for.
    Rgb at(const Environment& environment, Vec3 n) const;
    /// The same where a part of the sky is hidden, and that is black. Of light that is constant and of light that is
    /// linear in the direction, exactly what is lost: a sky's in full; of a picture's light, the orders 0 and 1 of its
    /// harmonics, the second being taken to be lost as much of as of all directions.
    Rgb at(const Environment& environment, Vec3 n, const SkySeen& seen) const;
    bool is_closed_form() const { return closed_form_; }

private:
    bool closed_form_ = true;
    std::array<Rgbd, 9> coefficients_{}; ///< of the irradiance in the real spherical harmonics
};

} // namespace duet::raster
