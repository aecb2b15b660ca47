// The Cornell box by chance alone: how light bounces, and how much noise a light of each size makes.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/system/parameters.h"
#include "raytrace/lessons/07-camera/camera.h"
#include "raytrace/lessons/10-cornell-box/quads.h"

#include <cstdio>

using namespace duet;
using namespace duet::lesson;

// Cameras whose pictures are 1 wide and 1 high, so that x and y run from 0 to 1. The second looks up at the light.
const Camera kCamera({.eye = {0, 1, 6.8f}, .look_at = {0, 1, 0}, .fov_degrees = 19.5f}, 1, 1),
    kBelow({.eye = {0, 0.7f, 0.95f}, .look_at = {0, 1.98f, -0.03f}, .fov_degrees = 50}, 1, 1);

// A square picture. Each channel of a path's light above `limit` is cut off: a mistake, unless the limit is infinite.
ImageRgb render(const std::vector<Quad>& quads, int size, int samples, int bounces = 30, float limit = kInfinity,
                const Camera& camera = kCamera) {
    const float pixel = 1 / static_cast<float>(size);
    return average_samples(size, size, samples, [&](float x, float y, Random& random) {
        const Rgb light = path_color(quads, camera.ray(x * pixel, y * pixel, random), bounces, random);
        return Rgb(min(light.r, limit), min(light.g, limit), min(light.b, limit));
    });
}

// How far a pixel is off: the root of the mean square. Two means of other random numbers differ by √2 times that, so
// the true picture need not be known. Pixels at the top are left out, since they see the light itself.
double noise(const std::vector<Quad>& quads, int samples) {
    Random random(10);
    double sum = 0, pixels = 500 + 32'000 / samples; // few samples need many pixels to hold rare bright paths
    for (int i = 0; i < pixels; ++i) {
        const float x = random.next(), y = 0.12f + 0.88f * random.next();
        Rgb difference;
        for (int k = 0; k < 2 * samples; ++k)
            difference += path_color(quads, kCamera.ray(x, y, random), 30, random) * (k % 2 ? 1.0f : -1.0f);
        sum += sqr(static_cast<double>(average(difference)) / samples) / 2;
    }
    return std::sqrt(sum / pixels);
}

// Pictures of one size side by side, with a white gap of 4 pixels between them.
ImageRgb side_by_side(const std::vector<ImageRgb>& images) {
    const int size = images[0].width(), step = size + 4;
    ImageRgb row(step * static_cast<int>(images.size()) - 4, size, Rgb(1));
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < row.width(); ++x)
            if (x % step < size) row(x, y) = images[static_cast<std::size_t>(x / step)](x % step, y);
    return row;
}

int main(int argc, char** argv) {
    float side = 2, limit = 1;
    int spp = 96;
    read_parameters(argc, argv, {{"light size", side, 0.2f, 3}, {"limit", limit, 0.1f, 10}, {"samples", spp, 1, 400}});
    const std::vector<Quad> box = cornell_box(side, 2); // a large light, and a bright one
    write_image("evidence.png", render(box, 160, spp));
    const ImageRgb right = render(box, 96, 40);
    write_image("bounces.png", side_by_side({render(box, 96, 40, 1), render(box, 96, 40, 2), right}));
    write_image("clamped.png", side_by_side({right, render(box, 96, 40, 30, limit)}));
    std::vector<Quad> upward = box, both = box; // the light's front up, and a second front 1 mm above the first
    upward[0] = {box[0].corner, box[0].v, box[0].u, box[0].material, box[0].emission};
    both.push_back(upward[0]), both.back().corner.y += 1e-3f;
    const auto below = [](const std::vector<Quad>& quads) { return render(quads, 96, 40, 30, kInfinity, kBelow); };
    write_image("sides.png", side_by_side({below(box), below(both), below(upward)}));
    std::vector<ImageRgb> sizes;
    Plot plot{"Noise of the Cornell box", "samples per pixel", "error of a pixel (root mean square)", true, true};
    for (const auto& [name, size] : {std::pair{"twice as wide", 2.0f}, {"as it is", 1.0f}, {"half as wide", 0.5f}}) {
        sizes.push_back(render(cornell_box(size, 2), 96, 24));
        plot.series.push_back({name, {}});
        for (int n = 1; n <= 64; n *= 4) plot.series.back().points.push_back({1.0 * n, noise(cornell_box(size), n)});
        std::printf("A light %s: error %.3f with 64 samples\n", name, plot.series.back().points.back().y);
    }
    write_image("sizes.png", side_by_side(sizes));
    write_plot("noise.svg", plot);
}
