// Lesson 08: a tree of boxes. Writes 500 spheres around an amphora, and what the tree saves.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/system/parameters.h"
#include "raytrace/lessons/07-camera/camera.h"
#include "raytrace/lessons/08-bvh/bvh.h"

#include <ctime>
#include <fstream>

using namespace duet;
using namespace duet::lesson;

constexpr int kWidth = 336, kHeight = 189;
const Camera kCamera({.eye = {0, 1.5f, 4}, .look_at = {0, 0.38f, 0}, .fov_degrees = 24}, kWidth, kHeight);

/// The mean time of a ray among more and more of the objects: in a tree of one leaf (a list), and in a real tree.
Plot time_plot(std::span<Object> objects) {
    Series list{"list", {}}, tree{"tree", {}};
    for (std::size_t count = 7; count < objects.size(); count *= 3)
        for (Series* series : {&list, &tree}) {
            const Bvh root = build(objects.first(count), series == &list ? count : 1);
            Random random(1);
            const std::clock_t start = std::clock();
            for (std::size_t i = 0; i < 12'000'000; i += count) // fewer rays for more objects
                closest_hit(root, kCamera.ray(random.next() * kWidth, random.next() * kHeight, random));
            const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, n = double(count);
            series->points.push_back({n, 1e6 * seconds / (12e6 / n)});
        }
    return {"The nearest of many objects", "objects", "microseconds a ray", true, true, {list, tree}, true};
}

/// What the camera sees in the light of the sun. To the right of `split`: the more boxes a ray tests, the brighter.
template <typename Enter> ImageRgb draw(const Bvh& tree, float split, const Enter& enter) {
    return average_samples(kWidth, kHeight, 9, [&](float x, float y, Random& random) {
        float tests = 0;
        const auto count = [&](const Box3& box, const Ray& ray) { return ++tests, enter(box, ray); };
        const auto hit = closest_hit(tree, kCamera.ray(x, y, random), count);
        if (x > split) return Rgb(3, 1, 0.3f) * sqr(tests / 150);
        if (!hit) return Rgb(0.75f, 0.87f, 1);
        const Vec3 p = hit->p, to_sun{-0.6f, 0.7f, 0.4f};
        const float r = std::hypot(p.x, p.z), sun = closest_hit(tree, {p, to_sun, 1e-3f}, enter) ? 0 : 0.6f;
        const Rgb ring = r < 0.25f ? Rgb(0.7f, 0.2f, 0.1f) : lerp(Rgb(1, 0.7f, 0), Rgb(0.1f, 0.1f, 0.6f), r / 2.3f);
        return (p.y < 1e-3f ? Rgb(0.8f) : ring) * (0.35f + 0.15f * hit->n.y + sun * max(0.0f, dot(hit->n, to_sun)));
    });
}

int main(int argc, char** argv) {
    int spheres = 500, leaf = 1;
    read_parameters(argc, argv, {{"spheres", spheres, 0, 3000}, {"objects in a leaf", leaf, 1, 128}});
    std::vector<Object> objects;
    for (int i = 12; i < 12 + spheres; ++i) { // as the seeds of a sunflower: each is turned by the golden angle
        const float angle = 2.39996f * static_cast<float>(i), r = 0.1f * std::sqrt(static_cast<float>(i));
        const std::vector<Sphere> sphere{{{r * std::cos(angle), 0.07f, r * std::sin(angle)}, 0.07f}};
        const Vec3 center = sphere[0].center, reach{0.07f, 0.07f, 0.07f};
        objects.push_back({{center - reach, center + reach}, [=](const Ray& ray) { return closest_hit(sphere, ray); }});
    }
    for (const float s : {-3.0f, 3.0f}) objects.push_back(triangle_object({-s, 0, -s}, {-s, 0, s}, {s, 0, -s}));
    std::ifstream mesh(DUET_MODELS "meshes/amphora.obj");
    std::vector<Vec3> points;
    for (std::string key, a, b, c; mesh >> key; std::getline(mesh, key)) { // lines "v x y z" and "f 3/1/1 7/2/2 8/3/3"
        if (key == "v" || key == "f") mesh >> a >> b >> c;
        const auto point = [&](const std::string& corner) { return points.at(std::stoul(corner) - 1); };
        if (key == "v") points.push_back({std::stof(a), std::stof(b), std::stof(c)});
        if (key == "f") objects.push_back(triangle_object(point(a), point(b), point(c)));
    }
    write_plot("time.svg", time_plot(objects));
    const Bvh tree = build(objects, std::size_t(leaf));
    write_image("evidence.png", draw(tree, kWidth, enter_box));
    write_image("tests.png", draw(tree, kWidth / 2, enter_box));
    const auto whole_ray = [](const Box3& box, Ray ray) { return ray.t_max = kInfinity, enter_box(box, ray); };
    write_image("too-long.png", draw(tree, kWidth / 2, whole_ray));
    const auto no_flat = [](const Box3& box, const Ray& ray) { return box.low.y < box.high.y && enter_box(box, ray); };
    const auto no_swap = [](const Box3& box, const Ray& ray) { return ray.direction.x > 0 && enter_box(box, ray); };
    write_image("flat.png", draw(tree, kWidth, no_flat));
    write_image("swap.png", draw(tree, kWidth, no_swap));
}
