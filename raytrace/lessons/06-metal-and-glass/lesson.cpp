// Metal, glass and matte spheres side by side, four mistakes with glass, and light between mirrors.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/system/parameters.h"
#include "raytrace/lessons/06-metal-and-glass/materials.h"

using namespace duet;
using namespace duet::lesson;

struct World {
    std::vector<Sphere> spheres;
    std::vector<Material> materials;
    std::size_t mistaken = 99; // from which sphere on hits get a mistake; there is one for each of 2, 3, 4, and 25
    void add(Vec3 p, float radius, const Material& m) { spheres.push_back({p, radius}), materials.push_back(m); }
    std::optional<Hit> closest(const Ray& ray) const {
        std::optional<Hit> hit = closest_hit(spheres, ray);
        if (!hit || hit->index < mistaken) return hit;
        if (hit->index == 2) hit->front = true;        // the same ratio on the way in and out
        if (hit->index == 3) hit->front = !hit->front; // the ratio upside down
        if (hit->index == 4) hit->n *= 0.8f;           // a normal that isn't 1 long
        if (hit->index == 25 && hit->front && !refract(normalize(ray.direction), hit->n, 1.5f)) hit->n *= NAN;
        return hit;
    }
};

// Four large spheres of these materials in a row on the ground, and 20 small matte ones before and behind them.
World row_of(const std::vector<Material>& row, std::size_t mistaken = 99) {
    World world{{}, {}, mistaken};
    const Rgb colors[] = {{0.8f, 0.2f, 0.1f}, {0.9f, 0.6f, 0.1f}, {0.15f, 0.5f, 0.2f}, {0.1f, 0.4f, 0.7f}, Rgb(0.85f)};
    world.add({0, -303, -18}, 300, matte({0.5f, 0.48f, 0.44f}));
    for (std::size_t i = 0; i < 4; ++i) world.add({2.1f * static_cast<float>(i) - 3.15f, -2, -18}, 1, row[i]);
    Random random(6);
    for (std::size_t i = 0; i < 20; ++i) {
        const float radius = (i < 8 ? 0.1f : 0.25f) * (1 + random.next());
        const float x = 10 * random.next() - 5, z = i < 8 ? -16 + 2 * random.next() : -20 - 4 * random.next();
        world.add({x, radius - 3.01f, z}, radius, matte(colors[i % 5]));
    }
    return world;
}

// The picture of a camera at zero that looks along -z and a little down.
ImageRgb render(const World& world, int width, int height, int samples, int bounces = 50) {
    const float w = static_cast<float>(width), h = static_cast<float>(height), pixel = 0.5f / w;
    return average_samples(width, height, samples, [&](float x, float y, Random& random) {
        const Ray ray{{0, 0, 0}, {(x - 0.5f * w) * pixel, (0.5f * h - y) * pixel - 0.13f, -1}};
        return path_color([&](const Ray& r) { return world.closest(r); }, world.materials, ray, bounces, random);
    });
}

int main(int argc, char** argv) {
    float index = 1.5f, fuzz = 0.05f;
    int samples = 128;
    read_parameters(argc, argv, {{"index of refraction", index, 1, 2.5f}, {"fuzz", fuzz, 0, 1},
                                 {"samples", samples, 1, 512}});
    const Material clear = glass(index), bubble = glass(1 / index); // a bubble makes the fourth sphere hollow
    World world = row_of({matte({0.7f, 0.12f, 0.1f}), clear, metal({0.95f, 0.72f, 0.35f}, fuzz), clear}), mirrors;
    world.add(world.spheres[4].center, 0.9f, bubble);
    write_image("evidence.png", render(world, 380, 138, samples));
    world.mistaken = 25, write_image("nan.png", render(world, 176, 64, 16)), world.mistaken = 99;
    for (const int n : {1, 2, 5}) write_image("limit-" + std::to_string(n) + ".png", render(world, 176, 60, 48, n));
    const auto steel = [](float f) { return metal(Rgb(0.9f), f); };
    write_image("fuzz.png", render(row_of({steel(0), steel(0.1f), steel(0.3f), steel(1)}), 300, 100, 80));
    write_image("glass.png", render(row_of({glass(1.33f), clear, glass(2.42f), bubble}), 300, 100, 80));
    write_image("mistakes.png", render(row_of({clear, clear, clear, clear}, 2), 300, 100, 80));
    mirrors.add({0, -0.671f, -5.593f}, 1, metal({0.9f, 0.9f, 0.95f})); // touches the others, behind their gap
    mirrors.add({0, 0.67f, -4.109f}, 1, metal({0.95f, 0.8f, 0.5f}));
    mirrors.add({-1, -1.05f, -3.903f}, 1, metal({0.9f, 0.6f, 0.5f}));
    mirrors.add({1, -1.05f, -3.903f}, 1, metal({0.55f, 0.75f, 0.9f}));
    write_image("mirrors.png", render(mirrors, 184, 184, 16, 1000));
    Plot plot{.title = "Light that glass reflects", .x_label = "angle from the normal, degrees", .y_label = "percent"};
    plot.series = {{"Fresnel's equations", {}}, {"Schlick", {}}};
    for (double angle = 0; angle < 90; ++angle) {
        const double c = std::cos(radians(angle)), t = std::sqrt(1 - (1 - c * c) / 2.25);
        const double across = (c - 1.5 * t) / (c + 1.5 * t), along = (1.5 * c - t) / (1.5 * c + t);
        plot.series[0].points.push_back({angle, 50 * (across * across + along * along)});
        plot.series[1].points.push_back({angle, 100 * static_cast<double>(schlick(static_cast<float>(c), 1.5f))});
    }
    write_plot("fresnel.svg", plot);
}
