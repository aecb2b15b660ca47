// The examiner of raster lab 06. The first values of each item are computed by hand, the random ones in double.
#include "common/image/image.h"
#include "common/vec/matrix.h"
#include "raster/lessons/06-shading/lab.h"
#include "tests/grading/judge.h"

#include <cmath>

using namespace duet;
using namespace duet::grading;

LAB_TITLE("raster-06", "Flat, Gouraud and Phong shading")

namespace {

using N = std::optional<Vec3>;
using Columns = std::array<Vec3, 3>;

Vec3 point(Rng& rng, double size) {
    return Vec3(Vec3d(rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)));
}
Vec3d apply(const Columns& m, Vec3d v) { return Vec3d(m[0]) * v.x + Vec3d(m[1]) * v.y + Vec3d(m[2]) * v.z; }
double determinant(const Columns& m) { return dot(Vec3d(m[0]), cross(Vec3d(m[1]), Vec3d(m[2]))); }

/// A normal after a map, by the lesson's way: the transpose of the inverse matrix.
Vec3 expected_normal(const Columns& columns, Vec3 n) {
    Mat4d m;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) m[r][c] = static_cast<double>(columns[c][r]);
    return Vec3(normalize(transform_normal(inverse_affine(m), Vec3d(n))));
}

/// Blinn and Phong in double.
Rgb expected_light(Vec3 p, Vec3 n, Vec3 light, Vec3 eye, Rgb diffuse, float specular, float shininess) {
    const Vec3d l = normalize(Vec3d(light) - Vec3d(p)), e = normalize(Vec3d(eye) - Vec3d(p));
    const double cosine = dot(Vec3d(n), l), middle = dot(Vec3d(n), normalize(l + e));
    if (cosine <= 0) return Rgb(0);
    const double highlight = static_cast<double>(specular) * std::pow(middle, static_cast<double>(shininess));
    return Rgb(Rgbd(diffuse) * cosine + Rgbd(highlight));
}

} // namespace

LAB_ITEM(0, "the picture") {
    constexpr int kSize = 72;
    ImageRgb image(kSize, kSize, Rgb(0.02f, 0.024f, 0.035f));
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const double px = (x + 0.5) / 32 - 1.125, py = 1.125 - (y + 0.5) / 32, rest = 1 - px * px - py * py;
            if (rest < 0) continue;
            const Vec3 n(Vec3d(px, py, std::sqrt(rest)));
            image(x, y) = STUDENT(blinn_phong)(n, n, Vec3{-3, 4, 5}, Vec3{0, 0, 6}, Rgb(0.04f, 0.32f, 0.4f), 0.8f, 60);
        }
    item.show("your sphere", image);
}

LAB_ITEM(15, "Lambert's law") {
    item.near("the cosine for light from straight above", STUDENT(lambert)(Vec3{0, 1, 0}, Vec3{0, 1, 0}), 1, 1e-6,
              {{0, "Light from the front gives none: both vectors point away from the surface, so no sign is needed."},
               {-1, "Both vectors point away from the surface, so no sign is needed."}});
    item.near("the cosine for n = (0, 0, 1) and the direction (3, 0, 4)",
              STUDENT(lambert)(Vec3{0, 0, 1}, Vec3{3, 0, 4}), 0.8f, 1e-6,
              {{4, "The direction has the length 5: make it 1 long before the dot product."},
               {0.6f, "This is the sine: the dot product gives the cosine."},
               {0, "Light from the front gives none: both vectors point away from the surface, so no sign is needed."},
               {0.64f, "The cosine is squared."}});
    item.near(
        "the cosine for light from behind, n = (0, 0, 1) and the direction (3, 0, -4)",
        STUDENT(lambert)(Vec3{0, 0, 1}, Vec3{3, 0, -4}), 0, 1e-6,
        {{-0.8f, "It is negative: a light source behind the surface takes no light away. Return 0 there."},
         {-4, "It is negative: a light source behind the surface takes no light away. Return 0 there."},
         {0.8f, "The sign is lost: a light source behind the surface must give 0. Don't take the absolute value."}});
    for (int i = 0; i < 100; ++i) {
        const Vec3 n(item.random().unit_vector()), l(item.random().unit_vector() * item.random().uniform(0.1, 9));
        const double cosine = std::max(0.0, dot(Vec3d(n), normalize(Vec3d(l))));
        item.near(message("the cosine for n = ", describe(n), " and the direction ", describe(l)),
                  STUDENT(lambert)(n, l), static_cast<float>(cosine), 1e-5);
    }
}

LAB_ITEM(20, "the normal of a triangle") {
    const std::string inward = "It points to the other side: swap the two edges of the cross product.";
    item.near("the normal of (0, 0, 0), (2, 0, 0), (0, 2, 0), counter-clockwise seen from +z",
              STUDENT(flat_normal)(Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{0, 2, 0}), N(Vec3{0, 0, 1}), 1e-6,
              {{N(Vec3{0, 0, 4}), "Its length is 4, twice the area: normalize the cross product."},
               {N(Vec3{0, 0, -4}), inward + " Normalize it, too."},
               {N(Vec3{0, 0, -1}), inward},
               {N(Vec3{0, 0, 2}), "Its length is 2, the area: normalize the cross product."},
               {N(), "The triangle has the area 2, so it has a normal."}});
    item.near("the normal of (1, 1, 1), (1, 1, 3), (1, 4, 1), which is at right angles to the x axis",
              STUDENT(flat_normal)(Vec3{1, 1, 1}, Vec3{1, 1, 3}, Vec3{1, 4, 1}), N(Vec3{-1, 0, 0}), 1e-6,
              {{N(Vec3{1, 0, 0}), inward},
               {N(normalize(cross(Vec3{1, 1, 3}, Vec3{1, 4, 1}))),
                "This is the cross product of two corners: subtract the third corner from both first."}});
    item.near("the normal of a triangle whose corners lie on one line",
              STUDENT(flat_normal)(Vec3{0, 0, 0}, Vec3{1, 2, 3}, Vec3{2, 4, 6}), N(), 0,
              {{N(Vec3{NAN, NAN, NAN}), "This is not a number, 0 / 0: test the cross product before you normalize it."},
               {N(Vec3{0, 0, 0}), "A vector of length 0 is no normal: return nothing."}});
    for (int i = 0; i < 100; ++i) {
        const double size = std::array{0.001, 1.0, 500.0}[static_cast<std::size_t>(i % 3)];
        const Vec3 a = point(item.random(), size), b = point(item.random(), size), c = point(item.random(), size);
        const Vec3d area = cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
        if (length(area) < 0.05 * size * size) continue; // narrow: rounding decides
        item.near(message("the normal of ", describe(a), ", ", describe(b), ", ", describe(c)),
                  STUDENT(flat_normal)(a, b, c), N(Vec3(normalize(area))), 1e-4,
                  {{N(), "The triangle is small, but it has an area: compare with exactly 0."},
                   {N(Vec3(normalize(-area))), inward}});
    }
}

LAB_ITEM(25, "normals go by the transpose of the inverse") {
    const auto check = [&](const std::string& what, const Columns& m, Vec3 n, double tolerance) {
        const Vec3 right = expected_normal(m, n), by_matrix(normalize(apply(m, Vec3d(n)))), mirrored = -right;
        const double flip = determinant(m) < 0 ? -1 : 1, det = determinant(m);
        Columns rows;
        for (std::size_t r = 0; r < 3; ++r) rows[r] = {m[0][r], m[1][r], m[2][r]};
        const auto length_of = [&](double divided) { // of the formula's result without normalize
            return Vec3((cross(Vec3d(m[1]), Vec3d(m[2])) * static_cast<double>(n.x) +
                         cross(Vec3d(m[2]), Vec3d(m[0])) * static_cast<double>(n.y) +
                         cross(Vec3d(m[0]), Vec3d(m[1])) * static_cast<double>(n.z)) /
                        divided);
        };
        item.near(
            what, STUDENT(transform_normal)(m, n), right, tolerance,
            {{by_matrix, "This is the map of points, applied to the normal: it is not at right angles to the "
                         "stretched surface. Use the transpose of the inverse."},
             {Vec3(apply(m, Vec3d(n))), "This is the map of points, applied to the normal. Use the transpose of the "
                                        "inverse, and normalize."},
             {mirrored, flip < 0 ? "It points to the wrong side: this map mirrors. Its determinant is negative, so "
                                   "the cross products must change their sign."
                                 : "It points to the wrong side: the cross products go around in the order 0, 1, 2."},
             {expected_normal(rows, n), "This is the inverse, not its transpose: columns and rows are swapped."},
             {length_of(1), "The direction is right. Its length is not 1: normalize the result."},
             {length_of(det), "The direction is right. Its length is not 1: normalize the result."},
             {length_of(flip), "The direction is right. Its length is not 1: normalize the result."},
             {n, "This is the normal as it was before the map."}});
    };
    check("the normal (0.6, 0.8, 0) after a map that doubles x", {Vec3{2, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0.6f, 0.8f, 0},
          1e-5); // by hand: (0.3, 0.8, 0) / sqrt(0.73)
    check("the normal (0, 1, 0) after a shear, x += y", {Vec3{1, 0, 0}, {1, 1, 0}, {0, 0, 1}}, {0, 1, 0}, 1e-5);
    check("the normal (1, 0, 0) after the same shear", {Vec3{1, 0, 0}, {1, 1, 0}, {0, 0, 1}}, {1, 0, 0}, 1e-5);
    check("the normal (0, 1, 0) after a quarter turn", {Vec3{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, {0, 1, 0}, 1e-5);
    check("the normal (0.6, 0.8, 0) after a mirror, x = -x", {Vec3{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0.6f, 0.8f, 0},
          1e-5);
    for (int i = 0; i < 100; ++i) {
        const Columns m{point(item.random(), 2), point(item.random(), 2), point(item.random(), 2)};
        if (std::abs(determinant(m)) < 0.5) continue;
        check("the normal after a random map", m, Vec3(item.random().unit_vector()), 1e-3);
    }
}

LAB_ITEM(15, "a normal between three corners") {
    const Columns axes{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const float third = 1 / 3.0f, root = 1 / std::sqrt(3.0f);
    item.near(
        "the normal in the middle of a triangle with the normals x, y and z",
        STUDENT(interpolated_normal)(axes, Vec3{third, third, third}), Vec3{root, root, root}, 1e-5,
        {{Vec3{third, third, third}, "Its length is 0.577: the mean of unit vectors is shorter than 1. Normalize it."},
         {Vec3{1, 0, 0}, "This is the normal of the first corner."}});
    item.near("the normal at weights (0, 0.6, 0.4)", STUDENT(interpolated_normal)(axes, Vec3{0, 0.6f, 0.4f}),
              Vec3{0, 0.6f, 0.4f} / std::sqrt(0.52f), 1e-5,
              {{Vec3{0, 0.6f, 0.4f}, "Its length is 0.72: the mean of unit vectors is shorter than 1. Normalize it."},
               {Vec3{0, 0.4f, 0.6f} / std::sqrt(0.52f), "The weights are at the wrong corners."},
               {Vec3{0.6f, 0.4f, 0} / std::sqrt(0.52f), "The weights are at the wrong corners."},
               {Vec3{0.4f, 0, 0.6f} / std::sqrt(0.52f), "The weights are at the wrong corners."}});
    for (int i = 0; i < 50; ++i) {
        Rng& rng = item.random();
        const Columns normals{Vec3(rng.unit_vector()), Vec3(rng.unit_vector()), Vec3(rng.unit_vector())};
        const double a = rng.uniform(), b = (1 - a) * rng.uniform();
        const Vec3 w(Vec3d(a, b, 1 - a - b));
        const Vec3d mean = apply(normals, Vec3d(w));
        if (length(mean) < 0.1) continue;
        item.near("the normal at random weights", STUDENT(interpolated_normal)(normals, w), Vec3(normalize(mean)),
                  1e-4);
    }
}

LAB_ITEM(25, "the light of Lambert, Blinn and Phong") {
    // By hand: to_light is (0, 0.6, 0.8), to_eye (0, 0, 1), and the squared cosine of n and the half vector 0.9.
    const Rgb color(0.5f, 0.25f, 0.1f), base = color * 0.8f;
    const auto plus = [&](float highlight) { return base + Rgb(highlight); };
    for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{1, -2, 3}}) {
        const Vec3 light = p + Vec3{0, 3, 4}, eye = p + Vec3{0, 0, 2};
        const auto found = [&](float specular, float shininess) {
            return STUDENT(blinn_phong)(p, Vec3{0, 0, 1}, light, eye, color, specular, shininess);
        };
        const std::string at =
            "the light at p = " + describe(p) + ", n = (0, 0, 1), light = p + (0, 3, 4), eye = p + (0, 0, 2)";
        const Vec3 wrong_light = normalize(light), wrong_eye = normalize(eye);
        item.near(
            at + " without a highlight", found(0, 2), base, 1e-5,
            {{color, "The cosine of Lambert's law is missing."},
             {Rgb(0), "Nothing arrives: the direction to the light source is light - p, not p - light."},
             {color * 4.0f, "The direction to the light source has the length 5: normalize it."},
             {color * wrong_light.z, "The light is a position: the direction to it is light - p."},
             {color * std::max(-wrong_light.z, 0.0f), "The light is a position: the direction to it is light - p."},
             {color * (0.8f / 25), "The distance plays no part in this lab: leave out the division by its square."}});
        item.near(
            at + ", specular 0.5, shininess 2", found(0.5f, 2), plus(0.45f), 1e-5,
            {{plus(0.32f), "This is Phong's own highlight, by the mirror direction. Use the half vector of Blinn."},
             {plus(1.62f), "The half vector is not normalized: l + e is longer than 1."},
             {plus(0.405f), "The half vector is not normalized: the mean of l and e is shorter than 1."},
             {base, "The highlight is missing. Is the half vector l + e, a sum of two vectors that point away?"},
             {plus(0.36f), "The highlight is multiplied by the cosine of Lambert's law: not in this lab."},
             {base + base * 0.45f, "The highlight has the color of the surface: here it is white."},
             {base + color * 0.45f, "The highlight has the color of the surface: here it is white."},
             {plus(0.5f * 0.9486833f), "The power is missing: raise the cosine to the shininess."},
             {plus(0.9f), "The highlight is not multiplied by specular."},
             {plus(0.225f), "The whole highlight is squared: only the cosine is raised to the power."},
             {color * 0.8f + Rgb(0.5f * sqr(dot(Vec3{0, 0, 1}, normalize(Vec3{0, 0.6f, 0.8f} + wrong_eye)))),
              "The eye is a position: the direction to it is eye - p."},
             {plus(0.05f), "The half vector is l + e: both vectors point away from the surface."}});
    }
    const Rgb behind =
        STUDENT(blinn_phong)(Vec3{0, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 3, -1}, Vec3{0, 0, 2}, color, 0.5f, 2.0f);
    const Rgb negative = color * (-1 / std::sqrt(10.0f));
    const Vec3 half = normalize(normalize(Vec3{0, 3, -1}) + Vec3{0, 0, 1});
    item.near(
        "the light with a light source behind the surface", behind, Rgb(0), 1e-6,
        {{Rgb(0.5f * sqr(half.z)), "There is a highlight on the side that no light reaches: where the cosine of "
                                   "Lambert's law is not positive, return black."},
         {negative + Rgb(0.5f * sqr(half.z)), "The light is negative: where the cosine is not positive, return black."},
         {negative, "The light is negative: where the cosine is not positive, return black."}});
    for (int i = 0; i < 100; ++i) {
        Rng& rng = item.random();
        const Vec3 p = point(rng, 2), n(rng.unit_vector()), light = p + Vec3(rng.unit_vector() * rng.uniform(0.5, 9)),
                   eye = p + Vec3(rng.unit_vector() * rng.uniform(0.5, 9));
        const float specular = static_cast<float>(rng.uniform()), shininess = static_cast<float>(rng.uniform(1, 90));
        if (std::abs(dot(n, normalize(light - p))) < 1e-3f || dot(normalize(light - p), normalize(eye - p)) < -0.99f ||
            dot(n, normalize(light - p) + normalize(eye - p)) <= 0)
            continue; // rounding decides, or the eye is behind the surface
        item.near("the light in a random place", STUDENT(blinn_phong)(p, n, light, eye, color, specular, shininess),
                  expected_light(p, n, light, eye, color, specular, shininess), 2e-4);
    }
}
