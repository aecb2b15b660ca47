// Lesson 03: the nearest of many surfaces. Writes spheres on a large sphere that serves as ground.
#include "common/image/image_file.h"
#include "common/image/srgb.h"
#include "common/system/parameters.h"
#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"

#include <array>
#include <cstdio>

using namespace duet;
using namespace duet::lesson;

constexpr int kWidth = 480, kHeight = 270;

/// The ground is a sphere of radius 100: so large that it looks flat.
const std::vector<Sphere> kSpheres{
    {{0, 0, -1.5f}, 0.5f},        {{-1.1f, -0.1f, -1.9f}, 0.4f}, {{1.0f, -0.2f, -1.6f}, 0.3f},
    {{0.35f, -0.35f, -1}, 0.15f}, {{-0.45f, -0.38f, -1}, 0.12f}, {{0, -100.5f, -1.5f}, 100},
};

/// The color of a normal, as in lesson 02.
Rgb normal_color(Vec3 n) {
    const auto channel = [](float coordinate) { return srgb_decode(0.5f * (coordinate + 1)); };
    return {channel(n.x), channel(n.y), channel(n.z)};
}

/// The mistake: each hit replaces the one before, nearer or not, so the last sphere of the list covers all others.
std::optional<Hit> last_hit(const std::vector<Sphere>& spheres, const Ray& ray) {
    std::optional<Hit> last;
    for (std::size_t i = 0; i < spheres.size(); ++i)
        if (const auto t = hit_sphere(spheres[i], ray))
            last = make_hit(ray, *t, (ray.at(*t) - spheres[i].center) / spheres[i].radius, i);
    return last;
}

/// Draws the picture that `find` and `shade` make together: a ray through the center of each pixel of a window of
/// height 2 at distance 1, as in lesson 02.
template <typename Find, typename Shade> ImageRgb draw(Vec3 eye, const Find& find, const Shade& shade) {
    ImageRgb image(kWidth, kHeight);
    const float pixel = 2.0f / kHeight;
    for (int row = 0; row < kHeight; ++row)
        for (int column = 0; column < kWidth; ++column) {
            const float x = static_cast<float>(column) + 0.5f, y = static_cast<float>(row) + 0.5f;
            const Ray ray{eye, {(x - 0.5f * kWidth) * pixel, (0.5f * kHeight - y) * pixel, -1}};
            const std::optional<Hit> hit = find(kSpheres, ray);
            image(column, row) = hit ? shade(*hit) : sky_color(ray.direction);
        }
    return image;
}

/// Which sphere was hit, as one of six colors.
Rgb index_color(const Hit& hit) {
    constexpr std::array<Rgb, 6> kColors{Rgb(0.8f, 0.1f, 0.1f), Rgb(0.1f, 0.4f, 0.8f), Rgb(0.9f, 0.6f, 0.1f),
                                         Rgb(0.1f, 0.6f, 0.3f), Rgb(0.5f, 0.2f, 0.6f), Rgb(0.6f, 0.6f, 0.55f)};
    return kColors[hit.index];
}

/// From inside (the eye is in the middle sphere): with the normal turned to the ray, and as it points outward.
Rgb turned(const Hit& hit) { return normal_color(hit.n); }
Rgb outward(const Hit& hit) { return normal_color(hit.front ? hit.n : -hit.n); }

int main(int argc, char** argv) {
    Vec3 eye{0, 0, 0}, inside{0, 0, -1.3f};
    read_parameters(argc, argv, {{"eye x", eye.x, -1.5f, 1.5f}, {"eye y", eye.y, -0.4f, 2}, {"eye z", eye.z, -2, 3},
                                 {"inner eye z", inside.z, -1.95f, -1.05f}});
    write_image("evidence.png", draw(eye, closest_hit, turned));
    write_image("index.png", draw(eye, closest_hit, index_color));
    write_image("last.png", draw(eye, last_hit, turned));
    write_image("inside.png", draw(inside, closest_hit, turned));
    write_image("inside-outward.png", draw(inside, closest_hit, outward));
    std::printf("%d rays, each tested against %zu spheres: %zu tests\n", kWidth * kHeight, kSpheres.size(),
                kSpheres.size() * kWidth * kHeight);
}
