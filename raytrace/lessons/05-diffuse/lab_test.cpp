// The examiner of lab 05. Expected values are computed by hand, by integrals that have a closed form, or in double
// precision; what depends on chance is judged by means of thousands of paths.
#include "common/image/srgb.h"
#include "raytrace/lessons/05-diffuse/lab.h"
#include "tests/grading/judge.h"

#include <cmath>

using namespace duet;
using namespace duet::grading;
using lab::Sphere;

LAB_TITLE("raytrace-05", "Matte surfaces")

namespace {

/// The mean of many paths along one ray.
Rgb mean_color(const std::vector<Sphere>& spheres, const std::vector<Rgb>& albedos, const Ray& ray, int bounces,
               int paths) {
    Rgbd sum;
    for (int i = 0; i < paths; ++i) sum += Rgbd(STUDENT(path_color)(spheres, albedos, ray, bounces, i + 1));
    return Rgb(sum / static_cast<double>(paths));
}

/// The sky at this height of a unit direction.
Rgb sky(float y) { return lesson::sky_color({std::sqrt(1 - y * y), y, 0}); }

const Ray kDown{{0, 2, 0}, {0, -1, 0}};
const Ray kAhead{{0, 0, 0}, {0, 0, -1}};

} // namespace

LAB_ITEM(0, "the picture") {
    const std::vector<Sphere> spheres{{{-0.55f, 0, -2}, 0.5f}, {{0.5f, -0.1f, -1.8f}, 0.4f}, {{0, -100.5f, -2}, 100}};
    const std::vector<Rgb> albedos{{0.75f, 0.16f, 0.1f}, {0.1f, 0.3f, 0.7f}, {0.6f, 0.6f, 0.55f}};
    ImageRgb image(72, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 72; ++x) {
            const Ray ray{{0, 0, 0}, Vec3(Vec3d((x - 35.5) / 40, (21.5 - y) / 40, -1))};
            Rgb sum;
            for (int i = 0; i < 6; ++i) sum += STUDENT(path_color)(spheres, albedos, ray, 20, 1 + i + 6 * (x + 72 * y));
            image(x, y) = sum / 6.0f;
        }
    item.show("your spheres", image);
}

LAB_ITEM(15, "light is stored by the curve of sRGB") {
    const auto check = [&](float linear) {
        const double x = static_cast<double>(linear), expected = srgb_encode(x);
        const auto number = [](double value) { return static_cast<float>(value); };
        item.near(message("the value for the light ", linear), STUDENT(srgb_from_linear)(linear), number(expected),
                  2e-5,
                  {{linear, "The light was stored as it is: the picture will be too dark. Gamma encoding is missing."},
                   {number(std::sqrt(x)), "This is the square root, gamma 2: near, but not the curve of sRGB."},
                   {number(std::pow(x, 1 / 2.2)), "This is gamma 2.2: near, but not the curve of sRGB."},
                   {number(std::pow(x, 2.2)), "This is the inverse: it decodes. The exponent is 1/2.4, not 2.4."},
                   {number(srgb_decode(x)), "This is the inverse: it decodes. The exponent is 1/2.4, not 2.4."},
                   {number(1.055 * std::pow(x, 2.4) - 0.055), "The exponent is 1/2.4, not 2.4."},
                   {number(12.92 * x), "The straight part ends at 0.0031308: above it the power begins."},
                   {number(1.055 * std::pow(x, 1 / 2.4) - 0.055),
                    "Below 0.0031308 the curve is a straight line, 12.92 times the light."}});
    };
    for (const float linear : {0.5f, 0.0f, 1.0f, 0.18f, 0.002f, 0.0031f, 0.0033f}) check(linear);
    for (int i = 0; i < 100; ++i) check(static_cast<float>(item.random().uniform()));
}

LAB_ITEM(15, "random unit vectors, all equally likely") {
    using Point = std::optional<Vec3>;
    item.near("the unit vector of (0.3, -0.4, 0)", STUDENT(unit_vector)(Vec3{0.3f, -0.4f, 0}),
              Point(Vec3{0.6f, -0.8f, 0}), 1e-5,
              {{Point(Vec3{0.3f, -0.4f, 0}), "Its length is 0.5: divide by the length."},
               {Point(Vec3{1.2f, -1.6f, 0}), "Its length is 2: divide by the length, not by its square."},
               {Point(), "This point lies inside the unit sphere and stays."}});
    item.near(
        "the unit vector of (0.7, 0.7, 0.7), outside the unit sphere", STUDENT(unit_vector)(Vec3(0.7f, 0.7f, 0.7f)),
        Point(), 1e-4,
        {{Point(normalize(Vec3(1, 1, 1))),
          "Points outside the unit sphere must be thrown away. Otherwise directions to the corners of the cube are "
          "more likely than others."}});
    item.near("the unit vector of (0, 0, 0)", STUDENT(unit_vector)(Vec3{0, 0, 0}), Point(), 0,
              {{Point(Vec3(NAN, NAN, NAN)), "0/0 is not a number: throw away points without a direction."}});
    for (int i = 0; i < 300; ++i) {
        const Vec3 p(Vec3d(item.random().uniform(-1, 1), item.random().uniform(-1, 1), item.random().uniform(-1, 1)));
        if (std::abs(length(p) - 1) < 1e-3f || length(p) < 1e-3f) continue;
        item.near("the unit vector of " + describe(p), STUDENT(unit_vector)(p),
                  length(p) < 1 ? Point(normalize(p)) : Point(), 1e-4);
    }
}

LAB_ITEM(15, "directions off a matte surface follow Lambert's law") {
    const Vec3 n{0, 0, 1};
    const auto direction = [](Vec3 normal, Vec3 u) { return normalize(STUDENT(diffuse_direction)(normal, u)); };
    item.near(
        "the direction for n = (0, 0, 1) and u = (1, 0, 0), made 1 long", direction(n, {1, 0, 0}),
        normalize(Vec3{1, 0, 1}), 1e-5,
        {{Vec3{1, 0, 0}, "This is u itself: add the normal, or half of all directions point into the surface, and "
                         "the others are all alike."},
         {normalize(Vec3{1, 0, -1}), "It points into the surface: add the normal, don't subtract it."},
         {normalize(Vec3{-1, 0, 1}), "Add u to the normal, don't subtract it."},
         {n, "u plays no part."}});
    item.near(
        "the direction for u = -n", direction(n, {0, 0, -1}), n, 1e-3,
        {{Vec3(NAN, NAN, NAN), "n + u is (0, 0, 0) here, and has no direction. Return n where it is (almost) 0."}});
    double cosine = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 normal(item.random().unit_vector()), d = direction(normal, Vec3(item.random().unit_vector()));
        item.require(dot(d, normal) > -1e-4f, "A direction points to the other side of the surface.");
        cosine += static_cast<double>(dot(d, normal)) / 3000;
    }
    item.near("the mean cosine of the angle from the normal", cosine, 2.0 / 3, 0.03,
              {{0.5, "Directions are all alike. By Lambert's law those near the normal are more likely: n + u."},
               {0.75, "Directions are too near the normal: cos² is the law here. Is u a unit vector, used as it is?"}});
}

LAB_ITEM(20, "a ray starts beyond the error of its point, at any scale") {
    const Vec3 z{0, 0, 1}, error{1e-3f, 1e-3f, 1e-3f};
    const float up = STUDENT(offset_origin)(Vec3{5, 5, 5}, error, z, Vec3{0.1f, 0, 2}).z - 5;
    const float down = STUDENT(offset_origin)(Vec3{5, 5, 5}, error, z, Vec3{0.1f, 0, -2}).z - 5;
    item.require(up != 0, "The origin was not moved: a ray that starts there meets its own surface again.");
    item.require(up > 0, "The ray goes up, along the normal, and its origin was moved down, into the surface.");
    item.require(down < 0,
                 "The ray goes down, to the other side of the surface (as in glass), but its origin was moved "
                 "up: then it meets its own surface. Move it to the side that the direction points to.");
    item.require(up > 0.9e-3f,
                 message("The point may be wrong by 0.001 along the normal, and the origin was moved by only ", up,
                         ": the ray may still start inside."));
    for (const double scale : {1.0, 1e-3, 1e3, 1e5})
        for (int i = 0; i < 60; ++i) {
            const Vec3d n = item.random().unit_vector();
            const Vec3d p = item.random().unit_vector() * scale;
            const Vec3d e =
                Vec3d(item.random().uniform(1, 3), item.random().uniform(1, 3), item.random().uniform(1, 3)) *
                (1e-5 * scale);
            const double reach = std::abs(n.x) * e.x + std::abs(n.y) * e.y + std::abs(n.z) * e.z;
            const Vec3d d = item.random().unit_vector();
            const double side = dot(d, n) > 0 ? 1 : -1;
            const Vec3 start(STUDENT(offset_origin)(Vec3(p), Vec3(e), Vec3(n), Vec3(d)));
            const double moved = side * dot(Vec3d(start) - p, n);
            const double rounding = 4e-7 * scale;
            item.require(moved > reach - rounding,
                         message("At a point ", scale, " m from zero with the error ", describe(Vec3(e)),
                                 " along the axes, the true surface may be ", reach,
                                 " m away along the normal. The origin was moved by ", moved,
                                 " m: too little. |n.x|·e.x + |n.y|·e.y + |n.z|·e.z is the distance that it takes."));
            item.require(
                moved < 2 * reach + rounding,
                message("At a point ", scale, " m from zero the surface may be ", reach,
                        " m away along the normal. The origin was moved by ", moved,
                        " m: too much, so that light leaks through what is near. A fixed epsilon is right at one "
                        "scale only: use p_error."));
            const Vec3d aside = Vec3d(start) - p - n * (side * moved);
            item.require(length(aside) < rounding * 2,
                         "The origin must be moved along the normal, not along the direction.");
        }
}

LAB_ITEM(20, "one bounce: the mean of the sky, times the albedo") {
    const Rgb albedo{0.8f, 0.5f, 0.2f};
    const std::vector<Sphere> one{{{0, 0, 0}, 1}};
    item.near(
        "the color of a ray that misses", STUDENT(path_color)(one, {albedo}, Ray{{0, 2, 0}, {0, 3, 0}}, 10, 1), sky(1),
        1e-5,
        {{sky(1) * albedo, "The ray met no surface, and its light was multiplied by an albedo."},
         {Rgb(1), "This is the weight of the path alone: multiply it by lesson::sky_color of the ray's direction."}});
    // At the top of the sphere the sky's height in directions by Lambert's law is 2/3 on average; evenly drawn, 1/2.
    const Rgb found = mean_color(one, {albedo}, kDown, 10, 4000);
    item.near("the mean color at the top of a sphere", found, sky(2 / 3.0f) * albedo, 0.006,
              {{sky(1) * albedo, "All light seems to come from straight above: does the direction depend on chance?"},
               {sky(2 / 3.0f), "The albedo is missing."},
               {sky(2 / 3.0f) * albedo * 0.5f, "Half of it is lost. Do half of the paths go into the surface?"},
               {sky(2 / 3.0f) * albedo * albedo, "The albedo is counted twice."},
               {sky(1 / 2.0f) * albedo, "Directions are all alike, not by Lambert's law."},
               {sky(-1) * albedo, "The sky was asked for the first ray's direction, not for the last one's."},
               {albedo, "This is the albedo alone: multiply it by the light of the sky."}});
    // The first sphere of the list is too far away to be met.
    const Rgb second = mean_color({{{0, 0, 1000}, 1}, one[0]}, {{0.1f, 0.9f, 0.1f}, albedo}, kDown, 10, 4000);
    item.near(
        "the mean color at the top of the second sphere of a list", second, sky(2 / 3.0f) * albedo, 0.006,
        {{sky(2 / 3.0f) * Rgb(0.1f, 0.9f, 0.1f), "This is the color of the first sphere: take albedos[hit->index]."}});
    const Rgb a = STUDENT(path_color)(one, {albedo}, kDown, 10, 1),
              b = STUDENT(path_color)(one, {albedo}, kDown, 10, 2);
    item.require(a != b,
                 "Two seeds give the same path: make the random numbers from the seed, with lesson::Random(seed).");
    // On a sphere this large a hit is off by some 0.00001, and half of the hits lie inside.
    Rgb ground;
    for (int i = 0; i < 3000; ++i) {
        const Vec3d down(item.random().uniform(-1, 1), -1, item.random().uniform(-1, 1));
        ground += STUDENT(path_color)({{{0, -100, 0}, 100}}, {Rgb(0.5f)}, {{0, 2, 0}, Vec3(down)}, 50, i + 1) / 3000.0f;
    }
    const Rgb expected = sky(2 / 3.0f) * 0.5f;
    item.require(ground.b > 0.95f * expected.b,
                 message("The ground, a sphere of radius 100, is too dark: ", ground.b, " in blue, expected ",
                         expected.b,
                         ". Rays meet the very surface that they leave (self-intersection): give them t_min = 0.001."));
    item.near("the mean color of the ground, a sphere of radius 100", ground, expected, 0.008);
}

LAB_ITEM(15, "many bounces") {
    const std::vector<Sphere> room{{{0, 0, 0}, 10}};
    item.require(
        is_black(STUDENT(path_color)(room, {Rgb(0.9f)}, kAhead, 30, 1)),
        "No path leaves a closed sphere, so the color inside it is black after `bounces` surfaces; yours isn't. "
        "Does each new ray start at the hit, with t_min = 0.001, and on the side of hit.n?");
    const std::vector<Sphere> one{{{0, 0, 0}, 1}};
    item.near("a sphere with bounces = 0", STUDENT(path_color)(one, {Rgb(0.5f)}, kDown, 0, 1), Rgb(0), 0);
    item.near("the sky with bounces = 0", STUDENT(path_color)(one, {Rgb(0.5f)}, Ray{{0, 2, 0}, {0, 1, 0}}, 0, 1),
              sky(1), 1e-5,
              {{Rgb(0), "The path met no surface at all, so it isn't given up: count surfaces, not rays."}});
    const Rgb single = STUDENT(path_color)(one, {Rgb(0.5f)}, kDown, 1, 1);
    item.require(!is_black(single),
                 "With bounces = 1 a path that meets one sphere and then the sky is black: it met only "
                 "one surface. The limit is off by one.");
    // A white ball above a red floor. Of the paths that leave the floor, sin²θ = (1 / 1.25)² meet the ball.
    const std::vector<Sphere> two{{{0, -1000, 0}, 1000}, {{0, 1.25f, 0}, 1}};
    const std::vector<Rgb> albedos{{0.9f, 0.1f, 0.1f}, {0.9f, 0.9f, 0.9f}};
    const Rgb below = mean_color(two, albedos, {{0, 0.1f, 0}, {0, -1, 0}}, 1, 4000);
    // It leaves cos²θ of the light from θ on, at the edge of the ball, and the mean of its heights is (2/3) cos θ.
    const double cos_edge = std::sqrt(1 - 0.64), open = cos_edge * cos_edge, height = 2.0 / 3 * cos_edge;
    const Rgb open_sky = sky(static_cast<float>(height)) * static_cast<float>(open);
    item.near(
        "the floor under a ball, one bounce", below, open_sky * albedos[0], 0.015,
        {{sky(2 / 3.0f) * albedos[0], "The ball casts no shadow: the path that goes on must be tested against all "
                                      "spheres."}});
    // The mean of 400,000 paths, which is off by 0.0006 in red; 4000 of them are off by 0.006. The mistake's as well.
    item.near("the floor under a ball, three bounces", mean_color(two, albedos, {{0, 0.1f, 0}, {0, -1, 0}}, 3, 4000),
              Rgb(0.3547f, 0.0314f, 0.0397f), 0.04,
              {{Rgb(0.4654f, 0.0327f, 0.0418f), "It looks as if each bounce drew the same random numbers. Make the "
                                                "generator once, before the loop. A function "
                                                "that draws from it takes it by reference: a copy begins again."}});
    const Rgb more = mean_color(two, albedos, {{0, 0.1f, 0}, {0, -1, 0}}, 40, 4000);
    item.require(more.r > below.r + 0.03f,
                 message("With 40 bounces the floor should be brighter than with one: light comes by "
                         "way of the ball, too. Found ",
                         more.r, " and ", below.r, " in red."));
    item.require(more.r / more.b > 9, "Light that goes from the floor to the ball and back is red twice: multiply the "
                                      "albedos of all surfaces of the path.");
}
