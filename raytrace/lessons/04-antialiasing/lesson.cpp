// Lesson 04: many samples per pixel. Writes smooth edges beside jagged ones.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/image/srgb.h"
#include "common/system/parameters.h"
#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"
#include "raytrace/lessons/04-antialiasing/sampling.h"

using namespace duet;
using namespace duet::lesson;

/// Four spheres on a fifth, which is the ground.
const std::vector<Sphere> kSpheres{
    {{0, 0, -1.6f}, 0.5f},           {{-0.95f, -0.15f, -1.5f}, 0.35f}, {{0.9f, -0.2f, -1.3f}, 0.3f},
    {{0.3f, -0.37f, -0.95f}, 0.13f}, {{0, -1000.5f, -1.5f}, 1000},
};

/// Numbers of a file as light, which write_image expects.
Rgb decoded(Rgb c) { return {srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b)}; }
/// What one sees at the point (x, y) of a square picture of that size: normals as colors, and a checkerboard.
Rgb scene_color(float x, float y, float size) {
    const Ray ray{{0, 0, 0}, {2 * x / size - 1, 1 - 2 * y / size, -1}};
    const std::optional<Hit> hit = closest_hit(kSpheres, ray);
    if (!hit) return sky_color(ray.direction);
    if (hit->index < 4) return decoded(direction_color(hit->n));
    const bool dark = (std::lround(4 * hit->p.x) + std::lround(4 * hit->p.z)) % 2 != 0;
    return dark ? Rgb(0.1f, 0.25f, 0.1f) : Rgb(0.8f, 0.75f, 0.6f);
}

/// One sample in the center of each pixel, and one at random in each of its n·n cells. Two mistakes: one sample in the
/// corner of each pixel, and samples at the same random points in all pixels.
Vec2 center(int, int, Random&) { return {0.5f, 0.5f}; }
Vec2 in_cells(int i, int samples, Random& random) {
    const int n = static_cast<int>(std::lround(std::sqrt(samples)));
    const Vec2 cell(static_cast<float>(i % n), static_cast<float>(i / n));
    return (cell + random_offset(i, samples, random)) * (1 / static_cast<float>(n));
}
Vec2 corner(int, int, Random&) { return {0, 0}; }
Vec2 same_points(int i, int samples, Random&) {
    Random random(static_cast<std::uint64_t>(i));
    return random_offset(i, samples, random);
}

/// Square pictures of the scene, and of white rings that become thinner and thinner away from the middle.
ImageRgb render(int size, int samples, Offset offset) {
    const auto color = [&](float x, float y, Random&) { return scene_color(x, y, static_cast<float>(size)); };
    return average_samples(size, size, samples, color, offset);
}
ImageRgb rings(int samples, Offset offset) {
    const auto color = [](float x, float y, Random&) { return Rgb(std::sin((sqr(x - 80) + sqr(y - 80)) / 30) > 0); };
    return average_samples(160, 160, samples, color, offset);
}

/// Pictures side by side, each enlarged: the part from (x, y) on, `side` pixels wide and high.
ImageRgb beside(const std::vector<ImageRgb>& images, int x, int y, int side, int zoom) {
    const int panel = side * zoom, step = panel + 4;
    ImageRgb all(static_cast<int>(images.size()) * step - 4, panel, Rgb(1));
    for (int row = 0; row < panel; ++row)
        for (int column = 0; column < all.width(); ++column)
            if (const int from = column % step; from < panel)
                all(column, row) = images[static_cast<std::size_t>(column / step)](x + from / zoom, y + row / zoom);
    return all;
}

/// Plots the root of the mean squared error of green against an image of 4096 samples, and two lines for comparison.
Plot error_plot() {
    const ImageRgb reference = render(54, 4096, in_cells);
    const auto error = [&](int samples, Offset offset) {
        const ImageRgb image = render(54, samples, offset);
        double sum = 0;
        for (std::size_t i = 0; i < image.size(); ++i) sum += sqr(static_cast<double>(image[i].g - reference[i].g));
        return std::sqrt(sum / static_cast<double>(image.size()));
    };
    Plot plot{"Error against the number of samples", "samples per pixel, N", "root of mean squared error", true, true};
    plot.series = {{"random", {}}, {"N^-1/2", {}}, {"in cells", {}}, {"N^-3/4", {}}};
    for (const int n : {1, 2, 3, 4, 6, 8, 12, 16}) {
        const double first = error(1, random_offset), random = error(n * n, random_offset);
        const double values[]{random, first / n, error(n * n, in_cells), first / std::pow(n, 1.5)};
        for (std::size_t i = 0; i < 4; ++i) plot.series[i].points.push_back({1.0 * n * n, values[i]});
    }
    return plot;
}

int main(int argc, char** argv) {
    int cells = 8, count = 4;
    read_parameters(argc, argv, {{"cells", cells, 1, 16, "per side of a pixel"}, {"random samples", count, 1, 64}});
    const ImageRgb jagged = render(270, 1, center), smooth = render(270, cells * cells, in_cells);
    write_image("evidence.png", beside({jagged, smooth}, 0, 0, 270, 1));
    write_image("zoom.png", beside({jagged, render(270, count, random_offset), smooth}, 180, 140, 48, 4));
    const ImageRgb fixed = rings(count, same_points), random = rings(count, random_offset), many = rings(64, in_cells);
    write_image("rings.png", beside({rings(1, center), fixed, random, many}, 0, 0, 160, 1));
    // Two mistakes: the numbers of the file are averaged, and each is divided by the 36 samples before they are added.
    const auto byte = [](float x, float y, Random&) {
        return Rgb(static_cast<float>(srgb_encode_8bit(scene_color(x, y, 160).g) / 36));
    };
    ImageRgb dark = many, steps = average_samples(160, 160, 36, byte);
    for (Rgb& pixel : dark.pixels()) pixel = decoded(pixel);
    for (Rgb& pixel : steps.pixels()) pixel = decoded(pixel * (36 / 255.0f));
    write_image("numbers.png", beside({dark, steps}, 0, 0, 160, 1));
    write_plot("error.svg", error_plot());
    write_image("corners.png", beside({render(24, 1, center), render(24, 1, corner)}, 0, 0, 24, 8));
}
