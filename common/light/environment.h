// Light from infinitely far in all directions.
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
/// A lat-long picture, by the mapping of sphere_uv: u = ½ + atan2(x, −z)/2π, top row = +y; bilinear.
struct ImageEnvironment {
    ImageRgb image;
    float scale = 1;             ///< multiplies the picture
    float rotation = 0;          ///< radians about +y, counter-clockwise seen from above
    Distribution2D distribution; ///< over (u, v) by luminance × sin θ; made by make_image_environment
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
/// A direction by importance: uniform over the whole sphere for constant, proportional to luminance for sky and image
/// (for the image: to the mean of each pixel's cell). Empty if it is black. u in [0, 1)².
std::optional<EnvironmentSample> sample(const Environment& environment, Vec2 u);
/// The density with which sample would return w.
float pdf(const Environment& environment, Vec3 w);
bool is_black(const Environment& environment);
/// Radiance averaged over all directions, exact up to the bilinear blur of a picture's rows: what the choice among
/// lights weighs the environment by.
Rgb mean_radiance(const Environment& environment);
/// ∫ L(w) max(0, n·w) dw, in closed form for constant and sky; by second-order spherical harmonics is the rasterizer's
/// business.
std::optional<Rgb> irradiance_closed_form(const Environment& environment, Vec3 n);

} // namespace duet
