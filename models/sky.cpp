// This file generates sky.hdr, an environment map of an evening sky: blue above, warm at the horizon, with clouds and
// a low sun behind haze.
#include "models/distance_field.h"
#include "models/generate.h"
#include "models/image.h"

namespace duet::models {
namespace {

const Vec3d kSun = normalize(Vec3d(-0.75, 0.42, 0.5));

Rgbd sky(Vec3d w) {
    const double height = max(w.y, 0.0), sun = max(dot(w, kSun), 0.0);
    const Rgbd zenith(0.13, 0.30, 0.78), horizon(0.84, 0.76, 0.70);
    Rgbd color = lerp(horizon, zenith, std::pow(smooth_step(0.0, 0.65, height), 0.5));
    // Clouds are in a plane overhead and thin out toward the horizon.
    const Vec3d plane = w * (1.6 / max(w.y, 0.05));
    double cloud = 0, weight = 0.6;
    for (double frequency = 1; frequency < 12; frequency *= 2.1, weight *= 0.5)
        cloud += weight * gradient_noise({plane.x * frequency, 3.7 * frequency, plane.z * frequency});
    const double cover = smooth_step(-0.05, 0.35, cloud) * smooth_step(0.05, 0.3, height);
    const Rgbd lit = Rgbd(1.1, 1.02, 0.95) + Rgbd(2.2, 1.5, 0.9) * std::pow(sun, 6.0);
    color = lerp(color, lit, 0.75 * cover);
    return color + Rgbd(1.6, 1.0, 0.5) * std::pow(sun, 5.0) + Rgbd(60, 46, 30) * std::pow(sun, 400.0);
}

Rgbd ground(Vec3d w) {
    const double facing = 0.5 + 0.5 * dot(w, kSun);
    return lerp(Rgbd(0.14, 0.12, 0.10), Rgbd(0.30, 0.24, 0.18), facing);
}

} // namespace

void write_sky(const std::filesystem::path& folder) {
    constexpr int kWidth = 256, kHeight = 128;
    ImageRgb image(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            // This inverts u = 1/2 + atan2(x, -z) / 2 pi; the top row is +y.
            const double phi = ((x + 0.5) / kWidth - 0.5) * 2 * kPiDouble, theta = (y + 0.5) / kHeight * kPiDouble;
            const Vec3d w(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
            image(x, y) = Rgb(lerp(ground(w), sky(w), smooth_step(-0.02, 0.02, w.y)));
        }
    }
    write_hdr(folder / "textures/sky.hdr", image);
}

} // namespace duet::models
