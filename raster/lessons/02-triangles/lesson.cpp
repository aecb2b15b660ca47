// Lesson 02: triangles. Writes a star of colored triangles, and figures of the rule that gives each pixel to one.
#include "common/image/image_file.h"
#include "common/system/parameters.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/02-triangles/triangle.h"

#include <array>

using namespace duet;
using namespace duet::lesson;

struct Corner {
    Vec2 p; // in pixels
    Rgb color;
};
using Triangle = std::array<Corner, 3>;

/// Fills a triangle. The color of a pixel is the mean of the corners' colors, each with its weight.
void fill(ImageRgb& image, const Triangle& t) {
    for_each_pixel(t[0].p, t[1].p, t[2].p, image.width(), image.height(),
                   [&](int x, int y, Vec3 w) { image(x, y) = t[0].color * w.x + t[1].color * w.y + t[2].color * w.z; });
}

/// A fan of triangles about a hub. Every other corner of its rim is darker, and nearer to the hub by a factor.
std::vector<Triangle> star(Corner hub, int points, float radius, float factor, float brightness) {
    std::vector<Triangle> fan;
    const auto rim = [&](int i) {
        const float turn = static_cast<float>(i) / static_cast<float>(2 * points), angle = 2 * kPi * turn;
        const Vec2 way = Vec2{std::sin(angle), -std::cos(angle)} * radius;
        return Corner{hub.p + way * (i % 2 ? factor : 1.0f), rainbow(turn) * brightness * (i % 2 ? 0.25f : 1.0f)};
    };
    for (int i = 0; i < 2 * points; ++i) fan.push_back({hub, rim(i), rim(i + 1)});
    return fan;
}

/// The insides of the three edges in red, green and blue. The mistake: 32 bits keep only the lower half of w.
ImageRgb half_planes(const std::array<Vec2, 3>& t, bool mistake) {
    ImageRgb image(320, 180, Rgb(0.03f));
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (std::size_t i = 0; i < 3; ++i) {
                const std::int64_t w = edge_function(snap(t[i]), snap(t[(i + 1) % 3]), pixel_center(x, y));
                if ((mistake ? static_cast<std::int32_t>(w) : w) > 0) image(x, y)[i] = 0.6f;
            }
    return image;
}

/// Enlarged pixels, with the outlines of the triangles in white.
ImageRgb enlarged(const std::vector<Triangle>& triangles) {
    ImageRgb small(16, 9, Rgb(0.03f));
    for (const Triangle& t : triangles) fill(small, t);
    ImageRgb image = magnify(small, 30);
    for (const Triangle& t : triangles) draw_path(image, {t[0].p, t[1].p, t[2].p, t[0].p}, 30, Rgb(1));
    return image;
}

/// How many triangles cover a pixel: black for none, blue for one, orange for two, yellow for more. inside(w, a, b) is
/// the rule by which a point with the value w is inside of the edge from a to b.
template <typename Inside> ImageRgb count_map(const std::vector<Triangle>& triangles, const Inside& inside) {
    const std::array<Rgb, 4> colors{Rgb(0.01f), Rgb(0.1f, 0.2f, 0.35f), Rgb(0.9f, 0.2f, 0.03f), Rgb(1, 0.8f, 0.1f)};
    ImageRgb image(25, 25);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            std::size_t count = 0;
            for (const Triangle& t : triangles) {
                const FixedPoint a = snap(t[0].p), b = snap(t[1].p), c = snap(t[2].p), p = pixel_center(x, y);
                count += inside(edge_function(a, b, p), a, b) && inside(edge_function(b, c, p), b, c) &&
                         inside(edge_function(c, a, p), c, a);
            }
            image(x, y) = colors[std::min<std::size_t>(count, 3)];
        }
    return magnify(image, 10);
}

int main(int argc, char** argv) {
    float inner = 0.55f, x = 14;
    read_parameters(argc, argv, {{"inner radius", inner, 0.1f, 1, "of the outer one"}, {"corner", x, 6, 15, "pixels"}});
    ImageRgb picture(480, 270);
    for (const Triangle& t : star({{240, 135}, {0.03f, 0.05f, 0.12f}}, 12, 400, 0.9f, 0.12f)) fill(picture, t);
    for (const Triangle& t : star({{240, 135}, {1, 0.95f, 0.8f}}, 12, 130, inner, 1)) fill(picture, t);
    write_image("evidence.png", picture);
    const std::array<Vec2, 3> t{Vec2{20, 15}, Vec2{300, 70}, Vec2{60, 170}};
    write_image("half-planes.png", half_planes(t, false));
    write_image("overflow.png", half_planes(t, true));
    const Corner a{{2.5f, 1.5f}, rainbow(0.6f)}, b{{12.5f, 6.5f}, a.color}, c{{2, 7}, a.color}, d{{x, 1}, {1, .3f, 0}};
    write_image("pixels.png", enlarged({{a, b, c}, {Corner{a.p, d.color}, d, {b.p, d.color}}}));
    const auto both = [](std::int64_t w, FixedPoint, FixedPoint) { return w >= 0; };
    const auto neither = [](std::int64_t w, FixedPoint, FixedPoint) { return w > 0; };
    const auto fan = star({{12.5f, 12.5f}, {}}, 4, 12, std::sqrt(0.5f), 1);
    write_image("counts.png", beside({count_map(fan, both), count_map(fan, neither), count_map(fan, is_inside)}));
}
