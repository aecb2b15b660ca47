// This file defines environment lights: radiance from infinitely far away in all directions.
//
// BSDF sampling finds a uniform sky well enough; only non-uniform light needs light samples. Light sampling therefore
// draws from the luminance above the mean only, and BSDF samples must also look up the environment. Multiple
// importance sampling combines the two ("MIS compensation": Karlík et al. 2019, "MIS Compensation: Optimizing
// Sampling Techniques in Multiple Importance Sampling", §5). A constant sky or a gradient has no light samples at
// all, which saves a shadow ray at every vertex.
#pragma once

#include "common/image/image.h"
#include "common/sampling/distribution.h"

#include <optional>
#include <variant>

namespace duet {

/// ConstantEnvironment has the same radiance in all directions, in W/(m² sr).
struct ConstantEnvironment {
    Rgb radiance{0.0f};
};
/// SkyEnvironment is linear in the direction's height y, as in Ray Tracing in One Weekend §4.2:
/// (1 − h)·down + h·up with h = (y + 1)/2.
struct SkyEnvironment {
    Rgb down{1.0f, 1.0f, 1.0f}, up{0.5f, 0.7f, 1.0f};
};
/// ImageEnvironment is a latitude-longitude image with the mapping of latlong_uv: u = ½ + atan2(x, −z)/2π, and
/// the top row is +y. Lookups are bilinear.
struct ImageEnvironment {
    ImageRgb image;
    float scale = 1;    ///< factor of all pixels
    float rotation = 0; ///< radians about +y, counter-clockwise seen from above
    // make_image_environment computes the fields below.
    bool all_black = true;       ///< whether all pixels are black
    float excess = 0;            ///< mean over directions of the luminance above the mean; 0: too little to sample
    Distribution2D distribution; ///< distribution over (u, v) of the luminance above the mean; empty: not sampled
};
using Environment = std::variant<ConstantEnvironment, SkyEnvironment, ImageEnvironment>;

/// Holds a sampled direction to the environment, and the radiance from there in W/(m² sr).
struct EnvironmentSample {
    Vec3 wi; ///< direction to the environment, unit
    Rgb radiance;
    float pdf; ///< density by solid angle, > 0
};

/// Prepares a latitude-longitude image for sampling. Negative values (out-of-gamut colors) become 0. Throws Error
/// where the image is empty or holds a value that is not finite, where scale is negative, or where scale or rotation
/// is not finite.
ImageEnvironment make_image_environment(ImageRgb image, float scale, float rotation);

/// Returns the radiance that arrives from direction w (unit), in W/(m² sr).
Rgb radiance(const Environment& environment, Vec3 w);
template <typename T> RgbT<T> radiance(const ConstantEnvironment& environment, Vec3T<T>) {
    return broadcast<T>(environment.radiance);
}
template <typename T> RgbT<T> radiance(const SkyEnvironment& sky, Vec3T<T> w) {
    const T height = clamp(T(0.5f) * (w.y + T(1.0f)), T(0.0f), T(1.0f));
    return lerp(broadcast<T>(sky.down), broadcast<T>(sky.up), height);
}
/// Draws a direction in proportion to the luminance above the mean; for an image, in proportion to the mean of each
/// pixel's cell. Returns nothing where the environment has too little such luminance: BSDF samples then find its
/// light best. u is in [0, 1)².
std::optional<EnvironmentSample> sample(const Environment& environment, Vec2 u);
/// Returns the density, by solid angle, with which sample draws w.
float pdf(const Environment& environment, Vec3 w);
/// Returns the irradiance, in W/m², that the sampled light would cause on a surface that faced all of it. The light
/// chooser uses it as the environment's weight. The result is 0 where nothing is sampled.
float sampled_irradiance(const Environment& environment);
/// Returns whether no light comes from any direction.
bool is_black(const Environment& environment);
/// Returns the radiance averaged over all directions. It is exact except for the bilinear filtering between an
/// image's rows.
Rgb mean_radiance(const Environment& environment);
/// Returns the irradiance ∫ L(w) max(0, n·w) dw in closed form for a constant environment and a sky, and nothing
/// for an image. The rasterizer approximates images by second-order spherical harmonics.
std::optional<Rgb> irradiance_closed_form(const Environment& environment, Vec3 n);

} // namespace duet
