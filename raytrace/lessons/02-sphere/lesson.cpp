// Lesson 02: a ray meets a sphere. Writes a sphere colored by its normal, under a blue-white sky.
#include "common/image/image_file.h"
#include "common/image/srgb.h"
#include "common/system/parameters.h"
#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/02-sphere/sphere.h"

#include <cstdio>

using namespace duet;
using namespace duet::lesson;

constexpr int kWidth = 480, kHeight = 270;

/// The ray from the eye at the origin through a point of the picture, (x, y) in pixels from the upper left corner. The
/// picture is a window of height 2 at distance 1, so a direction has x and y in these units, and z = -1.
Ray eye_ray(float x, float y) {
    const float pixel = 2.0f / kHeight;
    return {{0, 0, 0}, {(x - 0.5f * kWidth) * pixel, (0.5f * kHeight - y) * pixel, -1}};
}

/// One color for each pixel: that of the ray through its center.
template <typename Color> ImageRgb draw(const Color& color) {
    ImageRgb image(kWidth, kHeight);
    for (int row = 0; row < kHeight; ++row)
        for (int column = 0; column < kWidth; ++column)
            image(column, row) = color(eye_ray(static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f));
    return image;
}

/// A unit normal as a color: each coordinate from [-1, 1] to [0, 1]. These are the numbers that the file shall hold.
/// write_image expects light and encodes it, so the numbers are decoded here.
Rgb normal_color(Vec3 n) {
    const auto channel = [](float coordinate) { return srgb_decode(0.5f * (coordinate + 1)); };
    return {channel(n.x), channel(n.y), channel(n.z)};
}

Sphere sphere{{0, 0, -1}, 0.5f};

/// The first picture: red where the ray meets the sphere, sky where it doesn't.
Rgb disk_color(const Ray& ray) { return hit_sphere(sphere, ray) ? Rgb(0.8f, 0.1f, 0.1f) : sky_color(ray.direction); }

/// The lesson's picture: the normal at the point that the ray meets.
Rgb sphere_color(const Ray& ray) {
    const auto t = hit_sphere(sphere, ray);
    if (!t) return sky_color(ray.direction);
    return normal_color((ray.at(*t) - sphere.center) / sphere.radius);
}

/// The classic mistake: the vector from the center to the point is used as it is. It is as long as the radius.
Rgb unnormalized_color(const Ray& ray) {
    const auto t = hit_sphere(sphere, ray);
    return t ? normal_color(ray.at(*t) - sphere.center) : sky_color(ray.direction);
}

/// Another: points with negative t count. The only sphere stands behind the eye, to its left and above it.
Rgb behind_color(Ray ray) {
    ray.t_min = -kInfinity;
    const Sphere behind{{-0.4f, 0.2f, 1}, 0.5f};
    const auto t = hit_sphere(behind, ray);
    return t ? normal_color((ray.at(*t) - behind.center) / behind.radius) : sky_color(ray.direction);
}

/// Another: t is taken for the distance, though the ray's direction is longer than 1 off the middle of the picture.
/// Shown is the distance, black at 0.5 and white at 0.87, where the rim of the sphere is.
Rgb depth_color(const Ray& ray, bool unit_length) {
    Ray used = ray;
    if (unit_length) used.direction = normalize(ray.direction);
    const auto t = hit_sphere(sphere, used);
    return t ? Rgb(clamp((*t - 0.5f) / 0.37f, 0.0f, 1.0f)) : Rgb(0.1f, 0.1f, 0.3f);
}

/// How far the ray's way through the sphere is, from its first point on the sphere to its second.
Rgb chord_color(Ray ray) {
    const auto first = hit_sphere(sphere, ray);
    if (!first) return {0.1f, 0.1f, 0.3f};
    ray.t_min = *first; // what is left of the ray has the second point
    const auto second = hit_sphere(sphere, ray);
    const float chord = second ? (*second - *first) * length(ray.direction) : 0; // 0 for a tangent
    return lerp(Rgb(0.9f, 0.5f, 0.1f), Rgb(1, 1, 0.8f), chord / (2 * sphere.radius));
}

int main(int argc, char** argv) {
    read_parameters(argc, argv, {{"center x", sphere.center.x, -2, 2}, {"center z", sphere.center.z, -4, 1},
                                 {"radius", sphere.radius, 0.05f, 2}});
    write_image("disk.png", draw(disk_color));
    write_image("evidence.png", draw(sphere_color));
    write_image("chord.png", draw(chord_color));
    write_image("unnormalized.png", draw(unnormalized_color));
    write_image("behind.png", draw(behind_color));
    write_image("depth.png", draw([](const Ray& ray) { return depth_color(ray, true); }));
    write_image("depth-wrong.png", draw([](const Ray& ray) { return depth_color(ray, false); }));
    int hits = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            hits += hit_sphere(sphere, eye_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f)).has_value();
    std::printf("%d of %d rays meet the sphere\n", hits, kWidth * kHeight);
}
