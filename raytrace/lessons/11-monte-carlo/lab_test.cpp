// The examiner of lab 11. Expected values are computed by hand, in double precision, or by integrals in closed form.
// Random numbers stand on a grid, so that means are exact to a thousandth: nothing is left to chance.
#include "raytrace/lessons/11-monte-carlo/lab.h"
#include "tests/grading/judge.h"

#include <cmath>

using namespace duet;
using namespace duet::grading;
using lab::Light;
using lab::Sphere;

LAB_TITLE("raytrace-11", "Monte Carlo: densities and light sampling")

namespace {

float as_float(double value) { return static_cast<float>(value); }

/// The middle of cell (i, j) of a grid of n × n random numbers.
Vec2 grid(int i, int j, int n) { return Vec2(Vec2d((i + 0.5) / n, (j + 0.5) / n)); }

/// A level light of side 2·half at the height h above the origin, that shines down.
Light level_light(float half, float h, Rgb emission = Rgb(1)) {
    return {{-half, h, -half}, {2 * half, 0, 0}, {0, 0, 2 * half}, emission};
}

/// The density per steradian: squared distance / (area · cosine at the light).
double solid_angle_density(const Light& light, Vec3 p, Vec3 q) {
    const Vec3d area = cross(Vec3d(light.u), Vec3d(light.v)), w = Vec3d(p) - Vec3d(q);
    return dot(w, w) * length(w) / std::max(dot(area, w), 1e-30);
}

} // namespace

LAB_ITEM(0, "the picture") {
    const Light light{{-0.7f, 2, -1.2f}, {1.4f, 0, 0}, {0, 0, 1.4f}, Rgb(9, 8, 6.5f)};
    const std::vector<Sphere> spheres{{{-0.5f, 0.5f, -0.4f}, 0.5f}, {{0.75f, 0.3f, 0.2f}, 0.3f}};
    const Rgb albedos[] = {{0.75f, 0.2f, 0.12f}, {0.15f, 0.35f, 0.7f}};
    ImageRgb image(60, 44);
    for (int y = 0; y < 44; ++y)
        for (int x = 0; x < 60; ++x) {
            const Ray ray{{0, 1.3f, 4}, Vec3(Vec3d((x - 29.5) / 70, (21.5 - y) / 70 - 0.22, -1))};
            auto hit = lesson::closest_hit(spheres, ray);
            const Rgb albedo = hit ? albedos[hit->index] : Rgb(0.7f);
            if (!hit && ray.direction.y < 0) hit = lesson::Hit{0, ray.at(-1.3f / ray.direction.y), {0, 1, 0}, true, 0};
            if (!hit) continue;
            for (int i = 0; i < 4; ++i) {
                const Vec2 random(Vec2d(item.random().uniform(), item.random().uniform()));
                image(x, y) += STUDENT(direct_light)(light, spheres, hit->p, hit->n, albedo, random) / 4.0f;
            }
        }
    item.show("your light", image);
}

LAB_ITEM(15, "a number with a given density") {
    const auto means = [&](float k) {
        Vec2d sum;
        for (int i = 0; i < 1000; ++i) {
            const double x = static_cast<double>(STUDENT(draw_power)(k, as_float((i + 0.5) / 1000)));
            item.require(x >= 0 && x <= 1, message("Numbers must be from 0 to 1; found ", x, "."));
            sum = sum + Vec2d(x, x * x) * 1e-3;
        }
        return sum;
    };
    item.near(
        "the mean of numbers with the density 3·x² (k = 2)", means(2).x, 0.75, 2e-3,
        {{0.5, "All numbers are equally likely: u itself has the density 1."},
         {2.0 / 3, "These have the density 2·x. The integral of (k + 1)·xᵏ is x to the power of k + 1."},
         {1.0 / 3, "u is taken to a power above 1, which makes small numbers likely. Solve u = x³ for x: a root."},
         {0.25, "u is taken to the power of 3, and not its third root: solve u = x³ for x."}});
    for (const double k : {0.0, 1.0, 0.5, 4.0, 30.0}) {
        const Vec2d found = means(as_float(k));
        item.near(message("the mean of numbers with k = ", k), found.x, (k + 1) / (k + 2), 3e-3);
        item.near(message("the mean square of numbers with k = ", k), found.y, (k + 1) / (k + 3), 3e-3);
    }
}

LAB_ITEM(10, "points of a light") {
    const Light light{{1, 2, 3}, {2, 0, 0}, {1, 0, 4}, Rgb(1)};
    item.near("the point for (0.25, 0.75)", STUDENT(sample_quad)(light, Vec2{0.25f, 0.75f}), Vec3{2.25f, 2, 6}, 1e-5,
              {{Vec3{1.25f, 0, 3}, "The corner is missing."},
               {Vec3{1.75f, 2, 4}, "The same random number is taken twice: all points lie on a diagonal."},
               {Vec3{3.25f, 2, 6}, "The same random number is taken twice: all points lie on a diagonal."},
               {Vec3{0.5f, 2, 5}, "The corner is a corner, not the middle: a and b are from 0 to 1, not from -1 to 1."},
               {Vec3{2.75f, 2, 4}, "The first random number belongs to u, the second to v."}});
    for (int i = 0; i < 50; ++i) {
        const double a = item.random().uniform(), b = item.random().uniform();
        const Vec3d u = item.random().unit_vector(), v = item.random().unit_vector(), c = item.random().unit_vector();
        item.near("a point", STUDENT(sample_quad)(Light{Vec3(c), Vec3(u), Vec3(v), Rgb(1)}, Vec2(Vec2d(a, b))),
                  Vec3(c + u * a + v * b), 1e-5);
    }
}

LAB_ITEM(20, "the density of a light, per steradian") {
    const Light light = level_light(1, 2); // area 4
    const Vec3 p{0, 0, 0}, q{1, 2, 0};     // squared distance 5, cosine 2/√5
    const double right = 5 / (4 * 2 / std::sqrt(5.0));
    item.near(
        "the density of the direction to (1, 2, 0) of a light of area 4 at the height 2",
        STUDENT(light_density)(light, p, q), as_float(right), 1e-4,
        {{0.25f, "This is 1 / A, the density by area, in the wrong measure: per steradian it is r² / (A·cosine)."},
         {as_float(1.25), "The cosine at the light is missing: a piece that is seen at a slant looks smaller."},
         {as_float(1.25 * 2 / std::sqrt(5.0)), "The cosine at the light belongs in the denominator."},
         {as_float(1 / (4 * 2 / std::sqrt(5.0))), "The square of the distance is missing."},
         {as_float(right / std::sqrt(5.0)), "The distance must be squared."},
         {as_float(right * 4), "The area is missing."},
         {as_float(1 / right), "This is the inverse: the solid angle of the light, not the density."},
         {0.0f, "The light shines down, to the side of u × v, and p is below it: it is not behind."}});
    item.near(
        "the density from behind the light", STUDENT(light_density)(light, Vec3{0, 3, 0}, q), 0.0f, 0,
        {{as_float(2 * std::sqrt(2.0) / 4), "The light shines on the side of u × v alone: behind it the density is 0."},
         {as_float(-2 * std::sqrt(2.0) / 4), "The cosine is negative behind the light: the density is 0 there."}});
    item.near("the density from a point in the light's plane", STUDENT(light_density)(light, Vec3{4, 2, 0}, q), 0.0f, 0,
              {{INFINITY, "The cosine is 0 in the light's plane: test it before you divide."},
               {-INFINITY, "The cosine is 0 in the light's plane: test it before you divide."}});
    const Light slanted{{0, 2, 0}, {2, 0, 0}, {2, 0, 1}, Rgb(1)}; // area 2, though the edges are 2 and √5 long
    item.near("the density of a light whose edges are not at right angles", STUDENT(light_density)(slanted, p, q),
              as_float(right * 2), 1e-4,
              {{as_float(right * 2 / std::sqrt(5.0)),
                "|u|·|v| is the area of a rectangle; of a parallelogram it is |u × v|."}});
    for (int i = 0; i < 200; ++i) {
        const Vec3d u = item.random().unit_vector() * 2.0, v = item.random().unit_vector() * 2.0;
        const Light other{Vec3(item.random().unit_vector()), Vec3(u), Vec3(v), Rgb(1)};
        const Vec3 point =
            other.corner + other.u * as_float(item.random().uniform()) + other.v * as_float(item.random().uniform());
        const Vec3 from(item.random().unit_vector() * 3.0);
        const double facing = dot(normalize(cross(u, v)), normalize(Vec3d(from) - Vec3d(point)));
        if (std::abs(facing) < 0.05 || length(cross(u, v)) < 0.2 || length(from - point) < 0.2f) continue;
        const double density = facing > 0 ? solid_angle_density(other, from, point) : 0;
        item.near("the density of a random light", STUDENT(light_density)(other, from, point), as_float(density),
                  1e-3 * density);
    }
}

LAB_ITEM(10, "the density of Lambert's law") {
    const Vec3 n{0, 0, 1}, w{0.6f, 0, 0.8f};
    item.near("the density at the cosine 0.8", STUDENT(cosine_density)(n, w), 0.8f / kPi, 1e-5,
              {{0.8f, "It must be divided by π, so that the integral over the hemisphere is 1."},
               {1 / kPi, "The cosine is missing."},
               {0.8f / (2 * kPi), "The integral of the cosine over the hemisphere is π, not 2π."},
               {1 / (2 * kPi), "This is the density of directions that are all alike: those near n are likelier."}});
    item.near("the density at the cosine -0.8", STUDENT(cosine_density)(n, -w), 0.0f, 0,
              {{-0.8f / kPi, "No density is negative: directions into the surface are never drawn."},
               {0.8f / kPi, "Directions into the surface are never drawn: the density is 0 there."}});
    double sum = 0; // over a grid of equal solid angles
    for (int i = 0; i < 64; ++i)
        for (int j = 0; j < 16; ++j) {
            const double z = (i + 0.5) / 64, angle = 2 * kPiDouble * (j + 0.5) / 16, r = std::sqrt(1 - z * z);
            const Vec3 direction(Vec3d(r * std::cos(angle), z, r * std::sin(angle)));
            sum += static_cast<double>(STUDENT(cosine_density)(Vec3{0, 1, 0}, direction)) * 2 * kPiDouble / 1024;
        }
    item.near("the integral of the density over the hemisphere", sum, 1, 1e-3);
}

LAB_ITEM(15, "directions by Lambert's law") {
    constexpr int kGrid = 40;
    for (const Vec3 n : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0.48f, -0.6f, 0.64f},
                         Vec3(item.random().unit_vector())}) {
        const std::string around = " around the normal " + describe(n);
        Vec3d sum;
        double square = 0;
        for (int i = 0; i < kGrid; ++i)
            for (int j = 0; j < kGrid; ++j) {
                const Vec3d w(STUDENT(cosine_direction)(n, grid(i, j, kGrid)));
                item.require(is_finite(w), "A direction is not a number" + around +
                                               ". Is the vector that the frame is made from parallel to n?");
                item.require(std::abs(length(w) - 1) < 1e-3,
                             message("A direction has the length ", length(w), around, "; expected 1."));
                const double cosine = dot(w, Vec3d(n));
                item.require(cosine > -1e-4, "A direction points into the surface" + around + ".");
                sum = sum + w / static_cast<double>(sqr(kGrid)), square += cosine * cosine / sqr(kGrid);
            }
        const double along = dot(sum, Vec3d(n));
        item.near(
            "the mean cosine of directions" + around, along, 2.0 / 3, 5e-3,
            {{0.5, "All directions are equally likely: the cosine itself was drawn evenly. By Lambert's law it has "
                   "the density 2·x: take the square root."},
             {0.75, "They are too near the normal: the cosine has the density 2·x, so it is a square root, not a "
                    "third root."},
             {kPiDouble / 4, "Cosine and sine are mixed up: the sine is then √u, and the cosine √(1 - u)."},
             {1.0 / 3, "They are too far from the normal: take the square root of u, not its square."}});
        item.require(length(sum - Vec3d(n) * along) < 0.02,
                     "Directions lie more to one side than to the other" + around +
                         ": the angle around n must go from 0 to 2π, and the frame's axes be perpendicular to n.");
        item.near("the mean squared cosine of directions" + around, square, 0.5, 5e-3);
    }
}

LAB_ITEM(10, "weights of two ways") {
    const auto weight = [](float own, float other) { return STUDENT(mis_weight)(own, other); };
    item.near("the weight for the densities 2 and 1", weight(2, 1), 0.8f, 1e-5,
              {{2 / 3.0f, "This is the balance heuristic: the power heuristic squares both densities."},
               {0.2f, "The densities are mixed up: the way with the larger density has the larger weight."},
               {1 / 3.0f, "The densities are mixed up, and must be squared."},
               {0.5f, "Equal weights are right on average, but keep the noise of the worse way."}});
    item.near("the weight where the other way never draws it", weight(3, 0), 1.0f, 1e-6);
    item.near("the weight for 3e30 and 3e30", weight(3e30f, 3e30f), 0.5f, 1e-5,
              {{NAN, "The squares overflow: divide the densities first, then square."}});
    item.near("the weight for 1e-25 and 1e-25", weight(1e-25f, 1e-25f), 0.5f, 1e-5,
              {{NAN, "The squares become 0: divide the densities first, then square."}});
    for (int i = 0; i < 100; ++i) {
        const float a = as_float(std::pow(10, item.random().uniform(-3, 3))),
                    b = as_float(std::pow(10, item.random().uniform(-3, 3)));
        item.near("the sum of both weights of one direction", weight(a, b) + weight(b, a), 1.0f, 1e-5);
    }
}

LAB_ITEM(20, "direct light") {
    const Rgb albedo(0.8f, 0.4f, 0.2f), emission(2, 3, 4), both = albedo * emission;
    const Light light = level_light(1, 2, emission);
    const Vec3 p{0, 0, 0}, n{0.6f, 0.8f, 0};
    const Vec2 random{0.75f, 0.5f}; // the point (0.5, 2, 0)
    const double r2 = 4.25, r = std::sqrt(r2), there = 2 / r, here = (0.6 * 0.5 + 0.8 * 2) / r;
    const auto times = [&](double factor) { return both * as_float(factor); };
    const double right = here * there * 4 / r2 / kPiDouble;
    const auto lit = [&](const std::vector<Sphere>& spheres) {
        return STUDENT(direct_light)(light, spheres, p, n, albedo, random);
    };
    item.near(
        "one estimate at the origin, where the light's point is (0.5, 2, 0)", lit({}), times(right), 1e-4,
        {{Rgb(0), "It is black. Is the light found to be behind its own plane or below the surface?"},
         {times(right * kPiDouble), "The reflection of a matte surface is albedo / π: the division by π is missing."},
         {times(right / here), "The cosine at the surface is forgotten."},
         {times(right / there), "The cosine at the light is forgotten."},
         {times(right * r2), "The squared distance is missing."},
         {times(right * r2 / there),
          "The density is that by area, 1 / A: the measure must fit the cosine; per steradian it is r² / (A·cosine)."},
         {times(right / 4), "The area of the light is missing."},
         {emission * as_float(right), "The albedo is missing."},
         {albedo * as_float(right), "The emission is missing."},
         {times(here / kPiDouble), "The density of the point is missing: divide by light_density."}});
    item.near("with a sphere in between", lit({{{0.25f, 1, 0}, 0.2f}}), Rgb(0), 1e-4,
              {{times(right), "A sphere is in between, and there is no shadow."}});
    item.near("with a sphere beyond the light", lit({{{1, 4, 0}, 0.5f}}), times(right), 1e-4,
              {{Rgb(0), "A sphere beyond the light throws a shadow: end the ray at the light, with t_max."}});
    item.near("with a sphere beside the way", lit({{{-1, 1, 0}, 0.5f}}), times(right), 1e-4,
              {{Rgb(0), "A sphere that is not in between throws a shadow."}});
    item.near("on a sphere that the point lies on", lit({{{-0.6f, -0.8f, 0}, 1}}), times(right), 1e-4,
              {{Rgb(0), "The surface throws a shadow on itself: start the ray with t_min = 0.001."}});
    item.near("on a surface that looks away", STUDENT(direct_light)(light, {}, p, -n, albedo, random), Rgb(0), 1e-4,
              {{times(-right), "Light is negative where the surface looks away: test the sign of the cosine."},
               {times(right), "The surface is lit from behind: don't take the absolute value of the cosine."}});
    item.near("behind the light", STUDENT(direct_light)(light, {}, Vec3{0, 4, 0}, Vec3{0, -1, 0}, albedo, random),
              Rgb(0), 0, {{Rgb(NAN), "0/0: where the density is 0, the estimate is black."}});
    // Under the middle of a square light of half side s at height h: Lambert's formula for a rectangle.
    for (const float half : {0.3f, 1.0f, 2.0f}) {
        const double x = static_cast<double>(half) / 2, root = std::sqrt(1 + x * x);
        const double fraction = 4 / kPiDouble * x / root * std::atan(x / root);
        Rgbd sum;
        for (int i = 0; i < 24; ++i)
            for (int j = 0; j < 24; ++j)
                sum += Rgbd(STUDENT(direct_light)(level_light(half, 2, emission), {}, p, Vec3{0, 1, 0}, albedo,
                                                  grid(i, j, 24))) /
                       576.0;
        item.near(message("the mean of 576 estimates under a light of half side ", half), Rgb(sum), times(fraction),
                  4e-3);
    }
}
