// Lesson 04: many samples a pixel. Writes smooth edges beside jagged ones.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/image/srgb.h"
#include "raytrace/lessons/03-surfaces/scene.h"
#include "raytrace/lessons/04-antialiasing/sampling.h"

#include <cstdio>

using namespace duet;
using namespace duet::lesson;

/// The scene of lesson 03 with that many samples a pixel.
ImageRgb render(int width, int height, int samples) {
    const std::vector<Sphere> spheres = sphere_scene();
    return average_samples(width, height, samples, [&](float x, float y, Random&) {
        return scene_color(spheres, eye_ray(x, y, width, height, 1));
    });
}

/// A star of 48 black rays on white around the middle of a square picture. Toward the middle they are thinner than any
/// pixel.
constexpr int kStar = 197;
Rgb star(float x, float y) {
    return Rgb(std::sin(48 * std::atan2(y - kStar / 2.0f, x - kStar / 2.0f)) > 0 ? 1.0f : 0.0f);
}

/// The mistake: the numbers of the file are averaged, not the light. (They are decoded at last, since write_image will
/// encode them.)
ImageRgb encoded_average(int samples) {
    const auto encoded = [](float x, float y, Random&) { return Rgb(srgb_encode(star(x, y).r)); };
    ImageRgb image = average_samples(kStar, kStar, samples, encoded);
    for (Rgb& pixel : image.pixels()) pixel = Rgb(srgb_decode(pixel.r));
    return image;
}

/// Pictures of equal size side by side, each enlarged: its part from (x, y) on, `side` pixels wide and high.
ImageRgb side_by_side(const std::vector<ImageRgb>& images, int x, int y, int side, int zoom) {
    const int panel = side * zoom, gap = 4;
    ImageRgb all(static_cast<int>(images.size()) * (panel + gap) - gap, panel, Rgb(1));
    for (std::size_t i = 0; i < images.size(); ++i)
        for (int row = 0; row < panel; ++row)
            for (int column = 0; column < panel; ++column)
                all(static_cast<int>(i) * (panel + gap) + column, row) = images[i](x + column / zoom, y + row / zoom);
    return all;
}

/// The square root of the mean squared difference of all components.
double rms_difference(const ImageRgb& a, const ImageRgb& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            sum += sqr(static_cast<double>(a[i][channel] - b[i][channel]));
    return std::sqrt(sum / static_cast<double>(3 * a.size()));
}

/// The difference from a picture of 4096 samples, for 1 to 128 samples, and the line 1/√N through the first point.
Plot error_plot() {
    constexpr int kWidth = 96, kHeight = 54;
    const ImageRgb reference = render(kWidth, kHeight, 4096);
    Series measured{"measured", {}}, law{"1/√N", {}};
    for (int samples = 1; samples <= 128; samples *= 2) {
        measured.points.push_back({1.0 * samples, rms_difference(render(kWidth, kHeight, samples), reference)});
        law.points.push_back({1.0 * samples, measured.points[0].y / std::sqrt(samples)});
    }
    return {.title = "Error against the number of samples",
            .x_label = "samples a pixel",
            .y_label = "root of the mean squared error",
            .log_x = true,
            .log_y = true,
            .series = {measured, law}};
}

int main() {
    const std::vector<Sphere> spheres = sphere_scene();
    const ImageRgb centers = draw(480, 270, 1, [&](const Ray& ray) { return scene_color(spheres, ray); });
    const ImageRgb many = render(480, 270, 100);
    ImageRgb half = centers;
    for (int y = 0; y < 270; ++y)
        for (int x = 240; x < 480; ++x) half(x, y) = x < 242 ? Rgb(1) : many(x, y);
    write_image("evidence.png", half);
    const std::vector<ImageRgb> zoomed{centers, render(480, 270, 4), render(480, 270, 16), many};
    write_image("zoom.png", side_by_side(zoomed, 340, 140, 49, 4));

    const auto center = [](float x, float y, Random&) { return star(std::floor(x) + 0.5f, std::floor(y) + 0.5f); };
    const auto light = [](float x, float y, Random&) { return star(x, y); };
    const std::vector<ImageRgb> stars{average_samples(kStar, kStar, 1, center), average_samples(kStar, kStar, 1, light),
                                      average_samples(kStar, kStar, 100, light), encoded_average(100)};
    write_image("star.png", side_by_side(stars, 0, 0, kStar, 1));
    write_plot("error.svg", error_plot());
}
