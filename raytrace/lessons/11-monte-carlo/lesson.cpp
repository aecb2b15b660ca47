// The Cornell box by chance, by light sampling, and by both; plates on which each way fails; and what goes wrong.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/system/parameters.h"
#include "raytrace/lessons/11-monte-carlo/light_sampling.h"

using namespace duet;
using namespace duet::lesson;

// Four metal plates, from polished to rough, under four lights of the same power. (Veach 1997, chapter 9)
Scene plates(float polished) {
    const Vec3 eye{0, 2, 15}, lights{0, 3.3f, -1};
    std::vector<Quad> quads(4);
    for (std::size_t i = 0; i < 4; ++i) {
        const float k = static_cast<float>(i), size = std::pow(0.4f, k), fuzz = polished * std::pow(1.7f, k);
        const Vec3 u{0.9f * size, 0, 0}, v{0, 0.54f * size, 0.72f * size}, right{1.5f * k - 2.2f, 0, 0};
        quads[i] = {lights + right - (u + v) / 2.0f, u, v, matte(Rgb(0)), Rgb(4 - k, 3, 1 + k) / sqr(size)};
        const Vec3 middle{0, 0.9f - 0.8f * k, 1.1f * k - 1}, across{5.6f, 0, 0};
        const Vec3 n = normalize(eye - middle) + normalize(lights - middle), down = normalize(cross(n, across));
        quads.push_back({middle - (across + down) / 2.0f, across, down, metal(Rgb(0.9f), fuzz)});
    }
    quads.push_back({{-12, -2.4f, 12}, {24, 0, 0}, {0, 0, -24}, matte(Rgb(0.4f))});
    return {quads, 4, Camera({.eye = eye, .look_at = {0, 0.75f, 0}, .fov_degrees = 23.5f}, 1, 1), 1};
}

// Draws a picture, and says how many rays it took.
void draw(const std::string& name, Scene& scene, int samples, const Strategy& strategy) {
    scene.rays = 0;
    const auto color = [&](float x, float y, Random& r) { return path_color(scene, x / 128, y / 128, strategy, r); };
    write_image(name + ".png", average_samples(128, 128, samples, color));
    std::printf("%s: %ld rays a pixel\n", name.c_str(), scene.rays / (128 * 128));
}

// Adds a curve: how far means of n samples are off. sample(p, random) is taken 128 times at each of 1500 points p.
template <typename Sample> void measure(Plot& plot, const char* name, const Sample& sample) {
    plot.series.push_back({name, {}});
    std::array<double, 4> difference{}, sum{}; // for n = 1, 4, 16 and 64
    Random random(11);
    for (int i = 0; i < 128 * 1500; ++i) {
        const float point = static_cast<float>(i / 128);
        const double light = sample({std::fmod(0.618034f * point, 1.0f), point / 1500}, random);
        for (int c = 0, n = 1; c < 4; ++c, n *= 4) {
            difference[c] += i % 2 ? light : -light; // of the sums of two times n samples
            if ((i + 1) % (2 * n) == 0) sum[c] += sqr(difference[c]) / (128 * 1500), difference[c] = 0;
        }
    }
    for (int c = 0, n = 1; c < 4; ++c, n *= 4) plot.series.back().points.push_back({1.0 * n, std::sqrt(sum[c] / n)});
}

int main(int argc, char** argv) {
    float size = 1, fuzz = 0.06f;
    int spp = 40;
    read_parameters(argc, argv, {{"light size", size, 0.1f, 3}, {"fuzz", fuzz, 0.01f, 0.2f}, {"samples", spp, 1, 256}});
    Plot integral{"The integral of 4x³ from 0 to 1", "samples", "error (root mean square)", true, true};
    for (const auto& [name, k] : {std::pair{"density 1", 0.0}, {"density 2x", 1.0}, {"density 3x²", 2.0}})
        measure(integral, name, [k = k](Vec2, Random& random) {
            const double x = std::pow(1 - static_cast<double>(random.next()), 1 / (k + 1)); // density (k + 1)·xᵏ
            return 4 * x * x * x / ((k + 1) * std::pow(x, k));
        });
    write_plot("integral.svg", integral);
    const Camera camera({.eye = {0, 1, 6.8f}, .look_at = {0, 1, 0}, .fov_degrees = 19.5f}, 1, 1);
    Scene box{cornell_box(size, 2), 1, camera, 20}, veach = plates(fuzz);
    const Strategy chance{all, none}, light{none, all}, both{power_heuristic, power_heuristic};
    draw("evidence", box, spp, both);
    draw("light", box, spp, light);
    draw("chance", box, 64, chance);
    for (const auto& [name, scene] : {std::pair{"errors-box.svg", &box}, {"errors-plates.svg", &veach}}) {
        Plot plot{"Three ways to find light", "samples per pixel", "error of a pixel (root mean square)", true, true};
        for (const auto& [way, strategy] : {std::pair{"by chance", chance}, {"light sampling", light}, {"both", both}})
            measure(plot, way, [&, &scene = scene, &strategy = strategy](Vec2 p, Random& random) { // below the lights
                return average(Rgbd(path_color(*scene, p.x, 0.12f + 0.88f * p.y, strategy, random)));
            });
        write_plot(name, plot);
    }
    draw("plates-chance", veach, 48, chance);
    draw("plates-light", veach, 36, light);
    draw("plates-both", veach, 36, both);
    draw("twice", box, 16, {all, all}); // three mistakes: both ways count in full;
    draw("area", box, 16, {none, [](float own, float) { return own * 0.47f * 0.38f; }}); // the light's density by area;
    draw("cosine", box, 16, {none, [](float, float other) { return kInvPi / other; }});  // no cosine at the surface
}
