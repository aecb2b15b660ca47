// Matte spheres under the sky, and what goes wrong with their shadows and their brightness.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/image/srgb.h"
#include "common/system/parameters.h"
#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/05-diffuse/diffuse.h"

#include <cstdio>

using namespace duet;
using namespace duet::lesson;

// Ten spheres on a large one, the ground. Coordinates are meters; the camera is at zero.
struct Scene {
    std::vector<Sphere> spheres{{{0, -101, -4}, 100}};
    std::vector<Rgb> albedos{{0.62f, 0.6f, 0.55f}};
    Scene() {
        add(-1.15f, -3.6f, 0.75f, {0.75f, 0.16f, 0.1f}), add(0.45f, -4.6f, 0.85f, {0.9f, 0.88f, 0.82f});
        add(1.75f, -3.4f, 0.6f, {0.1f, 0.28f, 0.62f}), add(-2.6f, -4.8f, 0.8f, {0.16f, 0.45f, 0.2f});
        add(0.3f, -2.9f, 0.32f, {0.92f, 0.6f, 0.1f}), add(-0.3f, -2.5f, 0.18f, {0.1f, 0.5f, 0.52f});
        add(1.02f, -2.6f, 0.22f, {0.55f, 0.12f, 0.4f}), add(2.9f, -4.4f, 0.5f, {0.9f, 0.42f, 0.25f});
        add(-1.9f, -2.75f, 0.28f, {0.85f, 0.8f, 0.5f}), add(0.75f, -2.15f, 0.1f, {0.85f, 0.25f, 0.3f});
    }

    // A sphere that rests on the ground: its center is the sum of both radii above the center of the ground.
    void add(float x, float z, float radius, Rgb albedo) {
        const float reach = 100 + radius, aside = x * x + (z + 4) * (z + 4);
        spheres.push_back({{x, std::sqrt(reach * reach - aside) - 101, z}, radius});
        albedos.push_back(albedo);
    }
};

// How the ray that goes on keeps away from the surface that it leaves.
enum class RayStart { kExact, kEpsilon, kErrorBound };
float epsilon = 1e-3f; // of kEpsilon, in meters; main reads it

// The light that comes along a ray: that of the sky, dimmed by each surface it came by.
Rgb matte_color(const Scene& scene, Ray ray, RayStart start, Random& random) {
    Rgb weight(1);
    for (int bounces = 0; bounces < 50; ++bounces) {
        const std::optional<Hit> hit = closest_hit(scene.spheres, ray);
        if (!hit) return weight * sky_color(ray.direction);
        weight *= scene.albedos[hit->index];
        const Vec3 origin = start == RayStart::kErrorBound ? offset_point(scene.spheres[hit->index], *hit) : hit->p;
        ray = {origin, random_diffuse_direction(hit->n, random), start == RayStart::kEpsilon ? epsilon : 0};
    }
    return Rgb(0);
}

// A picture's size in pixels, its upper left corner where the view is at distance 1, and the side of a pixel there.
struct Window {
    int width, height;
    float left, top, pixel;
};
constexpr Window kWhole{400, 225, -0.86f, 0.44f, 1 / 225.0f}, kHalf{160, 90, -0.86f, 0.44f, 1 / 90.0f},
    kClose{176, 99, -0.3f, 0.06f, 1 / 198.0f};

// The scene with all lengths times `scale`. The picture should not depend on it: only meters become kilometers.
ImageRgb render(const Window& window, int samples, RayStart start, float scale = 1) {
    Scene scene;
    for (Sphere& sphere : scene.spheres) sphere = {sphere.center * scale, sphere.radius * scale};
    return average_samples(window.width, window.height, samples, [&](float x, float y, Random& random) {
        const Ray ray{{0, 0, 0}, {window.left + x * window.pixel, window.top - y * window.pixel, -1}};
        return matte_color(scene, ray, start, random);
    });
}

// The picture twice. On the left its values stand in the file as they are. write_image encodes all values for the
// screen, so those that must not be encoded are decoded first.
ImageRgb without_and_with_gamma(const ImageRgb& image) {
    ImageRgb both(2 * image.width(), image.height());
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Rgb color = both(image.width() + x, y) = image(x, y);
            both(x, y) = {srgb_decode(color.r), srgb_decode(color.g), srgb_decode(color.b)};
        }
    return both;
}

// How often directions leave a surface at each angle from its normal: a million of them, counted by 3 degrees.
Plot angles_of_directions() {
    std::vector<double> counts(30);
    Random random(1);
    for (int i = 0; i < 1'000'000; ++i) {
        const float cosine = normalize(random_diffuse_direction({0, 0, 1}, random)).z;
        const double angle = degrees(std::acos(static_cast<double>(clamp(cosine, 0.0f, 1.0f))));
        ++counts[static_cast<std::size_t>(min(angle / 3, 29.0))];
    }
    Series counted{"counted", {}}, lambert{"Lambert's law", {}}, even{"all alike", {}};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double angle = 3 * static_cast<double>(i) + 1.5, theta = radians(angle);
        counted.points.push_back({angle, counts[i] / 30'000});
        lambert.points.push_back({angle, 100 * radians(1) * std::sin(2 * theta)});
        even.points.push_back({angle, 100 * radians(1) * std::sin(theta)});
    }
    return {.title = "A million directions off a matte surface",
            .x_label = "angle from the normal, degrees",
            .y_label = "percent of them per degree",
            .series = {counted, lambert, even}};
}

int main(int argc, char** argv) {
    int samples = 256;
    read_parameters(argc, argv, {{"samples", samples, 1, 1024}, {"epsilon", epsilon, 0, 0.1f, "meters"}});
    write_image("evidence.png", render(kWhole, samples, RayStart::kErrorBound));
    write_image("gamma.png", without_and_with_gamma(render(kHalf, 128, RayStart::kErrorBound)));
    write_image("zero.png", render(kClose, 128, RayStart::kExact));
    write_plot("angles.svg", angles_of_directions());
    write_image("error.png", render(kClose, 128, RayStart::kErrorBound));
    // A power of two as scale changes no digit of a float: pictures differ only where the program mixes in meters.
    for (const auto& [name, scale] : {std::pair{"small", 0x1p-10f}, {"middle", 1.0f}, {"large", 0x1p10f}}) {
        write_image(std::string("epsilon-") + name + ".png", render(kClose, 128, RayStart::kEpsilon, scale));
        for (const RayStart start : {RayStart::kExact, RayStart::kErrorBound})
            if (render(kClose, 2, start, scale).pixels() != render(kClose, 2, start).pixels()) return 1;
    }
    std::puts("Without an epsilon, the pictures at all three scales are equal to the last bit.");
}
