// The examiner of raster lab 05. Areas are measured by the attribute: the whole triangle has the uv coordinates (0, 0),
// (1, 0), (0, 1), and the part that remains has an area that follows from the fractions at which its edges are cut.
#include "raster/lessons/02-triangles/triangle.h"
#include "raster/lessons/05-clipping/lab.h"
#include "tests/grading/judge.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace duet;
using namespace duet::grading;
using lab::Triangle;
using lab::Vertex;

LAB_TITLE("raster-05", "Clipping")

namespace {

double z(const Vertex& v) { return static_cast<double>(v.clip.z); }

/// The point at fraction t from a to b, in double.
Vertex mix(const Vertex& a, const Vertex& b, double t) {
    const auto one = [t](float from, float to) {
        return static_cast<float>(static_cast<double>(from) * (1 - t) + static_cast<double>(to) * t);
    };
    return {{one(a.clip.x, b.clip.x), one(a.clip.y, b.clip.y), one(a.clip.z, b.clip.z), one(a.clip.w, b.clip.w)},
            {one(a.uv.x, b.uv.x), one(a.uv.y, b.uv.y)}};
}
Vertex cut(const Vertex& front, const Vertex& behind) { return mix(front, behind, z(front) / (z(front) - z(behind))); }

std::vector<Mistake<Vertex>> crossing_mistakes(const Vertex& front, const Vertex& behind) {
    const Vertex right = cut(front, behind);
    const double t = z(front) / (z(front) - z(behind));
    Vertex no_uv = right, behind_uv = right, no_w = right, divided = right;
    no_uv.uv = front.uv, behind_uv.uv = behind.uv, no_w.clip.w = 1;
    const Vec4 a = front.clip * (1 / front.clip.w), b = behind.clip * (1 / behind.clip.w);
    const float s = a.z / (a.z - b.z);
    divided.clip = a * (1 - s) + b * s;
    return {
        {mix(front, behind, 1 - t),
         "The ends are exchanged: the fraction t counts from the end in front, (1 - t)·front + t·behind."},
        {no_uv, "The attribute uv is that of the end in front: interpolate it by the same fraction."},
        {behind_uv, "The attribute uv is that of the end behind: interpolate it by the same fraction."},
        {no_w, "w is 1: interpolate it like x and y, the division comes later."},
        {divided, "These are coordinates after the division by w. Clipping must come before it."},
        {mix(front, behind, 0.5), "This is the middle of the edge: use the fraction at which z is 0."},
        {front, "This is the end in front itself."},
        {behind, "This is the end behind itself."},
    };
}

Vec2d uv(const Vertex& v) { return Vec2d(v.uv); }
/// The signed area of a triangle in uv, in units of the whole triangle (0, 0), (1, 0), (0, 1).
double area(const Triangle& t) {
    const Vec2d ab = uv(t[1]) - uv(t[0]), ac = uv(t[2]) - uv(t[0]);
    return ab.x * ac.y - ab.y * ac.x;
}
/// How much of a triangle is in front of the near plane. Where one corner is alone on its side, its two edges are cut
/// at the fractions t and s from it, and the small triangle there has the area t·s of the whole.
double area_in_front(const Triangle& t) {
    std::size_t count = 0;
    for (const Vertex& v : t) count += v.clip.z >= 0;
    if (count == 0 || count == 3) return count == 0 ? 0 : 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vertex &alone = t[i], &b = t[(i + 1) % 3], &c = t[(i + 2) % 3];
        if ((alone.clip.z >= 0) == (b.clip.z >= 0) || (alone.clip.z >= 0) == (c.clip.z >= 0)) continue;
        const double corner = z(alone) / (z(alone) - z(b)) * (z(alone) / (z(alone) - z(c)));
        return count == 1 ? corner : 1 - corner;
    }
    return 0;
}

Triangle triangle(Vec4 a, Vec4 b, Vec4 c) { return {Vertex{a, {0, 0}}, Vertex{b, {1, 0}}, Vertex{c, {0, 1}}}; }

/// A random triangle; `signs` are those of the z of its corners.
Triangle random_triangle(Rng& rng, std::array<int, 3> signs) {
    const auto corner = [&](int sign) {
        const double x = rng.uniform(-3, 3), y = rng.uniform(-3, 3), depth = sign * rng.uniform(0.1, 4);
        return Vec4(Vec3(Vec3d(x, y, depth)), static_cast<float>(depth + 0.3));
    };
    const Vec4 a = corner(signs[0]), b = corner(signs[1]);
    return triangle(a, b, corner(signs[2]));
}

std::string describe_corners(const Triangle& t) {
    return message("the triangle with z = ", t[0].clip.z, ", ", t[1].clip.z, ", ", t[2].clip.z);
}

/// Fails unless the parts cover what is in front of the plane, once.
void check(Item& item, const Triangle& t, std::size_t expected) {
    const auto parts = STUDENT(clip_near)(t);
    const std::string name = describe_corners(t);
    const double whole = area_in_front(t);
    const std::string original = parts.size() == 1 && std::abs(std::abs(area(parts[0])) - 1) < 1e-6 && expected > 0
                                     ? " The triangle is still whole: nothing was cut off."
                                     : "";
    item.require(parts.size() == expected,
                 message("For ", name, " expected ", expected, " triangles, found ", parts.size(), ".", original,
                         parts.empty()  ? " It was dropped as a whole, but a part of it is in front."
                         : expected < 1 ? " All corners are behind the plane: nothing remains."
                         : expected == 2 && parts.size() == 1 && original.empty()
                             ? " Two corners are in front: the outline has four corners, which make two triangles."
                         : expected == 1 && parts.size() == 2
                             ? " The outline has three corners, which make one triangle."
                             : ""));
    double sum = 0, absolute = 0;
    for (const Triangle& part : parts) {
        for (const Vertex& corner : part)
            item.require(
                corner.clip.z >= -1e-5f,
                message("For ", name, " a part has a corner with z = ", corner.clip.z, ", behind the plane.", original,
                        corner.clip.z == t[0].clip.z || corner.clip.z == t[1].clip.z || corner.clip.z == t[2].clip.z
                            ? " Keep the corners with z >= 0, not the others."
                            : " Is the fraction of the crossing right?"));
        sum += area(part), absolute += std::abs(area(part));
    }
    const auto percent = [](double x) { return describe_number(std::round(x * 1e4) / 100) + " %"; };
    const std::string found =
        message("For ", name, " ", percent(whole), " of the area is in front of the plane, and your triangles have ");
    item.require(absolute < whole + 1e-4,
                 message(found, percent(absolute), " together. ",
                         expected == 2 ? "Do they overlap? Of the four corners 0, 1, 2, 3 of the outline, one triangle "
                                         "has 0, 1, 2 and the other 0, 2, 3."
                                       : "Too little was cut off."));
    item.require(absolute > whole - 1e-4,
                 message(found, percent(absolute), " together. ",
                         expected == 2 && std::abs(area(parts[0]) - area(parts[1])) < 1e-6
                             ? "They are the same triangle twice."
                         : expected == 2 ? "A part is missing: the outline's corners 0, 1, 2 and 0, 2, 3."
                                         : "Are both edges cut at their own fractions?"));
    item.require(sum > whole - 1e-4,
                 message("For ", name,
                         ", a part has the opposite winding of the original: collect the corners in the "
                         "order of the walk, and the crossing of an edge before the corner at its end."));
    // Attributes go with the places: a part's corner is the same mixture of the original's corners in both.
    for (const Triangle& part : parts)
        for (const Vertex& corner : part) {
            const double u = uv(corner).x, v = uv(corner).y;
            const auto blend = [&](float a, float b, float c) {
                return static_cast<float>(static_cast<double>(a) * (1 - u - v) + static_cast<double>(b) * u +
                                          static_cast<double>(c) * v);
            };
            const Vec4 place{blend(t[0].clip.x, t[1].clip.x, t[2].clip.x), blend(t[0].clip.y, t[1].clip.y, t[2].clip.y),
                             blend(t[0].clip.z, t[1].clip.z, t[2].clip.z),
                             blend(t[0].clip.w, t[1].clip.w, t[2].clip.w)};
            item.near(message("the place of the corner with uv ", describe(corner.uv), " of ", name), corner.clip,
                      place, 1e-4);
        }
}

constexpr int kWidth = 64, kHeight = 48;

/// A floor 1 meter below the eye from 12 meters in front to 12 meters behind, cut into triangles at random. It is wider
/// than the image at any distance.
std::vector<Triangle> floor_mesh(Rng& rng, int columns, int rows, float near) {
    std::vector<Vec4> corners;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const auto moved = [&](int k, int end) { return k + (k > 0 && k < end ? rng.uniform(-0.3, 0.3) : 0); };
            const double x = (moved(i, columns) / columns - 0.5) * 40, w = 12 - moved(j, rows) / rows * 24;
            const Vec3 p(Vec3d(x, -1.6, w));
            corners.push_back({p.x, p.y, p.z - near, p.z}); // w = z + near: a far plane at infinity
        }
    std::vector<Triangle> triangles;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const auto at = [&](int a, int b) { return corners[static_cast<std::size_t>(b * (columns + 1) + a)]; };
            triangles.push_back(triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1)));
            triangles.push_back(triangle(at(i + 1, j + 1), at(i, j + 1), at(i, j)));
        }
    return triangles;
}
Vec2 pixel(const Vertex& v, int width, int height) {
    const float x = v.clip.x / v.clip.w, y = v.clip.y / v.clip.w;
    return {(1 + x) / 2 * static_cast<float>(width), (1 - y) / 2 * static_cast<float>(height)};
}
template <typename Visit> void visit_pixels(const Triangle& t, int width, int height, const Visit& visit) {
    const auto is_drawable = [&](const Vertex& v) {
        const Vec2 p = pixel(v, width, height);
        return std::abs(p.x) < 4e6f && std::abs(p.y) < 4e6f; // false for NaN, too
    };
    if (!is_drawable(t[0]) || !is_drawable(t[1]) || !is_drawable(t[2])) return;
    lesson::for_each_pixel(pixel(t[0], width, height), pixel(t[1], width, height), pixel(t[2], width, height), width,
                           height, visit);
}

/// How often parts of triangles cover each pixel; `clip` turns a triangle into its parts.
template <typename Clip> Image<int> counts(const std::vector<Triangle>& triangles, const Clip& clip) {
    Image<int> image(kWidth, kHeight, 0);
    for (const Triangle& t : triangles)
        for (const Triangle& part : clip(t))
            visit_pixels(part, kWidth, kHeight, [&](int x, int y, Vec3) { ++image(x, y); });
    return image;
}

} // namespace

LAB_ITEM(0, "the picture: a floor of many colors that passes below the eye") {
    constexpr int kWide = 200, kHigh = 120;
    ImageRgb image(kWide, kHigh, Rgb(0.3f, 0.5f, 0.8f));
    Rng& rng = item.random();
    std::size_t i = 0;
    for (const Triangle& t : floor_mesh(rng, 10, 6, 0.1f)) {
        const Rgb tint = direction_color(Vec3(Vec3d(std::sin(0.7 * double(i)), std::cos(1.3 * double(i)), 0.2)));
        ++i;
        for (const Triangle& part : STUDENT(clip_near)(t))
            visit_pixels(part, kWide, kHigh, [&](int x, int y, Vec3) { image(x, y) = tint * tint; });
    }
    item.show("your clipped floor", image);
}

LAB_ITEM(15, "the fraction at which an edge crosses the plane") {
    const auto mistakes = [](float front, float behind) {
        const float right = front / (front - behind);
        return std::vector<Mistake<float>>{
            {1 - right, "It is counted from the end behind: at fraction 0 z is front_z, and at 1 it is behind_z."},
            {-right, "The sign is wrong: front_z is positive and behind_z is negative, so front_z - behind_z is the "
                     "whole way."},
            {front / (front + behind), "behind_z is negative: the whole way is front_z - behind_z, not their sum."},
            {front / behind, "This is the ratio of the two. The whole way, front_z - behind_z, must be the divisor."},
            {-front / behind, "This is the ratio of the two. The whole way, front_z - behind_z, must be the divisor."},
            {0.5f, "This is the middle. The crossing is nearer to the end whose z is smaller."},
        };
    };
    item.near("crossing_fraction(3, -1)", STUDENT(crossing_fraction)(3.0f, -1.0f), 0.75f, 1e-6, mistakes(3, -1));
    item.near("crossing_fraction(1, -3)", STUDENT(crossing_fraction)(1.0f, -3.0f), 0.25f, 1e-6, mistakes(1, -3));
    item.near("crossing_fraction(0, -2), from a point on the plane,", STUDENT(crossing_fraction)(0.0f, -2.0f), 0.0f,
              1e-6, mistakes(0, -2));
    for (int i = 0; i < 100; ++i) {
        const auto front = static_cast<float>(item.random().uniform(0, 5)),
                   behind = static_cast<float>(-item.random().uniform(0.01, 5));
        item.near(message("crossing_fraction(", front, ", ", behind, ")"), STUDENT(crossing_fraction)(front, behind),
                  front / (front - behind), 1e-5, mistakes(front, behind));
    }
}

LAB_ITEM(15, "the crossing, with its attribute") {
    const Vertex p{{0, 0, 3, 4}, {0, 1}}, q{{4, 8, -1, 0.5f}, {8, 5}};
    item.near("the crossing of (0, 0, 3, 4) with uv (0, 1) and (4, 8, -1, 0.5) with uv (8, 5), as (x, y, z, w, u, v),",
              STUDENT(crossing)(p, q), Vertex{{3, 6, 0, 1.375f}, {6, 4}}, 1e-5, crossing_mistakes(p, q));
    const Vertex page{{4, 8, -1, 0}, {0, 0}};
    item.near("the crossing of (0, 0, 3, 4) and (4, 8, -1, 0), computed by hand on the page,",
              STUDENT(crossing)(p, page).clip, Vec4(3, 6, 0, 1), 1e-5);
    for (int i = 0; i < 200; ++i) {
        const Triangle t = random_triangle(item.random(), {1, -1, 1});
        const Vertex &a = i % 2 ? t[1] : t[0], &b = i % 2 ? t[0] : t[1]; // either order
        item.near(message("the crossing of ", describe(a), " and ", describe(b), ", each as (x, y, z, w, u, v),"),
                  STUDENT(crossing)(a, b), cut(t[0], t[1]), 1e-4, [&] {
                      auto mistakes = crossing_mistakes(t[0], t[1]);
                      for (auto& mistake : mistakes)
                          if (i % 2) mistake.text += " (Here the first end is the one behind.)";
                      return mistakes;
                  }());
    }
}

LAB_ITEM(15, "the crossing is the same point from both sides of an edge, bit for bit") {
    int differences = 0;
    Triangle example{};
    for (int i = 0; i < 300; ++i) {
        const Triangle t = random_triangle(item.random(), {1, -1, 1});
        const Vertex there = STUDENT(crossing)(t[0], t[1]), back = STUDENT(crossing)(t[1], t[0]);
        item.near(message("the crossing of ", describe(t[0]), " and ", describe(t[1])), there, cut(t[0], t[1]), 1e-4);
        item.near(message("the crossing of ", describe(t[1]), " and ", describe(t[0])), back, cut(t[0], t[1]), 1e-4,
                  {{mix(t[0], t[1], 1 - z(t[0]) / (z(t[0]) - z(t[1]))),
                    "Here the first end is the one behind: ask which one is in front before you compute."}});
        if (std::memcmp(&there, &back, sizeof there) != 0 && differences++ == 0) example = t;
    }
    item.require(
        differences == 0,
        message("Exchange the ends, and ", differences,
                " of 300 crossings differ in their last digits, for example that of ", describe(example[0]), " and ",
                describe(example[1]),
                ". Then gaps open between neighbors. Always compute from the end in front to the end behind."));
}

LAB_ITEM(10, "triangles that are in front or behind as a whole") {
    const Triangle front = triangle({0, 0, 1, 2}, {1, 0, 2, 3}, {0, 1, 0.5f, 1.5f});
    const auto found = STUDENT(clip_near)(front);
    item.require(found.size() == 1,
                 message("A triangle in front must be returned as it is: expected 1 triangle, found ", found.size(),
                         ".",
                         found.empty() ? " Is the sign of your test right? Corners with z >= 0 are in front." : ""));
    item.near("a triangle that is in front as a whole, as corners (x, y, z, w, u, v),", found[0], front, 0);
    check(item, triangle({0, 0, -1, 2}, {1, 0, -2, 3}, {0, 1, -0.5f, 1.5f}), 0);
    for (int i = 0; i < 30; ++i) {
        check(item, random_triangle(item.random(), {1, 1, 1}), 1);
        check(item, random_triangle(item.random(), {-1, -1, -1}), 0);
    }
}

LAB_ITEM(15, "one corner in front: one triangle remains") {
    // Edges are cut at 1/2 and 1/4, so an eighth of the area remains.
    check(item, triangle({0, 0, 1, 2}, {1, 0, -1, 0.5f}, {0, 1, -3, 0.2f}), 1);
    for (int i = 0; i < 90; ++i) {
        std::array<int, 3> signs{-1, -1, -1};
        signs[static_cast<std::size_t>(i) % 3] = 1;
        check(item, random_triangle(item.random(), signs), 1);
    }
}

LAB_ITEM(20, "two corners in front: two triangles remain") {
    check(item, triangle({0, 0, -1, 0.5f}, {1, 0, 1, 2}, {0, 1, 3, 4}), 2);
    for (int i = 0; i < 90; ++i) {
        std::array<int, 3> signs{1, 1, 1};
        signs[static_cast<std::size_t>(i) % 3] = -1;
        check(item, random_triangle(item.random(), signs), 2);
    }
    // Corners on the plane are in front. Parts without area are allowed here.
    const auto area_of = [](const Triangle& t) {
        double sum = 0;
        for (const Triangle& part : STUDENT(clip_near)(t)) sum += std::abs(area(part));
        return sum;
    };
    const std::string on = "A corner with z = 0 is in front: compare with >= 0.";
    item.near("the part in front of the triangle with z = 0, 1, 2",
              area_of(triangle({0, 0, 0, 1}, {1, 0, 1, 2}, {0, 1, 2, 3})), 1.0, 1e-5, {{0, on}});
    item.near("the part in front of the triangle with z = 0, 1, -1",
              area_of(triangle({0, 0, 0, 1}, {1, 0, 1, 2}, {0, 1, -1, 1})), 0.5, 1e-5, {{0, on}});
    item.near("the part in front of the triangle with z = 0, -1, -2",
              area_of(triangle({0, 0, 0, 1}, {1, 0, -1, 2}, {0, 1, -2, 3})), 0.0, 1e-5);
}

LAB_ITEM(10, "a floor that passes below the eye covers each pixel once") {
    // The horizon is straight and unclipped, and the near plane lies below the image. So the floor covers all rows
    // below a certain one, once, wherever its inner edges are.
    for (const int size : {1, 4, 15}) {
        const auto triangles = floor_mesh(item.random(), size, size, 0.25f);
        Image<int> expected(kWidth, kHeight, 0);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) expected(x, y) = (y + 0.5) / kHeight * 2 - 1 > 1.6 / 12;
        const auto none = [](const Triangle& t) { return std::vector<Triangle>{t}; };
        const auto dropped = [](const Triangle& t) {
            return z(t[0]) < 0 || z(t[1]) < 0 || z(t[2]) < 0 ? std::vector<Triangle>() : std::vector<Triangle>{t};
        };
        item.coverage(message("a floor of ", triangles.size(), " triangles"),
                      counts(triangles, [](const Triangle& t) { return STUDENT(clip_near)(t); }), expected,
                      {{counts(triangles, none), "Nothing was clipped: what is behind the eye is drawn upside down."},
                       {counts(triangles, dropped),
                        "Triangles with a corner behind the plane were dropped as a whole: cut them."}});
    }
}
