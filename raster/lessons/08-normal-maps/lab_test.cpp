// The examiner of raster lab 08. Triangles are made from their tangents, so that these are known before; other values
// are computed by hand or in double.
#include "common/image/srgb.h"
#include "raster/lessons/08-normal-maps/lab.h"
#include "tests/grading/judge.h"

#include <cmath>
#include <functional>

using namespace duet;
using namespace duet::grading;
using lab::TangentFrame, lab::Tangents;

LAB_TITLE("raster-08", "Normal maps")

namespace {

using T = std::optional<Tangents>;
using Corners = std::array<Vec3, 3>;
using Places = std::array<Vec2, 3>;

Vec3 point(Rng& rng, double size) {
    return Vec3(Vec3d(rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)));
}

/// Slopes of a relief in x (to the right) and y (up).
struct Slopes {
    double x, y;
};
/// The height in a column and a row from the lower left corner; it repeats.
double height_at(const ImageFloat& heights, int i, int j) {
    const int w = heights.width(), h = heights.height();
    return static_cast<double>(heights((i + w) % w, h - 1 - (j + h) % h));
}
/// A map from the slopes of each texel. `scale` is for mistakes: what normals are multiplied by.
ImageRgb map_by(const ImageFloat& heights, const std::function<Rgb(Slopes)>& color,
                const std::function<Slopes(int, int)>& slopes) {
    ImageRgb map(heights.width(), heights.height());
    for (int j = 0; j < map.height(); ++j)
        for (int i = 0; i < map.width(); ++i) map(i, map.height() - 1 - j) = color(slopes(i, j));
    return map;
}
Rgb encoded(Vec3d n) { return Rgb(Rgbd((n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2)); }
Rgb color_of(Slopes s) { return encoded(normalize(Vec3d(-s.x, -s.y, 1))); }

/// A dome within a rim, 40 texels wide and high.
ImageFloat shield() {
    ImageFloat heights(40, 40);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) {
            const double d = std::hypot(x - 19.5, y - 19.5);
            const double dome = std::sqrt(std::max(0.0, 81 - d * d));
            heights(x, y) = static_cast<float>(dome + std::sqrt(std::max(0.0, 9 - (d - 15) * (d - 15))));
        }
    return heights;
}

} // namespace

LAB_ITEM(0, "the pictures") {
    ImageRgb map = STUDENT(normal_map)(shield()), lit(40, 40);
    item.require(map.width() == 40 && map.height() == 40, "Your normal map has another size than the heights.");
    const Vec3 n{0, 0, 1}, light = normalize(Vec3{-1, 2, 2});
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) {
            const Vec3 mapped = STUDENT(decode_normal)(map(x, y));
            const Vec3 bent = STUDENT(perturb)(n, TangentFrame{{1, 0, 0}, {0, 1, 0}}, mapped);
            lit(x, y) = Rgb(0.5f, 0.32f, 0.09f) * (0.05f + max(dot(bent, light), 0.0f));
        }
    for (Rgb& c : map.pixels()) c = {srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b)};
    item.show("your normal map", map);
    item.show("your shield, lit from above", lit);
}

LAB_ITEM(25, "the tangents of a triangle") {
    const auto check = [&](const std::string& what, const Corners& p, const Places& uv, Tangents right,
                           double tolerance) {
        const Vec3 pq = p[1] - p[0], pr = p[2] - p[0];
        const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
        const float det = a.x * b.y - a.y * b.x;
        const Vec3 u = right.along_u, v = right.along_v;
        item.near(
            what, STUDENT(tangents)(p, uv), T(right), tolerance,
            {{T(), "The three places are not on one line of the texture, so there are tangents."},
             {T({v, u}), "along_u and along_v are swapped."},
             {T({u * det, v * det}), "They are not divided by the determinant."},
             {T({u * std::abs(det), v * std::abs(det)}), "They are not divided by the determinant."},
             {T({u * (det * det), v * (det * det)}), "They are multiplied by the determinant: divide by it."},
             {T({-u, -v}), "Both point the opposite way: the determinant is du1·dv2 - dv1·du2, not its negative."},
             {T({(pq * b.y + pr * a.y) / det, v}), "along_u has a wrong sign: there is a minus between the two edges."},
             {T({(pq * b.y + pr * a.y) / det, (pr * a.x + pq * b.x) / det}),
              "There is a wrong sign: there is a minus between the two edges."},
             {T({u, -v}), "along_v points the opposite way."},
             {T({-u, v}), "along_u points the opposite way."},
             {T({(pq * b.y - pr * b.x) / det, (pr * a.x - pq * a.y) / det}),
              "The inverse matrix is transposed: its minus signs stand at dv1 for along_u and at du2 for along_v."},
             {T({normalize(u), normalize(v)}), "They are normalized: here they keep their lengths."},
             {T({pq, pr}), "These are the edges of the triangle: they follow u and v only if the texture does."}});
    };
    check("the tangents of (0, 0, 0), (2, 0, 0), (0, 3, 0) at uv (0, 0), (0.5, 0), (0, 0.25)",
          {Vec3{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}, {Vec2{0, 0}, {0.5f, 0}, {0, 0.25f}}, {{4, 0, 0}, {0, 12, 0}}, 1e-5);
    // By hand: the edges (0, 0, 2) = U + V and (0, 3, 0) = V.
    check("the tangents of (1, 1, 1), (1, 1, 3), (1, 4, 1) at uv (0, 0), (1, 1), (0, 1)",
          {Vec3{1, 1, 1}, {1, 1, 3}, {1, 4, 1}}, {Vec2{0, 0}, {1, 1}, {0, 1}}, {{0, -3, 2}, {0, 3, 0}}, 1e-5);
    const T none = STUDENT(tangents)(Corners{Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, Places{Vec2{0, 0}, {1, 2}, {2, 4}});
    item.near("the tangents where the three uv lie on one line, (0, 0), (1, 2), (2, 4)", none, T(), 0,
              {{none, none && is_finite(none->along_u)
                          ? "The determinant du1·dv2 - dv1·du2 is 1·4 - 2·2 = 0 here: return nothing. Is there a plus "
                            "in yours?"
                          : "The determinant is 0 here, and something was divided by it: test it first, and return "
                            "nothing."}});
    for (int i = 0; i < 100; ++i) {
        Rng& rng = item.random();
        const auto place = [&] {
            const double u = rng.uniform(-1, 1);
            return Vec2(Vec2d(u, rng.uniform(-1, 1)));
        };
        const Vec3 u = point(rng, 2), v = point(rng, 2), origin = point(rng, 3);
        const Places uv{place(), place(), place()};
        const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
        if (std::abs(a.x * b.y - a.y * b.x) < 0.1f) continue;
        const auto at = [&](Vec2 place_) { return origin + u * place_.x + v * place_.y; };
        check("the tangents of a random triangle", {at(uv[0]), at(uv[1]), at(uv[2])}, uv, {u, v}, 1e-4);
    }
}

LAB_ITEM(20, "a frame at right angles") {
    const auto check = [&](const std::string& what, Vec3 n, Tangents in, TangentFrame right, double tolerance) {
        const Vec3 across = in.along_u - n * dot(n, in.along_u), t = right.t, b = right.b;
        item.near(
            what, STUDENT(tangent_frame)(n, in), right, tolerance,
            {{{in.along_u, in.along_v}, "These are the tangents, unchanged."},
             {{t, -b},
              dot(cross(n, t), b) > 0
                  ? "b points against v: the cross product is that of n and t, not of t and n."
                  : "b points against v: this texture is mirrored, so the frame is left-handed. Turn b around."},
             {{normalize(in.along_u), normalize(in.along_v)},
              "They are normalized, but not at right angles to n: subtract the part along n first."},
             {{across, cross(n, across) * (dot(cross(n, across), in.along_v) < 0 ? -1.0f : 1.0f)},
              "Their lengths are not 1: normalize t."},
             {{normalize(in.along_u), cross(n, normalize(in.along_u))},
              "t is not at right angles to n: subtract the part of along_u that points along n."},
             {{normalize(in.along_u), normalize(cross(n, in.along_u))},
              "t is not at right angles to n: subtract the part of along_u that points along n."},
             {{t, normalize(in.along_v - n * dot(n, in.along_v))},
              "b is not at right angles to t: take the cross product of n and t."},
             {{t, normalize(in.along_v)}, "b is not at right angles to n and t: take the cross product of n and t."},
             {{-t, b}, "t points against u."},
             {{-t, -b},
              dot(cross(n, t), b) < 0 ? "t was turned around where the texture is mirrored: turn b around, "
                                        "since t must follow u."
                                      : "t points against u, and so b points against v."},
             {{b, t}, "t and b are swapped."}});
    };
    check("the frame of n = (0, 0, 1), along_u = (2, 0, 1), along_v = (1, 3, 0)", {0, 0, 1}, {{2, 0, 1}, {1, 3, 0}},
          {{1, 0, 0}, {0, 1, 0}}, 1e-5);
    check("the frame of n = (0, 1, 0), along_u = (0, 0, 5), along_v = (2, 1, 0)", {0, 1, 0}, {{0, 0, 5}, {2, 1, 0}},
          {{0, 0, 1}, {1, 0, 0}}, 1e-5);
    check("the frame of a mirrored texture: n = (0, 0, 1), along_u = (2, 0, 0), along_v = (0, -3, 0)", {0, 0, 1},
          {{2, 0, 0}, {0, -3, 0}}, {{1, 0, 0}, {0, -1, 0}}, 1e-5);
    for (int i = 0; i < 100; ++i) {
        Rng& rng = item.random();
        const Vec3d n = rng.unit_vector(), t = normalize(cross(n, rng.unit_vector())), b = cross(n, t);
        const double side = i % 2 ? 1 : -1;
        const Vec3d u = t * rng.uniform(0.3, 3) + n * rng.uniform(-1, 1);
        const Vec3d v = b * (side * rng.uniform(0.3, 3)) + t * rng.uniform(-1, 1) + n * rng.uniform(-1, 1);
        check("the frame of a random texture", Vec3(n), {Vec3(u), Vec3(v)}, {Vec3(t), Vec3(b * side)}, 2e-5);
    }
}

LAB_ITEM(10, "the normal of a texel") {
    const auto check = [&](Rgb c) {
        const Vec3 v{c.r, c.g, c.b}, right = v * 2.0f - Vec3{1, 1, 1};
        const Vec3 decoded{2 * srgb_decode(c.r) - 1, 2 * srgb_decode(c.g) - 1, 2 * srgb_decode(c.b) - 1};
        item.near(
            "the normal of the texel " + describe(c), STUDENT(decode_normal)(c), right, 1e-5,
            {{v, "Components below 0 are missing: 2 c - 1 maps [0, 1] to [-1, 1]."},
             {v - Vec3{0.5f, 0.5f, 0.5f}, "This is half of it: c - 0.5 ends at 0.5. Multiply by 2, too."},
             {v * 2.0f, "Subtract 1 after you multiply by 2."},
             {decoded, "The texel was decoded by the sRGB curve: a normal map holds no colors, so leave that out."},
             {{right.x, -right.y, right.z}, "Green is flipped: here it counts up, along v."},
             {{right.x, right.y, c.b}, "Blue is a component as the others: it goes from -1 to 1, too."},
             {normalize(right), "It is normalized already: that comes later, in perturb."}});
    };
    check({0.5f, 0.5f, 1});
    check({0.8f, 0.25f, 0.9f});
    check({0.1f, 0.6f, 0.4f});
}

LAB_ITEM(20, "the normal in the world") {
    const auto check = [&](const std::string& what, Vec3 n, TangentFrame f, Vec3 m, double tolerance) {
        const Vec3d sum = Vec3d(f.t) * static_cast<double>(m.x) + Vec3d(f.b) * static_cast<double>(m.y) +
                          Vec3d(n) * static_cast<double>(m.z);
        item.near(
            what, STUDENT(perturb)(n, f, m), Vec3(normalize(sum)), tolerance,
            {{Vec3(sum), "Its length is not 1: normalize the result."},
             {normalize(m),
              "This is the normal of the map itself: its components count along t, b and n, not along x, y and z."},
             {m, "This is the normal of the map itself: its components count along t, b and n, not along x, y and z."},
             {normalize(Vec3{dot(f.t, m), dot(f.b, m), dot(n, m)}),
              "These are dot products with t, b and n: they lead from the world to the frame. Here it is the other "
              "way."},
             {normalize(n + f.t * m.x + f.b * m.y), "The third component is missing: multiply n by it."},
             {normalize(n + Vec3(sum)), "n is added once more: the sum of the three parts is all."},
             {normalize(f.t * m.y + f.b * m.x + n * m.z), "t and b are swapped: the first component counts along t."},
             {normalize(f.t * m.x - f.b * m.y + n * m.z), "The second component has the wrong sign."},
             {n, "This is the normal without the map."}});
    };
    const TangentFrame floor{{1, 0, 0}, {0, 0, -1}};
    check("the normal of a floor, n = (0, 1, 0), t = (1, 0, 0), b = (0, 0, -1), for the map's (0.6, 0, 0.8)", {0, 1, 0},
          floor, {0.6f, 0, 0.8f}, 1e-5);
    check("the same floor for the map's (0, 0.6, 0.8)", {0, 1, 0}, floor, {0, 0.6f, 0.8f}, 1e-5);
    check("the same floor for the map's (0, 0, 1)", {0, 1, 0}, floor, {0, 0, 1}, 1e-5);
    check("the same floor for the map's (0.5, 0.5, 0.5), which is not 1 long", {0, 1, 0}, floor, {0.5f, 0.5f, 0.5f},
          1e-5);
    for (int i = 0; i < 100; ++i) {
        Rng& rng = item.random();
        const Vec3d n = rng.unit_vector(), t = normalize(cross(n, rng.unit_vector()));
        const Vec3d b = cross(n, t) * (i % 2 ? 1.0 : -1.0);
        const Vec3 m(rng.unit_vector() * rng.uniform(0.5, 2));
        check(message("the normal for n = ", describe(Vec3(n)), ", t = ", describe(Vec3(t)),
                      ", b = ", describe(Vec3(b)), " and the map's ", describe(m)),
              Vec3(n), {Vec3(t), Vec3(b)}, m, 2e-5);
    }
}

LAB_ITEM(25, "the normal map of a relief") {
    const auto check = [&](const std::string& name, const ImageFloat& heights) {
        const auto h = [&heights](int i, int j) { return height_at(heights, i, j); };
        const auto right = [&](int i, int j) {
            return Slopes{(h(i + 1, j) - h(i - 1, j)) / 2, (h(i, j + 1) - h(i, j - 1)) / 2};
        };
        const auto changed = [&](double x, double y) {
            return map_by(heights, color_of, [=](int i, int j) {
                const Slopes s = right(i, j);
                return Slopes{s.x * x, s.y * y};
            });
        };
        const int last_x = heights.width() - 1, last_y = heights.height() - 1;
        const auto clamped = [&](int i, int j) { return h(std::clamp(i, 0, last_x), std::clamp(j, 0, last_y)); };
        const std::function<Slopes(int, int)> at_edges = [&](int i, int j) {
            return Slopes{(clamped(i + 1, j) - clamped(i - 1, j)) / 2, (clamped(i, j + 1) - clamped(i, j - 1)) / 2};
        };
        const auto forward = [&](int i, int j) { return Slopes{h(i + 1, j) - h(i, j), h(i, j + 1) - h(i, j)}; };
        const auto swapped = [&](int i, int j) { return Slopes{right(i, j).y, right(i, j).x}; };
        const auto raw = [](Slopes s) { return encoded(Vec3d(-s.x, -s.y, 1)); };
        const auto unencoded = [](Slopes s) {
            const Vec3d n = normalize(Vec3d(-s.x, -s.y, 1));
            return Rgb(Rgbd(n.x, n.y, n.z));
        };
        const ImageRgb found = STUDENT(normal_map)(heights), expected = map_by(heights, color_of, right);
        bool inside = found.width() == expected.width() && found.height() == expected.height();
        for (int y = 1; y < last_y && inside; ++y)
            for (int x = 1; x < last_x && inside; ++x) inside = is_near(found(x, y), expected(x, y), 1e-3);
        item.image(
            name, found, expected, 1e-3,
            {{changed(-1, -1), "Bumps have become dents: a normal leans away from the slope, so its x and y are the "
                               "negative slopes."},
             {changed(1, -1), "The second component has the wrong sign: v counts up, but rows count down."},
             {changed(-1, 1), "The first component has the wrong sign: the normal is (-slope, …, 1)."},
             {changed(2, 2), "The slopes are twice too large: the two neighbors are 2 texels apart."},
             {map_by(heights, color_of, forward),
              "This is the difference to the next texel: take that of the two neighbors, and half "
              "of it."},
             {map_by(heights, color_of, swapped), "The slopes along u and v are swapped."},
             {map_by(heights, raw, right), "The normals are not 1 long: normalize them before they become colors."},
             {map_by(heights, unencoded, right), "The components are not encoded: colors are (n + 1) / 2."},
             {map_by(heights, color_of, at_edges),
              "At the edges a neighbor is wrong: the relief repeats, so beyond the last texel comes the "
              "first."},
             {changed(0, 0), "The map is flat: its normals don't depend on the heights."},
             {inside ? found : expected,
              "Only texels at the edges are wrong. The relief repeats there. In C++, -1 % 4 is -1, and not 3: add the "
              "size first."}});
    };
    ImageFloat ramp(6, 4, 0.0f);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 6; ++x) ramp(x, y) = static_cast<float>(std::min(x, 5 - x)) + (y == 1 ? 0.5f : 0.0f);
    check("a roof with a ridge", ramp);
    check("a shield", shield());
    ImageFloat random(12, 7, 0.0f);
    for (float& h : random.pixels()) h = static_cast<float>(item.random().uniform(0, 1.5));
    check("a rough surface", random);
}
