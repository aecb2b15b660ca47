// The examiner of raster lab 07. Weights and texels are computed by hand or in double; the quad is a parallelogram in
// space, so the place in its texture follows from two linear equations a pixel, without any weights.
#include "raster/lessons/07-textures/lab.h"
#include "tests/grading/judge.h"

#include <cmath>
#include <functional>

using namespace duet;
using namespace duet::grading;
using lab::Corner;

LAB_TITLE("raster-07", "Textures")

namespace {

/// A small texture with four by two texels, all different. In the file's order: the upper row first.
ImageRgb small_texture() {
    ImageRgb image(4, 2);
    for (int x = 0; x < 4; ++x) {
        image(x, 0) = Rgb(0.1f * static_cast<float>(x), 1, 0);
        image(x, 1) = Rgb(0.1f * static_cast<float>(x), 0, 1);
    }
    return image;
}

int floor_mod(double i, int size) { return static_cast<int>(i - size * std::floor(i / size)); }
/// The texel in a column and a row from the lower left corner, wrapped.
Rgbd texel(const ImageRgb& image, double x, double y) {
    return Rgbd(image(floor_mod(x, image.width()), image.height() - 1 - floor_mod(y, image.height())));
}
/// Bilinear in double: the sum of all texels near by, each weighted by a tent of the distance.
Rgb tent(const ImageRgb& image, double u, double v, double shift = 0.5) {
    const double x = u * image.width() - shift, y = v * image.height() - shift;
    Rgbd sum;
    for (double j = std::floor(y) - 1; j <= y + 1; ++j)
        for (double i = std::floor(x) - 1; i <= x + 1; ++i) {
            const double weight = std::max(0.0, 1 - std::abs(x - i)) * std::max(0.0, 1 - std::abs(y - j));
            sum += texel(image, i, j) * weight;
        }
    return Rgb(sum);
}

/// A parallelogram in clip space: a corner and two edges.
struct Quad {
    Vec4 corner, u, v;
    std::array<Corner, 4> corners() const {
        return {Corner{corner, {0, 0}}, {corner + u, {1, 0}}, {corner + u + v, {1, 1}}, {corner + v, {0, 1}}};
    }
    /// The place in the texture that is seen at a point of the image, both from -1 to 1.
    Vec2d uv_at(double x, double y) const { // corner + s·u + t·v has X = x·W and Y = y·W
        const auto part = [&](Vec4 p) {
            return Vec2d{static_cast<double>(p.x) - x * static_cast<double>(p.w),
                         static_cast<double>(p.y) - y * static_cast<double>(p.w)};
        };
        const Vec2d c = part(corner), a = part(u), b = part(v);
        const double det = a.x * b.y - a.y * b.x;
        return {(b.x * c.y - b.y * c.x) / det, (a.y * c.x - a.x * c.y) / det};
    }
};

using Uv = std::function<Vec2d(int x, int y, std::size_t triangle, Vec3 weights)>;
/// What the quad looks like where the place in the texture comes from a function; triangles drawn: the first `count`.
ImageRgb drawn(const Quad& quad, const ImageRgb& texture, int width, int height, Rgb background, const Uv& uv,
               std::size_t count = 2) {
    ImageRgb image(width, height, background);
    const auto corners = quad.corners();
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = [&](std::size_t k) {
            const Vec4 p = lesson::to_image(corners[k].clip, width, height);
            return Vec2{p.x, p.y};
        };
        lesson::for_each_pixel(at(0), at(i + 1), at(i + 2), width, height, [&](int x, int y, Vec3 w) {
            const Vec2d place = uv(x, y, i, w);
            image(x, y) = tent(texture, place.x, place.y);
        });
    }
    return image;
}

Quad floor_quad() { // a floor of 6 m × 12 m, 1 m below the eye, seen at an angle of view of about 75 degrees
    const Mat4 m = lesson::perspective(1.3f, 1.5f, 0.1f, 50);
    const auto clip = [&](float x, float z, float w) { return m * Vec4(x, -w, z, w); };
    return {clip(-3, -1.6f, 1), clip(6, 0, 0), clip(0, -12, 0)};
}
ImageRgb board(int size) {
    ImageRgb image(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            image(x, y) = (x + y) % 2 ? Rgb(0.8f, 0.7f, 0.5f)
                                      : Rgb(0.1f, 0.1f + 0.6f * static_cast<float>(y) / static_cast<float>(size), 0.3f);
    return image;
}

} // namespace

LAB_ITEM(0, "the picture") {
    item.show("your floor", STUDENT(draw_quad)(floor_quad().corners(), board(8), 96, 64, Rgb(0.3f, 0.5f, 0.8f)));
}

LAB_ITEM(20, "weights in perspective") {
    const auto check = [&](const std::string& what, Vec3 weights, Vec3 w, Vec3 expected, double tolerance) {
        const Vec3d divided(Vec3d(weights).x / static_cast<double>(w.x), Vec3d(weights).y / static_cast<double>(w.y),
                            Vec3d(weights).z / static_cast<double>(w.z));
        const Vec3 times = weights * w;
        item.near(what, STUDENT(perspective_weights)(weights, w), expected, tolerance,
                  {{weights, "These are the weights in the image, unchanged: what is far away must weigh less."},
                   {times / (times.x + times.y + times.z),
                    "They are multiplied by w: divide by it. What is far away weighs less."},
                   {times, "They are multiplied by w: divide by it, then by the sum."},
                   {Vec3(divided), "They don't sum to 1: divide all three by their sum."},
                   {Vec3(divided) / (1 / w.x + 1 / w.y + 1 / w.z),
                    "They don't sum to 1: the sum is that of weight / w, not that of 1 / w."}});
    };
    // By hand: 0.5 / 1 and 0.5 / 3 are as 3 to 1.
    check("the weights in the middle of an edge from w = 1 to w = 3", {0.5f, 0.5f, 0}, {1, 3, 7}, {0.75f, 0.25f, 0},
          1e-6);
    check("the weights where all w are 5", {0.2f, 0.3f, 0.5f}, {5, 5, 5}, {0.2f, 0.3f, 0.5f}, 1e-6);
    check("the weights at the third corner", {0, 0, 1}, {2, 3, 4}, {0, 0, 1}, 1e-6);
    for (int i = 0; i < 100; ++i) {
        // A point of the triangle in space, seen in the image: its weights there are those in space times w.
        Rng& rng = item.random();
        const double a = rng.uniform(), b = (1 - a) * rng.uniform();
        const Vec3d space(a, b, 1 - a - b), w(rng.uniform(0.2, 9), rng.uniform(0.2, 9), rng.uniform(0.2, 9));
        const Vec3d seen = space * w;
        check("the weights at a random point", Vec3(seen / (seen.x + seen.y + seen.z)), Vec3(w), Vec3(space), 1e-5);
    }
}

LAB_ITEM(10, "whole numbers that repeat") {
    for (const int size : {1, 4, 7})
        for (int i = -15; i <= 15; ++i) {
            const int expected = floor_mod(i, size);
            item.equal(
                message("wrap(", i, ", ", size, ")"), STUDENT(wrap)(i, size), expected,
                {{i % size,
                  "In C++ the remainder of a negative number is negative or 0: add the size, and take it again."},
                 {i % size + size, "It is too large by the size: take the remainder once more after the addition."},
                 {std::abs(i % size),
                  "The image is mirrored at 0: -1 is the last texel, not the one beside the first."},
                 {std::abs(i) % size,
                  "The image is mirrored at 0: -1 is the last texel, not the one beside the first."},
                 {std::clamp(i, 0, size - 1), "It is clamped to the edge: the image must repeat."},
                 {i, "It is unchanged, and may lie outside of the image."}});
        }
}

LAB_ITEM(20, "the nearest texel") {
    const ImageRgb image = small_texture();
    const auto check = [&](double u, double v) {
        const double x = u * 4, y = v * 2;
        const auto at = [&](double i, double j) { return Rgb(texel(image, i, j)); };
        const Rgb right = at(std::floor(x), std::floor(y));
        item.near(message("the texel at uv = (", u, ", ", v, ") of an image with 4 × 2 texels"),
                  STUDENT(nearest)(image, Vec2(Vec2d(u, v))), right, 1e-6,
                  {{at(std::floor(x), 1 - std::floor(y)), "It is upside down: v = 0 is the bottom, row 0 is the top."},
                   {at(std::floor(x), -std::floor(y)), "It is one row off: the last row is height - 1."},
                   {at(std::trunc(x), std::trunc(y)),
                    "Negative coordinates were cut off toward 0: use std::floor before the conversion to int."},
                   {at(std::round(x), std::round(y)),
                    "It was rounded: a texel begins at a whole number and ends at the next, so use std::floor."},
                   {at(std::floor(u * 3), std::floor(v * 1)),
                    "Multiply by the number of texels, not by that number minus 1."},
                   {at(std::round(u * 3), std::round(v * 1)),
                    "Multiply by the number of texels, not by that number minus 1."},
                   {at(std::clamp(std::floor(x), 0.0, 3.0), std::clamp(std::floor(y), 0.0, 1.0)),
                    "It is clamped to the edge: the image must repeat."},
                   {at(std::floor(u * 2), std::floor(v * 4)), "Width and height are swapped."}});
    };
    for (const Vec2d uv : {Vec2d{0.01, 0.01},
                           {0.3, 0.2},
                           {0.45, 0.3},
                           {0.99, 0.1},
                           {0.3, 0.8},
                           {0.99, 0.99},
                           {1.1, 0.2},
                           {-0.1, 0.2},
                           {0.3, -0.2},
                           {-3.4, 7.7}})
        check(uv.x, uv.y);
    for (int i = 0; i < 100; ++i) {
        const double u = item.random().integer(-40, 40) / 8.0 + 1 / 16.0;
        check(u, item.random().integer(-40, 40) / 8.0 + 1 / 16.0);
    }
}

LAB_ITEM(25, "the mean of four texels") {
    const ImageRgb image = small_texture();
    const auto check = [&](double u, double v) {
        const double x = u * 4 - 0.5, y = v * 2 - 0.5, i = std::floor(x), j = std::floor(y), s = x - i, t = y - j;
        const auto mix = [&](double s_, double t_, double ei, double ej) {
            const Rgbd low = texel(image, i, j) * (1 - s_) + texel(image, ei, j) * s_;
            return Rgb(low * (1 - t_) + (texel(image, i, ej) * (1 - s_) + texel(image, ei, ej) * s_) * t_);
        };
        const auto flip = tent(image, u, 1 - v);
        item.near(message("the color at uv = (", u, ", ", v, ") of an image with 4 × 2 texels"),
                  STUDENT(bilinear)(image, Vec2(Vec2d(u, v))), tent(image, u, v), 2e-4,
                  {{tent(image, u, v, 0),
                    "It is half a texel off: the center of the first texel is at 0.5, so subtract 0.5."},
                   {tent(image, u, v, -0.5), "It is a whole texel off: subtract 0.5, don't add it."},
                   {flip, "It is upside down: v = 0 is the bottom, row 0 is the top."},
                   {mix(1 - s, 1 - t, i + 1, j + 1), "The weights are swapped: the nearer texel must weigh more."},
                   {mix(t, s, i + 1, j + 1), "The weights of x and y are swapped."},
                   {mix(s, t, std::min(i + 1, 3.0), std::min(j + 1, 1.0)),
                    "The neighbor at the edge is wrong: beyond the last texel comes the first. Wrap both neighbors."},
                   {Rgb(texel(image, std::floor(u * 4), std::floor(v * 2))), "This is the nearest texel alone."}});
    };
    for (const Vec2d uv : {Vec2d{0.4, 0.3},
                           {0.125, 0.25},
                           {0.625, 0.75},
                           {0.25, 0.25},
                           {0.125, 0.5},
                           {0.45, 0.6},
                           {0.98, 0.4},
                           {0.3, 0.9},
                           {-0.3, 0.4},
                           {5.3, -2.1}})
        check(uv.x, uv.y);
    for (int i = 0; i < 100; ++i) {
        const double u = item.random().uniform(-3, 3);
        check(u, item.random().uniform(-3, 3));
    }
}

LAB_ITEM(25, "a quad in perspective") {
    const int width = 60, height = 40;
    const Rgb background(0.3f, 0.5f, 0.8f);
    const ImageRgb texture = board(6);
    const auto check = [&](const std::string& name, const Quad& quad) {
        const auto corners = quad.corners();
        const auto right = [&](int x, int y, std::size_t, Vec3) {
            return quad.uv_at((x + 0.5) / width * 2 - 1, 1 - (y + 0.5) / height * 2);
        };
        const auto by_weights = [&](const auto& change) {
            return [&corners, change](int, int, std::size_t i, Vec3 weights) {
                const Vec3 w = change(weights, Vec3{corners[0].clip.w, corners[i + 1].clip.w, corners[i + 2].clip.w});
                return Vec2d(corners[0].uv * w.x + corners[i + 1].uv * w.y + corners[i + 2].uv * w.z);
            };
        };
        const auto affine = by_weights([](Vec3 weights, Vec3) { return weights; });
        const auto times = by_weights([](Vec3 weights, Vec3 w) {
            const Vec3 v = weights * w;
            return v / (v.x + v.y + v.z);
        });
        const auto flipped = [&](int x, int y, std::size_t i, Vec3 w) {
            const Vec2d uv = right(x, y, i, w);
            return Vec2d{uv.x, 1 - uv.y};
        };
        const auto swapped = [&](int x, int y, std::size_t i, Vec3 w) {
            const Vec2d uv = right(x, y, i, w);
            return Vec2d{uv.y, uv.x};
        };
        const auto draw = [&](const Uv& uv, std::size_t count = 2) {
            return drawn(quad, texture, width, height, background, uv, count);
        };
        item.image(
            name, STUDENT(draw_quad)(corners, texture, width, height, background), draw(right), 0.03,
            {{draw(affine), "The texture is bent at the diagonal: the weights are those in the image. Make them right "
                            "in perspective first."},
             {draw(times), "The weights are multiplied by w: divide by it."},
             {draw(flipped), "The texture is upside down."},
             {draw(swapped), "u and v are swapped."},
             {draw(right, 1), "Half of the quad is missing: the second triangle has the corners 0, 2 and 3."},
             {ImageRgb(width, height, background), "Nothing is drawn."}});
    };
    const auto flat = [](Vec2 p) { return Vec4(p.x, p.y, 0.5f, 1); };
    check("a quad that faces the eye", {flat({-0.83f, -0.77f}), Vec4(1.5f, 0.1f, 0, 0), Vec4(-0.1f, 1.5f, 0, 0)});
    check("a floor", floor_quad());
    check("a wall on the left", {Vec4(-1.1f, -0.9f, 0.5f, 1.1f), Vec4(1.3f, 0.1f, 2, 4), Vec4(0, 1.9f, 0, 0)});
}
