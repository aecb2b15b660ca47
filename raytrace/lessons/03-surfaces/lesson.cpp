// Lesson 03: the nearest of many surfaces. Writes spheres on a large sphere that serves as ground.
#include "common/image/image_file.h"
#include "raytrace/lessons/03-surfaces/scene.h"

#include <cstdio>

using namespace duet;
using namespace duet::lesson;

/// Which sphere of the list was hit: a hue for each index.
Rgb index_color(std::size_t index) {
    const auto wave = [&](float shift) { return 0.5f + 0.45f * std::cos(2.4f * static_cast<float>(index) + shift); };
    return index == 0 ? Rgb(0.25f) : Rgb(sqr(wave(0)), sqr(wave(2.1f)), sqr(wave(4.2f)));
}

/// How far away: white at 2 m and nearer, half as bright for every 2 m more.
Rgb depth_color(const Ray& ray, float t) { return Rgb(min(std::exp2(1 - t * length(ray.direction) / 2), 1.0f)); }

/// The mistake: each hit replaces the one before, nearer or not, so the last sphere of the list covers all others.
std::optional<Hit> last_hit(const std::vector<Sphere>& spheres, const Ray& ray) {
    std::optional<Hit> last;
    for (std::size_t i = 0; i < spheres.size(); ++i)
        if (const auto t = hit_sphere(spheres[i], ray))
            last = make_hit(ray, *t, (ray.at(*t) - spheres[i].center) / spheres[i].radius, i);
    return last;
}

/// The view from inside the large sphere. With `turned` the normals are on the side from which the ray came, as Hit has
/// them; else they point out of the sphere.
Rgb inside_color(const std::vector<Sphere>& spheres, Ray ray, bool turned) {
    ray.origin = spheres[1].center;
    const Hit hit = *closest_hit(spheres, ray); // no ray leaves the sphere without a hit
    return normal_color(turned || hit.front ? hit.n : -hit.n);
}

int main() {
    const std::vector<Sphere> spheres = sphere_scene();
    const auto write = [](const char* name, const auto& color) { write_image(name, draw(480, 270, 1, color)); };
    write("evidence.png", [&](const Ray& ray) { return scene_color(spheres, ray); });
    write("index.png", [&](const Ray& ray) {
        const auto hit = closest_hit(spheres, ray);
        return hit ? index_color(hit->index) : sky_color(ray.direction);
    });
    write("depth.png", [&](const Ray& ray) {
        const auto hit = closest_hit(spheres, ray);
        return hit ? depth_color(ray, hit->t) : Rgb(0);
    });
    const std::vector<Sphere> reversed(spheres.rbegin(), spheres.rend()); // the ground is the last one now
    write("last.png", [&](const Ray& ray) {
        const auto hit = last_hit(reversed, ray);
        return hit ? index_color(spheres.size() - 1 - hit->index) : sky_color(ray.direction);
    });
    write("inside.png", [&](const Ray& ray) { return inside_color(spheres, ray, ray.direction.x < 0); });
    const std::vector<Sphere> huge = sphere_scene(1e7f);
    write("huge.png", [&](const Ray& ray) { return scene_color(huge, ray); });
    std::printf("%d rays, each tested against %zu spheres: %zu tests\n", 480 * 270, spheres.size(),
                spheres.size() * 480 * 270);
}
