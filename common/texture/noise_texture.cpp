#include "common/texture/texture.h"
#include "common/texture/noise.h"

#include <cmath>

namespace duet {

Rgb evaluate(const NoiseTexture& texture, const SurfacePoint& point) {
    const Vec3d p = Vec3d(point.p_object) * static_cast<double>(texture.scale);
    const double noise = fractal_noise(p, texture.octaves);
    // Marble has veins across z that are distorted by turbulence (Shirley, Black and Hollasch, Ray Tracing: The Next
    // Week, §5.7). As there, the absolute value is taken of the sum. Without marble the sum itself is used and
    // clamped: it leaves [−1, 1] in fewer than one of 1,000 points.
    const double wave = texture.marble ? std::sin(p.z + 10 * std::abs(noise)) : clamp(noise, -1.0, 1.0);
    return lerp(texture.low, texture.high, static_cast<float>((1 + wave) / 2));
}

} // namespace duet
