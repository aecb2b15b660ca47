// Light from infinitely far in all directions.
//
// Rays that follow the materials find an even sky well enough, and only unevenness asks for samples of its own: so it
// is the light *above the mean* that is sampled, and all light must also be looked for by BSDF samples, the two combined
// by multiple importance sampling («MIS compensation», Karlík et al. 2019, «MIS Compensation: Optimizing Sampling
// Techniques in Multiple Importance Sampling», §5). A constant sky or a plain gradient has no samples at all, which
// saves a shadow ray at every vertex.
#pragma once

#include "common/image/image.h"
#include "common/sampling/distribution.h"

#include <optional>
#include <variant>

namespace duet {

struct ConstantEnvironment {
    Rgb radiance{0.0f};
};
/// Linear in the direction's height: horizon-to-zenith as in Ray Tracing in One Weekend §4.2,
/// (1 − h)·down + h·up with h = (y + 1)/2.
struct SkyEnvironment {
    Rgb down{1.0f, 1.0f, 1.0f}, up{0.5f, 0.7f, 1.0f};
};
/// A lat-long picture, by the mapping of latlong_uv: u = ½ + atan2(x, −z)/2π, top row = +y; bilinear.
struct ImageEnvironment {
    ImageRgb image;
    float scale = 1;    ///< multiplies the picture
    float rotation = 0; ///< radians about +y, counter-clockwise seen from above
    // Made by make_image_environment:
    bool dark = true;            ///< all pixels are black
    float excess = 0;            ///< mean over directions of the luminance above its mean; 0: too little to be sampled
    Distribution2D distribution; ///< of that part, over (u, v); empty where it is not sampled
};
using Environment = std::variant<ConstantEnvironment, SkyEnvironment, ImageEnvironment>;

struct EnvironmentSample {
    Vec3 wi; ///< unit
    Rgb radiance;
    float pdf; ///< by solid angle, > 0
};

/// Prepares a picture for sampling. Negative values (out-of-gamut colours) become 0. Throws Error where the picture is
/// empty or has a value that is not finite, scale is negative, or either number is not finite.
ImageEnvironment make_image_environment(ImageRgb image, float scale, float rotation);

/// Radiance from direction w (unit).
Rgb radiance(const Environment& environment, Vec3 w);
inline Rgb radiance(const ConstantEnvironment& environment, Vec3) { return environment.radiance; }
inline Rgb radiance(const SkyEnvironment& sky, Vec3 w) {
    return lerp(sky.down, sky.up, clamp(0.5f * (w.y + 1), 0.0f, 1.0f));
}
/// A direction in proportion to the luminance above the mean (of a picture: to the mean of each pixel's cell), or
/// nothing, where an environment has too little of it: BSDF samples then find its light best. u in [0, 1)².
std::optional<EnvironmentSample> sample(const Environment& environment, Vec2 u);
/// The density with which sample would return w.
float pdf(const Environment& environment, Vec3 w);
/// What sample's light would give a surface that faced it all, W/m²: what the choice among lights weighs it by. 0 where
/// there is nothing to sample.
float sampled_irradiance(const Environment& environment);
bool is_black(const Environment& environment);
/// Radiance averaged over all directions, exact up to the bilinear blur of a picture's rows.
Rgb mean_radiance(const Environment& environment);
/// ∫ L(w) max(0, n·w) dw, in closed form for constant and sky; by second-order spherical harmonics is the rasterizer's
/// business.
std::optional<Rgb> irradiance_closed_form(const Environment& environment, Vec3 n);

} // namespace duet
