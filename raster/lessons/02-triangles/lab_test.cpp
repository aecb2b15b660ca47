// The examiner of raster lab 02. Values of the edge function are computed by hand, coverage by the lesson's triangle.h.
#include "raster/lessons/02-triangles/lab.h"
#include "raster/lessons/02-triangles/triangle.h"
#include "tests/grading/judge.h"

#include <cmath>
#include <functional>
#include <string>

using namespace duet;
using namespace duet::grading;
using lab::GridPoint, lab::Triangle;

LAB_TITLE("raster-02", "Triangles and the fill rule")

namespace {

using Triangles = std::vector<Triangle>;
using Mistakes = std::vector<Mistake<Image<int>>>;

Triangle triangle(Vec2 a, Vec2 b, Vec2 c) { return {{a, b, c}, {Rgb(1), Rgb(1), Rgb(1)}}; }
Triangle reversed(const Triangle& t) {
    return {{t.corners[0], t.corners[2], t.corners[1]}, {t.colors[0], t.colors[2], t.colors[1]}};
}

/// A fan about a hub: `count` corners on a circle, clockwise, in the colors of the rainbow.
Triangles fan(Vec2 hub, int count, float radius, float phase = 0) {
    const auto corner = [&](int i) {
        const float angle = 2 * kPi * static_cast<float>(i) / static_cast<float>(count) + phase;
        return hub + Vec2{std::sin(angle), -std::cos(angle)} * radius;
    };
    const auto color = [&](int i) {
        const float t = 2 * kPi * static_cast<float>(i) / static_cast<float>(count);
        return Rgb(0.5f + 0.5f * std::cos(t), 0.5f + 0.5f * std::cos(t - 2.1f), 0.5f + 0.5f * std::cos(t + 2.1f));
    };
    Triangles triangles;
    for (int i = 0; i < count; ++i)
        triangles.push_back({{hub, corner(i), corner(i + 1)}, {Rgb(1), color(i), color(i + 1)}});
    return triangles;
}

/// Two triangles for each cell of a grid of corners that are moved at random and lie on every `snap_to`-th of a pixel
/// (plus a half). The border stays where it is.
Triangles mesh(Rng& rng, int columns, int rows, double cell, double snap_to) {
    std::vector<Vec2> corners;
    for (int y = 0; y <= rows; ++y)
        for (int x = 0; x <= columns; ++x) {
            const auto moved = [&](int i, int end) {
                const double p = i * cell + (i > 0 && i < end ? rng.uniform(-0.35, 0.35) * cell : 0);
                return static_cast<float>(std::round((p - 0.5) * snap_to) / snap_to + 0.5);
            };
            const float px = moved(x, columns);
            corners.push_back({px, moved(y, rows)});
        }
    Triangles triangles;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const auto at = [&](int i, int j) { return corners[static_cast<std::size_t>(j * (columns + 1) + i)]; };
            triangles.push_back(triangle(at(x, y), at(x + 1, y), at(x + 1, y + 1)));
            triangles.push_back(triangle(at(x, y), at(x + 1, y + 1), at(x, y + 1)));
            if (rng.uniform() < 0.3) triangles.back() = reversed(triangles.back());
        }
    return triangles;
}

/// The right counts, or those that a mistake gives: corners are moved by a shift in pixels first.
Image<int> counts(const Triangles& triangles, int width, int height, Vec2 shift = {0, 0}) {
    Image<int> image(width, height, 0);
    for (const Triangle& t : triangles)
        lesson::for_each_pixel(t.corners[0] + shift, t.corners[1] + shift, t.corners[2] + shift, width, height,
                               [&](int x, int y, Vec3) { ++image(x, y); });
    return image;
}

/// The counts by another rule: inside(w, a, b) says whether a center with the value w is inside of the edge from a to
/// b.
using Inside = std::function<bool(std::int64_t, lesson::FixedPoint, lesson::FixedPoint)>;
Image<int> counts_by(const Triangles& triangles, int width, int height, bool turn, const Inside& inside) {
    Image<int> image(width, height, 0);
    for (const Triangle& t : triangles) {
        std::array<lesson::FixedPoint, 3> p{lesson::snap(t.corners[0]), lesson::snap(t.corners[1]),
                                            lesson::snap(t.corners[2])};
        const std::int64_t area = lesson::edge_function(p[0], p[1], p[2]);
        if (area < 0 && turn) std::swap(p[1], p[2]);
        if (area == 0) continue;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                bool covered = true;
                for (std::size_t i = 0; i < 3; ++i) {
                    const auto a = p[i], b = p[(i + 1) % 3];
                    covered = covered && inside(lesson::edge_function(a, b, lesson::pixel_center(x, y)), a, b);
                }
                image(x, y) += covered;
            }
    }
    return image;
}

/// The mistakes that show on edges and by winding, with what they would count.
Mistakes mistakes(const Triangles& triangles, int width, int height) {
    const auto by = [&](bool turn, const Inside& inside) { return counts_by(triangles, width, height, turn, inside); };
    return {
        {by(true, [](auto w, auto, auto) { return w >= 0; }),
         "Both triangles at an edge take the centers on it: w == 0 counts for a left or top edge only."},
        {by(true, [](auto w, auto, auto) { return w > 0; }),
         "No triangle takes the centers on an edge: w == 0 counts as inside where is_top_left says so."},
        {by(true, [](auto w, auto a, auto b) { return w > 0 || (w == 0 && !lesson::is_top_left(a, b)); }),
         "The rule is turned around: the bottom and right edges take the centers on them."},
        {by(true, [](auto w, auto a, auto b) { return w > 0 || (w == 0 && b.y < a.y); }),
         "Horizontal edges are missing: of these the top one, which runs to the right, takes the centers on it."},
        {by(true, [](auto w, auto a, auto b) { return w > 0 || (w == 0 && (b.y > a.y || (b.y == a.y && b.x > a.x))); }),
         "Right edges take the centers on them instead of left ones. A left edge of a clockwise triangle runs up, to "
         "smaller y."},
        {by(false, [](auto w, auto a, auto b) { return lesson::is_inside(w, a, b); }),
         "Triangles with counter-clockwise corners are missing: where the area is negative, swap two corners."},
        {Image<int>(width, height, 0), "Nothing is covered at all."},
        {by(false, [](auto w, auto a, auto b) { return lesson::is_inside(-w, b, a); }),
         "Only counter-clockwise triangles are drawn, and clockwise ones are not: the sign of the edge function, or of "
         "the area, is turned around."},
        {counts(triangles, width, height, {0.5f, 0.5f}), "Pixels are tested at their upper left corners. The center of "
                                                         "pixel (x, y) is (256·x + 128, 256·y + 128) in grid steps."},
    };
}

void check(Item& item, const std::string& name, const Triangles& triangles, int width, int height) {
    item.coverage(name, STUDENT(count_coverage)(triangles, width, height), counts(triangles, width, height),
                  mistakes(triangles, width, height));
}

} // namespace

LAB_ITEM(0, "the picture") {
    Triangles star = fan({80, 60}, 24, 56);
    for (std::size_t i = 0; i < star.size(); ++i) {
        const std::size_t inner = i % 2 ? 1 : 2;
        star[i].corners[inner] = star[i].corners[0] + (star[i].corners[inner] - star[i].corners[0]) * 0.55f;
    }
    item.show("your star", STUDENT(draw)(star, 160, 120, Rgb(0.02f, 0.03f, 0.08f)));
}

LAB_ITEM(10, "corners are snapped to the nearest grid point") {
    const std::string nearest = "It is cut off, not rounded: 2636.8 steps are nearest to 2637.";
    item.near("snap of (10.3, 20.7)", STUDENT(snap)(Vec2{10.3f, 20.7f}), GridPoint{2637, 5299}, 0,
              {{GridPoint{2636, 5299}, nearest},
               {GridPoint{2560, 5376}, "These are whole pixels: multiply by 256 first, then round."},
               {GridPoint{10, 21}, "These are pixels: a pixel has 256 steps."},
               {GridPoint{2765, 5427},
                "Half a pixel too much: the centers of pixels are at 128, but corners are where they are."}});
    item.near(
        "snap of (-10.3, -0.7)", STUDENT(snap)(Vec2{-10.3f, -0.7f}), GridPoint{-2637, -179}, 0,
        {{GridPoint{-2636, -179}, nearest},
         {GridPoint{-2636, -178},
          "A cast to int rounds toward zero, so adding 0.5 first is wrong for negative numbers: use std::lround."}});
    for (int i = 0; i < 100; ++i) {
        const int x = item.random().integer(-200000, 200000), y = item.random().integer(-200000, 200000);
        const Vec2 p(Vec2d((x + item.random().uniform(-0.4, 0.4)) / 256, (y + item.random().uniform(-0.4, 0.4)) / 256));
        item.near(message("snap of ", describe(p)), STUDENT(snap)(p), GridPoint{x, y}, 0);
    }
}

LAB_ITEM(10, "the edge function tells the side") {
    item.equal(
        "the edge function for a = (0, 0), b = (256, 0), p = (0, 256), a point below an edge that runs to the right,",
        STUDENT(edge_function)(GridPoint{0, 0}, GridPoint{256, 0}, GridPoint{0, 256}), 65536,
        {{-65536, "Its sign is turned around. y points down, so a point below is on the right side: positive."},
         {32768, "This is the area of the triangle. The edge function is twice that; it needs no halving."},
         {0, "Is p.y multiplied by the edge's x, and p.x by its y?"}});
    item.equal(
        "the edge function for a = (2, 3), b = (7, 5), p = (4, 9)",
        STUDENT(edge_function)(GridPoint{2, 3}, GridPoint{7, 5}, GridPoint{4, 9}), 26,
        {{-26, "Its sign is turned around: (b - a) × (p - a) = (b.x - a.x)(p.y - a.y) - (b.y - a.y)(p.x - a.x)."},
         {34, "The two products must be subtracted, not added."},
         {22, "This is the dot product (x by x, y by y, added). The cross product is needed."},
         {-2, "x and y of p - a are mixed up: x goes with y."},
         {37, "p must be taken relative to a: p - a."}});
    for (int i = 0; i < 100; ++i) {
        Rng& rng = item.random();
        const auto point = [&] { return GridPoint{rng.integer(-9999, 9999), rng.integer(-9999, 9999)}; };
        const GridPoint a = point(), b = point(), p = point();
        const std::int64_t expected = lesson::edge_function({a.x, a.y}, {b.x, b.y}, {p.x, p.y});
        item.equal(message("the edge function for a = ", describe(a), ", b = ", describe(b), ", p = ", describe(p)),
                   STUDENT(edge_function)(a, b, p), expected);
    }
}

LAB_ITEM(10, "the edge function is exact for large triangles") {
    const auto check_far = [&item](GridPoint a, GridPoint b, GridPoint p) {
        const std::int64_t w = lesson::edge_function({a.x, a.y}, {b.x, b.y}, {p.x, p.y});
        const std::string overflow = "This is what 32 bits hold of it: int times int is int. Convert the differences "
                                     "to std::int64_t before you multiply.";
        item.equal(message("the edge function for a = ", describe(a), ", b = ", describe(b), ", p = ", describe(p)),
                   STUDENT(edge_function)(a, b, p), w,
                   {{static_cast<std::int32_t>(static_cast<std::uint32_t>(w)), overflow},
                    {static_cast<std::int64_t>(static_cast<float>(w)),
                     "A float has 24 bits only: compute with whole numbers."}});
    };
    check_far({0, 0}, {50001, 7}, {11, 50033});
    check_far({0, 0}, {8388607, 1}, {3, 8388605});
    Rng& rng = item.random();
    for (int i = 0; i < 100; ++i) {
        const auto point = [&] {
            return GridPoint{rng.integer(-16777216, 16777216), rng.integer(-16777216, 16777216)};
        };
        const GridPoint a = point(), b = point();
        check_far(a, b, point());
    }
}

LAB_ITEM(10, "left and top edges") {
    const std::array<const char*, 8> names{"right", "down-right", "down", "down-left",
                                           "left",  "up-left",    "up",   "up-right"};
    const std::array<GridPoint, 8> directions{{{5, 0}, {5, 3}, {0, 5}, {-5, 3}, {-5, 0}, {-5, -3}, {0, -5}, {5, -3}}};
    std::string found;
    for (std::size_t i = 0; i < 8; ++i) {
        const GridPoint a{700, 300}, b{a.x + directions[i].x, a.y + directions[i].y};
        if (STUDENT(is_top_left)(a, b)) found += (found.empty() ? "" : ", ") + std::string(names[i]);
    }
    item.equal(
        "The list of directions in which a left or top edge runs", found, "right, up-left, up, up-right",
        {{"right, down-right, down, down-left", "The top edge is right, but down runs a right edge: the inside of a "
                                                "clockwise triangle is to the right of its edges."},
         {"down-right, down, down-left, left", "These are the right and bottom edges: everything is turned around."},
         {"left, up-left, up, up-right", "The left edges are right, but a horizontal edge that runs left is the bottom "
                                         "one: the inside is to the right, and that is up."},
         {"up-left, up, up-right", "Horizontal edges are missing: the top edge runs to the right."},
         {"right, left, up-left, up, up-right",
          "A horizontal edge that runs left is a bottom edge: test b.x > a.x, too."},
         {"right, down-right, up, up-right", "An edge is a left edge if it runs up, whatever it does in x."},
         {"right, up", "Slanted edges count, too: every edge that runs up is a left edge."},
         {"", "No edge is a left or top one."}});
}

LAB_ITEM(15, "one triangle: which centers it covers") {
    const Triangle clockwise = triangle({3.2f, 2.1f}, {21.6f, 6.4f}, {8.3f, 14.7f});
    check(item, "a clockwise triangle", {clockwise}, 26, 17);
    check(item, "the same one with counter-clockwise corners", {reversed(clockwise)}, 26, 17);
    check(item, "a triangle that reaches beyond the picture on all sides", {triangle({-9, -4}, {40, 3.3f}, {2.5f, 30})},
          26, 17);
    check(item, "a triangle outside of the picture", {triangle({-9, -4}, {-2, -8}, {-3, -1})}, 26, 17);
    const Image<int> on_line = STUDENT(count_coverage)({triangle({2.5f, 2.5f}, {6.5f, 6.5f}, {9.5f, 9.5f})}, 26, 17);
    item.coverage(
        "a triangle whose corners lie on one line", on_line, Image<int>(26, 17, 0),
        {{on_line, "It has no inside. The centers on the line have w = 0 for all three edges: w == 0 counts for "
                   "a left or top edge only."}});
    Rng& rng = item.random();
    for (int i = 0; i < 60; ++i) {
        const auto point = [&] { return Vec2(Vec2d(rng.uniform(-12, 38), rng.uniform(-12, 29))); };
        const Vec2 a = point(), b = point();
        check(item, message("the triangle number ", i + 1, " of 60 random ones"), {triangle(a, b, point())}, 26, 17);
    }
}

LAB_ITEM(20, "triangles that share edges cover each center once") {
    const Vec2 hub{12.5f, 12.5f}; // all edges pass through centers
    const std::array<Vec2, 8> rim{{{0, -10}, {10, -10}, {8, 0}, {9, 6}, {0, 10}, {-8, 8}, {-10, 0}, {-6, -9}}};
    Triangles eight;
    for (std::size_t i = 0; i < 8; ++i) eight.push_back(triangle(hub, hub + rim[i], hub + rim[(i + 1) % 8]));
    check(item, "eight triangles about the center of a pixel", eight, 25, 25);
    for (std::size_t i = 0; i < 8; i += 2) eight[i] = reversed(eight[i]);
    check(item, "the same eight, every other one with counter-clockwise corners", eight, 25, 25);
    for (int i = 0; i < 20; ++i)
        check(item, "a mesh with corners on the centers of pixels", mesh(item.random(), 6, 5, 6, 1), 36, 30);
    for (int i = 0; i < 20; ++i) check(item, "a mesh over the picture", mesh(item.random(), 6, 5, 6, 256), 36, 30);
}

LAB_ITEM(10, "triangles smaller than a pixel, and larger than any picture") {
    for (int i = 0; i < 5; ++i) {
        const Triangles tiny = mesh(item.random(), 60, 50, 0.4, 64);
        Mistakes typical = mistakes(tiny, 24, 20);
        Triangles kept;
        for (const Triangle& t : tiny) {
            const Vec2 u = t.corners[1] - t.corners[0], v = t.corners[2] - t.corners[0];
            if (std::abs(u.x * v.y - u.y * v.x) >= 1) kept.push_back(t);
        }
        typical.insert(
            typical.begin(),
            {counts(kept, 24, 20), "Small triangles are left out: only a triangle without any area covers nothing."});
        item.coverage("a mesh of triangles smaller than a pixel", STUDENT(count_coverage)(tiny, 24, 20),
                      counts(tiny, 24, 20), typical);
    }
    const Vec2 a{-30000, -20000}, b{31000, -25000}, c{29000.5f, 30000.25f}, d{-28000, 32000};
    const Triangles huge{triangle(a, b, c), triangle(a, c, d)};
    const Triangles half{triangle({-300, -200}, {900, 40.5f}, {-100, 700})};
    const auto overflowed = [](std::int64_t w, auto p, auto q) {
        return lesson::is_inside(static_cast<std::int32_t>(w), p, q);
    };
    const std::string text = "This is what edge functions of 32 bits give: compute them in 64 bits, also the area.";
    item.coverage("a triangle a thousand pixels wide", STUDENT(count_coverage)(half, 64, 48), counts(half, 64, 48),
                  {{counts_by(half, 64, 48, true, overflowed), text}, {Image<int>(64, 48, 0), text}});
    item.coverage("two triangles of 60,000 pixels with a common edge", STUDENT(count_coverage)(huge, 64, 48),
                  counts(huge, 64, 48),
                  {{counts_by(huge, 64, 48, true, overflowed), text}, {Image<int>(64, 48, 0), text}});
}

LAB_ITEM(15, "colors spread evenly from the corners") {
    constexpr int kWidth = 60, kHeight = 40;
    const Rgb background(0.1f, 0.1f, 0.1f);
    /// colors(w) of the lesson's weights; `turned` is true where the corners are counter-clockwise.
    const auto drawn = [&](const Triangles& triangles, const auto& colors) {
        ImageRgb image(kWidth, kHeight, background);
        for (const Triangle& t : triangles) {
            const auto& p = t.corners;
            const bool turned = lesson::edge_function(lesson::snap(p[0]), lesson::snap(p[1]), lesson::snap(p[2])) < 0;
            lesson::for_each_pixel(p[0], p[1], p[2], kWidth, kHeight, [&](int x, int y, Vec3 w) {
                const Vec3 v = colors(w, turned);
                image(x, y) = t.colors[0] * v.x + t.colors[1] * v.y + t.colors[2] * v.z;
            });
        }
        return image;
    };
    const auto check_image = [&](const std::string& name, const Triangles& triangles) {
        Triangles moved = triangles; // what a pixel's upper left corner sees, its center sees of these
        for (Triangle& t : moved)
            for (Vec2& corner : t.corners) corner = corner + Vec2{0.5f, 0.5f};
        item.image(name, STUDENT(draw)(triangles, kWidth, kHeight, background),
                   drawn(triangles, [](Vec3 w, bool) { return w; }), 2e-3,
                   {{drawn(triangles,
                           [](Vec3 w, bool) {
                               return Vec3{w.z, w.x, w.y};
                           }),
                     "Each weight is at the wrong corner: that of a comes from the edge across, from b to c."},
                    {drawn(triangles,
                           [](Vec3 w, bool) {
                               return Vec3{w.y, w.z, w.x};
                           }),
                     "Each weight is at the wrong corner: that of a comes from the edge across, from b to c."},
                    {drawn(triangles,
                           [](Vec3 w, bool turned) {
                               return turned ? Vec3{w.x, w.z, w.y} : w;
                           }),
                     "Where corners were swapped to make a triangle clockwise, their colors must be swapped, too."},
                    {drawn(triangles, [](Vec3 w, bool) { return w * 0.5f; }),
                     "The weights sum to 1/2: divide by twice the area, the edge function of the third corner."},
                    {drawn(triangles, [](Vec3 w, bool) { return w * 2.0f; }),
                     "The weights sum to 2: divide by twice the area, the edge function of the third corner."},
                    {drawn(triangles,
                           [](Vec3, bool) {
                               return Vec3{1, 0, 0};
                           }),
                     "The whole triangle has the color of its first corner: mix the three by the weights."},
                    {drawn(triangles,
                           [](Vec3, bool) {
                               return Vec3{1, 1, 1} / 3.0f;
                           }),
                     "The triangle has one color, the mean: each pixel has weights of its own."},
                    {drawn(triangles,
                           [](Vec3, bool) {
                               return Vec3{0, 0, 0};
                           }),
                     "The weights are 0: a whole number divided by a greater one is 0 in C++. Convert to float first."},
                    {drawn(moved, [](Vec3 w, bool) { return w; }),
                     "The weights belong to the upper left corners of the pixels: take their centers."},
                    {ImageRgb(kWidth, kHeight, background), "Nothing is drawn."}});
    };
    const Triangle primary{{Vec2{4, 35.5f}, {30, 3}, {55.2f, 33}}, {Rgb(1, 0, 0), {0, 1, 0}, {0, 0, 1}}};
    check_image("a triangle with a red, a green and a blue corner", {primary});
    check_image("the same one with counter-clockwise corners", {reversed(primary)});
    check_image("two triangles, the second over the first",
                {primary, {{Vec2{20, 5}, {50, 30}, {11, 38}}, {Rgb(1, 1, 0), Rgb(1), {0, 1, 1}}}});
    check_image("a fan", fan({30.5f, 20.5f}, 12, 18));
}
