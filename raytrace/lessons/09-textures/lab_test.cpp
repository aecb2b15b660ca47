// The examiner of lab 09. Expected values are computed by hand, or in double: the place on the globe from angles, the
// weights of the noise from a sum of binomial terms.
#include "raytrace/lessons/09-textures/lab.h"
#include "tests/grading/judge.h"

#include <cmath>
#include <functional>
#include <vector>

using namespace duet;
using namespace duet::grading;

LAB_TITLE("raytrace-09", "Textures")

namespace {

constexpr double kPi2 = 2 * kPiDouble;

/// A small texture with four by two texels, all different. In the file's order: the upper row first.
ImageRgb small_texture() {
    ImageRgb image(4, 2);
    for (int x = 0; x < 4; ++x) {
        image(x, 0) = Rgb(0.1f * static_cast<float>(x), 1, 0);
        image(x, 1) = Rgb(0.1f * static_cast<float>(x), 0, 1);
    }
    return image;
}

/// A map of 8 × 4 letters F.
ImageRgb letters() {
    const char* rows[] = {"      ", " #### ", " #    ", " ###  ", " #    ", " #    ", "      "};
    ImageRgb image(48, 28);
    for (int y = 0; y < 28; ++y)
        for (int x = 0; x < 48; ++x)
            image(x, y) = rows[y % 7][x % 6] == '#'
                              ? Rgb(0.05f, 0.03f, 0.1f)
                              : Rgb(0.9f - 0.03f * static_cast<float>(y), 0.5f, 0.2f + 0.03f * static_cast<float>(y));
    return image;
}

/// 6t⁵ - 15t⁴ + 10t³ as Bernstein terms: the chance of at least 3 heads in 5 throws of a coin with heads t.
double smooth(double t) {
    const double s = 1 - t;
    return 10 * t * t * t * s * s + 5 * t * t * t * t * s + t * t * t * t * t;
}
double smooth_1985(double t) { return t * t * (3 - 2 * t); }
double straight(double t) { return t; }

/// How the noise of a student may differ from the contract's.
struct Variant {
    double (*weight)(double) = smooth;
    double (*lower)(double) = std::floor;           ///< the lower corner from p
    bool swapped = false;                           ///< far corners weigh more
    bool weight_of_product = false;                 ///< the weight of the three distances' product
    Vec3d (*offset)(Vec3d p, Vec3d base, Vec3d c) = ///< what the gradient is multiplied with
        [](Vec3d p, Vec3d, Vec3d c) { return p - c; };
    bool one_gradient = false; ///< the lower corner's everywhere
};
double noise(Vec3 at, const Variant& v = {}) {
    const Vec3d p(at), base{v.lower(p.x), v.lower(p.y), v.lower(p.z)};
    double sum = 0;
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const Vec3d c = base + Vec3d(i, j, k), g = v.one_gradient ? base : c;
                const Vec3d slope(lab::gradient(static_cast<int>(g.x), static_cast<int>(g.y), static_cast<int>(g.z)));
                Vec3d near(1 - std::abs(p.x - c.x), 1 - std::abs(p.y - c.y), 1 - std::abs(p.z - c.z));
                if (v.swapped) near = Vec3d(1, 1, 1) - near;
                const double weight = v.weight_of_product ? v.weight(near.x * near.y * near.z)
                                                          : v.weight(near.x) * v.weight(near.y) * v.weight(near.z);
                sum += weight * dot(slope, v.offset(p, base, c));
            }
    return sum;
}

Vec3 random_point(Rng& rng, double size) {
    const double x = rng.uniform(-size, size), y = rng.uniform(-size, size);
    return Vec3(Vec3d(x, y, rng.uniform(-size, size)));
}

} // namespace

LAB_ITEM(0, "the picture") {
    constexpr int kSize = 48;
    const ImageRgb map = letters();
    ImageRgb image(3 * kSize, kSize, Rgb(0.8f, 0.9f, 1));
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < 3 * kSize; ++x) {
            const double a = (x % kSize - kSize / 2 + 0.5) / 22, b = (kSize / 2 - y - 0.5) / 22, c2 = 1 - a * a - b * b;
            if (c2 < 0) continue;
            const Vec3 n(Vec3d(a, b, std::sqrt(c2)));
            if (x < kSize)
                image(x, y) = STUDENT(image_color)(map, STUDENT(sphere_uv)(n));
            else if (x < 2 * kSize)
                image(x, y) = Rgb(STUDENT(checker)(n * 3.0f) ? 0.1f : 0.7f);
            else
                image(x, y) = Rgb(0.5f + 0.5f * std::sin(4 * n.y + 8 * STUDENT(turbulence)(n * 1.7f, 4)));
        }
    item.show("your globe, cubes and marble", image);
}

LAB_ITEM(20, "the place on a globe") {
    const auto check = [&](Vec3 n) {
        const Vec3d d = normalize(Vec3d(n));
        const Vec2 found = STUDENT(sphere_uv)(n);
        const double ring = std::hypot(d.x, d.z), to_x = std::atan2(d.x, d.z) / kPi2;
        const double latitude = std::atan2(d.y, ring) / kPiDouble;
        const auto f = [](double x) { return static_cast<float>(x); };
        if (ring > 1e-3) {
            const double around = std::atan2(d.x, -d.z) / kPi2;
            item.near(
                message("u of the normal ", describe(n)), found.x, f(0.5 + to_x), 1e-5,
                {{f(0.5 + std::atan(d.x / d.z) / kPi2), "The back looks like the front: std::atan of a quotient can't "
                                                        "tell them apart. Use std::atan2."},
                 {f(0.5 - to_x), "The globe is mirrored: u must grow to the right, seen from outside."},
                 {f(0.5 + around), "The globe is mirrored, and its center is at -z: this is the map of a sky, which is "
                                   "seen from inside. Take the angle from +z to +x."},
                 {f(0.5 - around), "The center of the map is at -z: it must be at +z."},
                 {f(to_x), "It must be from 0 to 1: add 1/2."},
                 {f(to_x < 0 ? to_x + 1 : to_x), "It is half a turn off: u is 1/2 at +z."},
                 {f(0.5 + 2 * to_x), "A whole turn is 2π: divide the angle by that."},
                 {f(2 * to_x), "A whole turn is 2π: divide the angle by that, then add 1/2."},
                 {f(0.5 + std::atan2(d.z, d.x) / kPi2), "The arguments of atan2 are exchanged: it is atan2(x, z) here. "
                                                        "The angle is 0 at +z, and grows toward +x."},
                 {f(0.5 + std::atan2(-d.z, d.x) / kPi2), "It is a quarter of a turn off: u is 1/2 at +z."},
                 {f(0.5 + 0.5 * d.x), "This is x itself, as on a flat disk: u must grow evenly with the angle."},
                 {f(0.5 + std::asin(d.x) / kPi2), "This takes x alone. Away from the equator, and at the back, the "
                                                  "angle around the axis depends on z, too."}});
        }
        item.require(std::isfinite(found.x) && std::isfinite(found.y),
                     message("At the normal ", describe(n),
                             " the result isn't finite. Rounding can make a coordinate "
                             "larger than 1, and std::asin of that is not a number: clamp it first."));
        item.require(found.x >= 0 && found.x <= 1,
                     message("At the normal ", describe(n), " u is ", describe(found.x), ", which isn't from 0 to 1."));
        item.near(message("v of the normal ", describe(n)), found.y, f(0.5 + latitude), 2e-4, // asin is steep there
                  {{f(0.5 - latitude), "The globe is upside down: v is 1 at +y."},
                   {f(0.5 + latitude / 2), "From pole to pole the latitude changes by π, not by 2π."},
                   {f(latitude), "It must be from 0 to 1: add 1/2."},
                   {f(0.5 + d.y / 2), "This is the height: v must grow evenly with the latitude. Take the arcsine."},
                   {f(0.5 + 2 * latitude), "From pole to pole the latitude changes by π."}});
    };
    const float r = std::sqrt(0.5f);
    for (const Vec3 n : {Vec3{0, 0, 1},
                         {1, 0, 0},
                         {-1, 0, 0},
                         {r, 0, r},
                         {-r, 0, r},
                         {r, 0, -r},
                         {0, r, r},
                         {0, -r, r},
                         {0, 1, 0},
                         {0, -1, 0},
                         {0, 1.0000001f, 0},
                         {0, -1.0000002f, 0}})
        check(n);
    for (int i = 0; i < 200; ++i) {
        const Vec3d n = item.random().unit_vector();
        if (std::abs(n.x) > 0.01 || n.z > 0) check(Vec3(n)); // on the seam u may be 0 or 1
    }
}

LAB_ITEM(15, "the texel of an image") {
    const ImageRgb image = small_texture();
    const auto check = [&](double u, double v) {
        const auto at = [&](double column, double from_below) {
            const auto wrap = [](double i, int n) { return static_cast<int>(i - n * std::floor(i / n)); };
            return image(wrap(column, 4), wrap(1 - from_below, 2));
        };
        const double x = u * 4, y = v * 2;
        const auto row = [](double i) { return std::clamp(i, 0.0, 1.0); };
        const double right = row(std::floor(y));
        item.near(message("the texel at (u, v) = (", u, ", ", v, ") of an image with 4 × 2 texels"),
                  STUDENT(image_color)(image, Vec2(Vec2d(u, v))), at(std::floor(x), right), 1e-6,
                  {{at(std::floor(x), std::floor(y)),
                    "Above and below, the edge must go on: there is nothing beyond a pole. This repeats the image."},
                   {at(std::floor(x), 1 - right), "It is upside down: v = 0 is the bottom, row 0 is the top."},
                   {at(std::trunc(x), right),
                    "Negative u were cut off toward 0: use std::floor before the conversion to int."},
                   {at(std::clamp(std::floor(x), 0.0, 3.0), right),
                    "The image must repeat to the left and right: this is its edge."},
                   {at(3 - std::floor(x), right), "It is mirrored: column 0 is at the left."},
                   {at(std::round(x), row(std::round(y))),
                    "It was rounded: a texel begins at a whole number and ends at the next, so use std::floor."},
                   {at(std::floor(u * 3), row(std::floor(v))),
                    "Multiply by the number of texels, not by that number minus 1."},
                   {at(std::floor((u - std::floor(u)) * 3), row(std::floor(v))),
                    "Multiply by the number of texels, not by that number minus 1."},
                   {at(std::floor(u * 2), row(std::floor(v * 4))), "Width and height are exchanged."}});
    };
    for (const Vec2d uv : {Vec2d{0.3, 0.2},
                           {0.3, 0.8},
                           {0.45, 0.3},
                           {0.99, 0.1},
                           {0.01, 0.99},
                           {0, 0},
                           {0.6, 1},
                           {1, 0.5},
                           {1, 1},
                           {1.3, 0.2},
                           {-0.1, 0.2},
                           {-0.3, 0.8},
                           {0.3, 1.2},
                           {0.3, -0.2},
                           {-3.4, 7.7}})
        check(uv.x, uv.y);
    for (int i = 0; i < 100; ++i) {
        const double u = item.random().integer(-40, 40) / 8.0 + 1 / 16.0;
        check(u, item.random().integer(-16, 16) / 8.0 + 1 / 16.0);
    }
}

LAB_ITEM(15, "cubes in turn light and dark") {
    const auto odd = [](double sum) { return sum - 2 * std::floor(sum / 2) == 1; };
    const auto sum = [](Vec3d p, double (*whole)(double)) { return whole(p.x) + whole(p.y) + whole(p.z); };
    const std::vector<std::pair<std::function<bool(Vec3d)>, std::string>> mistakes{
        {[&](Vec3d p) { return odd(sum(p, std::trunc)); },
         "The coordinates were cut off toward 0, so the cubes there are twice as wide: use std::floor."},
        {[&](Vec3d p) { return std::fmod(sum(p, std::floor), 2) == 1; },
         "In C++ the remainder of a negative odd number is -1: compare it with 0, not with 1."},
        {[&](Vec3d p) { return std::fmod(sum(p, std::trunc), 2) == 1; },
         "The coordinates were cut off toward 0, so the cubes there are twice as wide: use std::floor. And in C++ the "
         "remainder of a negative odd number is -1: compare it with 0, not with 1."},
        {[&](Vec3d p) { return !odd(sum(p, std::floor)); },
         "Light and dark are exchanged: the cube from (0, 0, 0) to (1, 1, 1) is light."},
        {[&](Vec3d p) { return odd(sum(p, std::round)); },
         "The coordinates were rounded: a cube begins at a whole number, so use std::floor."},
        {[&](Vec3d p) { return odd(std::floor(p.x) + std::floor(p.z)); }, "y plays no part: these are columns."},
        {[&](Vec3d p) { return odd(std::floor(p.x) + std::floor(p.y)); }, "z plays no part: these are columns."},
        {[&](Vec3d p) { return std::sin(p.x) * std::sin(p.y) * std::sin(p.z) < 0; },
         "These cubes have the side π: std::sin changes its sign at multiples of π."},
        {[&](Vec3d p) { return odd(std::floor(p.x + p.y + p.z)); },
         "These are slanted layers: round each coordinate down first, then add."}};
    std::vector<Vec3> points{{0.5f, 0.5f, 0.5f},    {1.5f, 0.5f, 0.5f},   {0.5f, 1.5f, 0.5f},  {0.5f, 0.5f, 1.5f},
                             {1.5f, 1.5f, 0.5f},    {-0.5f, 0.5f, 0.5f},  {0.5f, -0.5f, 0.5f}, {0.5f, 0.5f, -0.5f},
                             {-0.5f, -0.5f, -0.5f}, {-0.5f, -1.5f, -0.5f}};
    const auto coordinate = [&] { return item.random().integer(-40, 40) / 8.0 + 1 / 16.0; };
    for (int i = 0; i < 200; ++i) {
        const double x = coordinate(), y = coordinate();
        points.push_back(Vec3(Vec3d(x, y, coordinate())));
    }
    std::vector<bool> found;
    for (const Vec3 p : points) found.push_back(STUDENT(checker)(p));
    std::string hint;
    for (const auto& [wrong, text] : mistakes) { // one that explains all that was found
        bool same = hint.empty();
        for (std::size_t i = 0; i < points.size() && same; ++i) same = wrong(Vec3d(points[i])) == found[i];
        if (same) hint = text;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool is = found[i];
        item.equal(message("whether ", describe(points[i]), " is dark"), is, odd(sum(Vec3d(points[i]), std::floor)),
                   {{is, hint}});
    }
}

LAB_ITEM(10, "the curve of the weights") {
    const auto check = [&](double t) {
        const auto f = [](double x) { return static_cast<float>(x); };
        item.near(message("fade(", t, ")"), STUDENT(fade)(f(t)), f(smooth(t)), 2e-6,
                  {{f(smooth_1985(t)), "This is 3t² - 2t³. Its slope is 0 at both ends, but its curvature is not: it "
                                       "jumps there. The contract's curve has the fifth power."},
                   {f(t), "This is a straight line: noise with it has creases."},
                   {f(1 - smooth(t)), "It falls from 1 to 0: fade(0) is 0, and fade(1) is 1."},
                   {f(6 * std::pow(t, 5) + 15 * std::pow(t, 4) + 10 * std::pow(t, 3)), "The sign of 15t⁴ is minus."},
                   {f(t * (t * (t * 6 - 15) + 10)), "The powers are too low: there is a factor t³ before the bracket "
                                                    "(t(6t - 15) + 10)."}});
    };
    check(0.25); // by hand: (1/64)·(1/4·(6/4 - 15) + 10) = 6.625/64 = 0.103515625
    for (const double t : {0.0, 1.0, 0.5, 0.75, 0.01}) check(t);
    for (int i = 0; i < 50; ++i) check(static_cast<double>(static_cast<float>(item.random().uniform())));
}

LAB_ITEM(25, "gradient noise") {
    using V = Vec3d;
    std::vector<std::pair<Variant, std::string>> mistakes(10);
    mistakes[0] = {{.offset = [](V p, V, V c) { return c - p; }},
                   "The sign is wrong: the vector goes from the corner to the point, p - c."};
    mistakes[1] = {{.offset = [](V p, V base, V) { return p - base; }},
                   "All corners have the same vector: each needs its own, p - c."};
    mistakes[2] = {{.offset = [](V p, V, V) { return p; }}, "The gradients are multiplied with p itself: take p - c."};
    mistakes[3] = {{.offset = [](V p, V, V c) { return normalize(p - c); }},
                   "The vector p - c was normalized: its length counts."};
    mistakes[4] = {{.offset =
                        [](V p, V base, V c) {
                            return V(smooth(p.x - base.x), smooth(p.y - base.y), smooth(p.z - base.z)) - (c - base);
                        }},
                   "fade belongs to the weights alone: the vector p - c takes the coordinates as they are."};
    mistakes[5] = {{.weight = straight}, "The weights are not faded: the noise has creases."};
    mistakes[6] = {{.weight = smooth_1985}, "The weights are those of 3t² - 2t³."};
    mistakes[7] = {{.swapped = true}, "The weights are exchanged: a corner counts fully where p is at it."};
    mistakes[8] = {{.weight_of_product = true}, "Fade the nearness along each axis, then multiply; not the product."};
    mistakes[9] = {{.one_gradient = true}, "All corners have the gradient of the lowest: each has its own."};
    const Variant cut{.lower = std::trunc};
    const auto check = [&](const std::string& what, Vec3 p, double tolerance) {
        std::vector<Mistake<float>> values;
        for (const auto& [variant, text] : mistakes) values.push_back({static_cast<float>(noise(p, variant)), text});
        values.push_back({static_cast<float>(noise(p, cut)),
                          "Negative coordinates were cut off toward 0: use std::floor before the conversion to int."});
        item.near(message(what, " at ", describe(p)), STUDENT(gradient_noise)(p), static_cast<float>(noise(p)),
                  tolerance, values);
    };
    // Between the corners, positive coordinates first.
    for (const Vec3 p : {Vec3{0.3f, 0.4f, 0.2f}, {2.7f, 1.2f, 5.6f}, {-0.3f, 0.4f, 0.2f}, {-1.7f, -2.2f, -0.6f}})
        check("the noise", p, 1e-5);
    for (int i = 0; i < 200; ++i) check("the noise", random_point(item.random(), 8), 1e-5);
    for (int i = 0; i < 30; ++i) {
        const auto whole = [&] { return item.random().integer(-9, 9); };
        const int x = whole(), y = whole();
        const Vec3 corner(Vec3T<int>(x, y, whole()));
        check("the noise at a corner, where it is 0,", corner, 1e-6);
        for (const Vec3 step : {Vec3{0x1p-10f, 0, 0}, {0, 0x1p-10f, 0}, {0, 0, 0x1p-10f}}) {
            check("the noise beside a corner", corner + step, 1e-6);
            check("the noise beside a corner", corner - step, 1e-6);
        }
    }
}

LAB_ITEM(15, "turbulence: a sum of noises") {
    bool any = false;
    for (int i = 0; i < 60; ++i) {
        const Vec3 p = random_point(item.random(), 4);
        const int octaves = i < 8 ? i : item.random().integer(1, 8);
        std::vector<double> n; // of your own noise, so that a mistake there isn't counted twice
        for (int k = 0; k <= octaves; ++k)
            n.push_back(static_cast<double>(STUDENT(gradient_noise)(p * std::exp2(static_cast<float>(k)))));
        any = any || std::abs(n[0]) > 1e-3;
        const auto sum = [&](int count, double shrink, const auto& value) {
            double total = 0;
            for (int k = 0; k < count; ++k) total += value(n[static_cast<std::size_t>(k)]) * std::pow(shrink, k);
            return total;
        };
        const auto size = [](double x) { return std::abs(x); };
        const auto same = [](double x) { return x; };
        const auto first = [&](double) { return std::abs(n[0]); };
        const auto f = [](double x) { return static_cast<float>(x); };
        item.near(message("turbulence at ", describe(p), " with ", octaves, " octaves of your gradient_noise"),
                  STUDENT(turbulence)(p, octaves), f(sum(octaves, 0.5, size)), 1e-5,
                  {{f(std::abs(sum(octaves, 0.5, same))), "This is the absolute value of the sum: take the absolute "
                                                          "value of each noise, then add."},
                   {f(sum(octaves, 0.5, same)), "Noise of both signs is added: take the absolute value of each."},
                   {f(sum(octaves, 1, size)), "All octaves are equally strong: each has half the strength of the one "
                                              "before."},
                   {f(sum(octaves + 1, 0.5, size)), "There is one octave too many."},
                   {f(sum(octaves - 1, 0.5, size)), "There is one octave too few."},
                   {f(sum(octaves, 0.5, first)), "All octaves have the same point: p doubles from one to the next."},
                   {f(sum(octaves, 2, size)), "Each octave has twice the strength of the one before: halve it."}});
    }
    item.require(any, "Your gradient_noise is 0 everywhere, so this sum tells nothing: write that function first.");
}
