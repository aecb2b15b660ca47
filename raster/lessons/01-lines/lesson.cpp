// Lesson 01: lines. Writes vases made of lines, figures of single pixels, and the classic mistakes.
#include "common/image/image_file.h"
#include "common/system/parameters.h"
#include "raster/lessons/01-lines/figures.h"

using namespace duet;
using namespace duet::lesson;

const Rgb kDark(0.012f, 0.014f, 0.03f);

/// A vase of 48 × 40 meshes. Its radius has three bumps: foot, belly and lip. The belly's height is from 0 to 1.
void draw_vase(ImageRgb& image, Vec2 foot, float width, float height, float belly, float hue) {
    const auto bump = [](float x) { return std::exp(-x * x); };
    const auto at = [&](int ring, int spoke) {
        const float h = static_cast<float>(ring) / 40, angle = 2 * kPi * static_cast<float>(spoke) / 48;
        const float bumps = 0.16f + 0.2f * bump(h * 12) + 0.8f * bump((h - belly) * 4) + 0.3f * bump((h - 1) * 9);
        return foot + Vec2{width * bumps * std::cos(angle), 0.3f * width * bumps * std::sin(angle) - h * height};
    };
    for (int i = 0; i < 48; ++i) { // from the back to the front
        const int spoke = 36 + (i % 2 ? -(i + 1) / 2 : i / 2), next = spoke + 1;
        for (int ring = 0; ring < 40; ++ring) {
            const Rgb color = rainbow(hue + static_cast<float>(ring) / 160) * (0.06f + sqr(static_cast<float>(i) / 47));
            draw_path(image, {at(ring + 1, spoke), at(ring, spoke), at(ring, next), at(ring + 1, next)}, 1, color);
        }
    }
}

/// A mistake: one pixel for each column, from x0 on to the right.
void draw_columns(ImageRgb& image, int x0, int y0, int x1, int y1, Rgb color) {
    const double slope = static_cast<double>(y1 - y0) / (x1 - x0);
    for (int x = x0; x <= x1; ++x) image(x, y0 + static_cast<int>(std::lround(slope * (x - x0)))) = color;
}

/// Lines in all directions, drawn by a function like draw_line.
template <typename Draw> ImageRgb rose(const Draw& draw, int lines) {
    ImageRgb image(100, 100, kDark);
    for (int i = 0; i < lines; ++i) {
        const float turn = (static_cast<float>(i) + 0.5f) / static_cast<float>(lines);
        const auto x = [turn](float r) { return static_cast<int>(std::lround(50 + r * std::cos(2 * kPi * turn))); };
        const auto y = [turn](float r) { return static_cast<int>(std::lround(50 + r * std::sin(2 * kPi * turn))); };
        draw(image, x(12), y(12), x(47), y(47), rainbow(turn));
    }
    return magnify(image, 3);
}

/// The last pixels of a line from (0, 0) to (16001, 9013): green by draw_line, orange by a sum of slopes.
ImageRgb end_of_line() {
    ImageRgb window(14, 9, kDark); // its upper left pixel is (15989, 9008)
    draw_line(window, -15989, -9008, 12, 5, rainbow(0.25f));
    float y = 0;
    for (int x = 0; x <= 16001; ++x, y += 9013 / 16001.0f)
        if (x >= 15989) window(x - 15989, static_cast<int>(std::lround(y)) - 9008) = rainbow(0.08f);
    return magnify(window, 30);
}

int main(int argc, char** argv) {
    float belly = 0.6f;
    int row = 6, lines = 40;
    read_parameters(argc, argv, {{"belly", belly, 0, 1}, {"end row", row, 0, 8, "pixels"}, {"lines", lines, 4, 200}});
    ImageRgb vases(480, 320, kDark), pixels(16, 9, kDark);
    draw_vase(vases, {92, 280}, 62, 180, 0.35f, 0.45f), draw_vase(vases, {388, 280}, 66, 160, 0.5f, 0.75f);
    draw_vase(vases, {240, 296}, 78, 262, belly, 0.0f);
    write_image("evidence.png", vases);
    draw_line(pixels, 1, 1, 14, row, rainbow(0.55f));
    draw_line(pixels, 2, 7, 5, 2, rainbow(0));
    pixels = magnify(pixels, 30);
    draw_path(pixels, {{1.5f, 1.5f}, {14.5f, static_cast<float>(row) + 0.5f}}, 30, Rgb(1));
    draw_path(pixels, {{2.5f, 7.5f}, {5.5f, 2.5f}}, 30, Rgb(1));
    write_image("pixels.png", pixels);
    write_image("rose.png", beside({rose(draw_columns, lines), rose(draw_line, lines)}));
    write_image("drift.png", end_of_line());
    ImageRgb there(17, 7), back(17, 7);
    draw_line(there, 0, 1, 16, 5, {0.9f, 0.3f, 0.02f}), draw_line(back, 16, 5, 0, 1, {0.02f, 0.35f, 0.9f});
    for (std::size_t i = 0; i < there.size(); ++i) there[i] += back[i];
    write_image("ends.png", magnify(there, 24));
}
