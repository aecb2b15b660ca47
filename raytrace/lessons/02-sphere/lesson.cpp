// Lesson 02: a ray meets a sphere. Writes a sphere colored by its normal, under a blue-white sky.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "raytrace/lessons/02-sphere/eye.h"
#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/02-sphere/sphere.h"

#include <cstdio>

using namespace duet;
using namespace duet::lesson;

const Sphere kSphere{{0, 0, -1}, 0.5f};

/// The first picture: red where the ray meets the sphere, sky where it doesn't.
Rgb disk_color(const Ray& ray) { return hit_sphere(kSphere, ray) ? Rgb(0.7f, 0.06f, 0.05f) : sky_color(ray.direction); }

/// The lesson's picture: the normal at the point that the ray meets. Any other divisor than the radius is a mistake.
Rgb sphere_color(const Ray& ray, float divisor) {
    const auto t = hit_sphere(kSphere, ray);
    return t ? normal_color((ray.at(*t) - kSphere.center) / divisor) : sky_color(ray.direction);
}

/// A sphere of colored fog: the longer the ray's way through it, the less of the sky is left.
Rgb fog_color(Ray ray) {
    const Rgb sky = sky_color(ray.direction);
    const auto enters = hit_sphere(kSphere, ray);
    if (!enters) return sky;
    ray.t_min = *enters; // only points beyond the first count now
    const auto leaves = hit_sphere(kSphere, ray);
    const float way = leaves ? (*leaves - *enters) * length(ray.direction) : 0;
    return lerp(sky, Rgb(0.85f, 0.25f, 0.03f), way / (2 * kSphere.radius));
}

/// A mistake: t is taken for the distance whatever the length of the direction. It is on the right half of this
/// picture; on the left the direction is normalized first. The rings are 0.04 apart, from 0.5 on.
Rgb ring_color(Ray ray) {
    if (ray.direction.x < 0) ray.direction = normalize(ray.direction);
    const auto t = hit_sphere(kSphere, ray);
    if (!t) return sky_color(ray.direction);
    const float rings = (*t - 0.5f) / 0.04f;
    return static_cast<int>(rings) % 2 == 0 ? Rgb(0.02f, 0.08f, 0.25f) : Rgb(0.9f, 0.6f, 0.15f);
}

/// The quadratic of four rays along -z, at these heights above the center: |p(t) - center|² - radius² as t grows. It is
/// zero where the ray meets the sphere.
Plot quadratics() {
    Plot plot{.title = "Four rays, from the center to past the sphere", .x_label = "t", .y_label = "|p(t) - c|² - r²"};
    plot.series.push_back({"zero: the surface", {{0, 0}, {2, 0}}});
    for (const auto& [name, height] :
         {std::pair{"missed", 0.7f}, {"tangent", 0.5f}, {"off axis", 0.3f}, {"center", 0.0f}}) {
        const Ray ray{{0, height, 0}, {0, 0, -1}};
        Series series{name, {}};
        for (float t = 0; t < 2.01f; t += 0.05f)
            series.points.push_back({t, length_squared(ray.at(t) - kSphere.center) - sqr(kSphere.radius)});
        plot.series.push_back(series);
    }
    return plot;
}

int main() {
    int hits = 0;
    const auto write = [](const char* name, const auto& color) { write_image(name, draw(480, 270, 1.5f, color)); };
    write("disk.png", [&](const Ray& ray) { return hits += hit_sphere(kSphere, ray).has_value(), disk_color(ray); });
    write("evidence.png", [](const Ray& ray) { return sphere_color(ray, kSphere.radius); });
    write("unnormalized.png", [](const Ray& ray) { return sphere_color(ray, 1); });
    write("fog.png", fog_color);
    write("rings.png", ring_color);
    write_plot("quadratics.svg", quadratics());
    std::printf("%d of %d rays meet the sphere.\n", hits, 480 * 270);
}
