// A pinhole camera both ways, and what tells two images apart.
#include "compare/lessons/12-both-ways/lab.h"

#include <algorithm>
#include <cmath>

namespace duet::lab {

struct Axes {
    Vec3 right, up, forward;
};

Axes find_axes(const Camera& camera) {
    const Vec3 forward = normalize(camera.target - camera.eye);
    const Vec3 right = normalize(cross(forward, camera.up));
    const Vec3 up = cross(right, forward);
    return {right, up, forward};
}

float half_height(const Camera& camera) {
    const float angle = camera.fov_degrees * kPi / 180;
    return std::tan(angle / 2);
}

Ray pixel_ray(const Camera& camera, int width, int height, int x, int y) {
    const Axes axes = find_axes(camera);
    const float pixel = 2 * half_height(camera) / static_cast<float>(height);
    const float center_x = static_cast<float>(x) + 0.5f;
    const float center_y = static_cast<float>(y) + 0.5f;
    const float right = (center_x - static_cast<float>(width) / 2) * pixel;
    const float up = (static_cast<float>(height) / 2 - center_y) * pixel;
    const Vec3 direction = axes.forward + axes.right * right + axes.up * up;
    return {camera.eye, normalize(direction), 0, kInfinity};
}

std::optional<Vec2> project(const Camera& camera, int width, int height, Vec3 p) {
    const Axes axes = find_axes(camera);
    const Vec3 v = p - camera.eye;
    const float depth = dot(v, axes.forward);
    if (depth <= 0) return std::nullopt;
    const float scale = static_cast<float>(height) / 2 / half_height(camera);
    const float px = static_cast<float>(width) / 2 + dot(v, axes.right) / depth * scale;
    const float py = static_cast<float>(height) / 2 - dot(v, axes.up) / depth * scale;
    return Vec2{px, py};
}

double decode(double e) {
    if (e <= 0.04045) return e / 12.92;
    return std::pow((e + 0.055) / 1.055, 2.4);
}

Errors errors(const ImageRgb& encoded_image, const ImageRgb& encoded_reference) {
    Errors result;
    for (std::size_t i = 0; i < encoded_image.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const double a = decode(encoded_image[i][c]);
            const double b = decode(encoded_reference[i][c]);
            const double d = a - b;
            result.mean += d;
            result.mse += d * d;
            result.relmse += d * d / (b * b + 0.01);
        }
    }
    const double count = 3 * static_cast<double>(encoded_image.size());
    result.mean /= count;
    result.mse /= count;
    result.relmse /= count;
    return result;
}

Cause classify_pixel(const PixelResult& first, const PixelResult& second, float tolerance) {
    const auto differ = [tolerance](float a, float b) { return std::abs(a - b) > tolerance; };
    const Rgb a = first.color, b = second.color;
    if (!differ(a.r, b.r) && !differ(a.g, b.g) && !differ(a.b, b.b)) return Cause::kSame;
    if (first.triangle != second.triangle) return Cause::kEdge;
    if (differ(first.sun, second.sun)) return Cause::kShadow;
    return Cause::kLight;
}

ErrorComponents split_error(const std::vector<ImageRgb>& images, const ImageRgb& reference) {
    ErrorComponents result;
    const double n = static_cast<double>(images.size());
    for (std::size_t i = 0; i < reference.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            double mean = 0;
            for (const ImageRgb& image : images) mean += image[i][c] / n;
            double noise = 0;
            for (const ImageRgb& image : images) noise += (image[i][c] - mean) * (image[i][c] - mean) / (n - 1);
            const double off = mean - reference[i][c];
            result.noise += noise;
            result.squared_bias += off * off - noise / n;
        }
    }
    const double values = 3 * static_cast<double>(reference.size());
    return {result.noise / values, result.squared_bias / values};
}

} // namespace duet::lab
