// The examiner of lab 02. The expected values are computed by hand, or in double precision by the distance from the
// center to the ray.
#include "common/image/srgb.h"
#include "raytrace/lessons/02-sphere/lab.h"
#include "tests/grading/judge.h"

#include <cmath>
#include <optional>

using namespace duet;
using namespace duet::grading;

LAB_TITLE("raytrace-02", "A ray meets a sphere")

namespace {

using T = std::optional<float>;

/// The nearest t > 0, from the foot of the perpendicular: another way than the lesson's formula.
std::optional<double> nearest(Vec3d center, double radius, Vec3d origin, Vec3d direction) {
    const double speed = length(direction), along = dot(center - origin, direction) / speed;
    const Vec3d foot = origin + direction * (along / speed);
    const double half2 = radius * radius - length_squared(foot - center);
    if (half2 < 0) return std::nullopt;
    for (const double distance : {along - std::sqrt(half2), along + std::sqrt(half2)})
        if (distance > 0) return distance / speed;
    return std::nullopt;
}

/// The same for the cylinder around the y axis, in the plane of x and z.
std::optional<double> nearest_of_cylinder(double radius, Vec3d origin, Vec3d direction) {
    return nearest({0, 0, 0}, radius, {origin.x, 0, origin.z}, {direction.x, 0, direction.z});
}

const Vec3 kCenter{0, 0, -3};

} // namespace

LAB_ITEM(0, "the picture") {
    constexpr int kWidth = 96, kHeight = 72;
    ImageRgb image(kWidth, kHeight, Rgb(0.8f, 0.9f, 1));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const Ray ray{{0, 0, 0}, Vec3(Vec3d((x - kWidth / 2 + 0.5) / 36, (kHeight / 2 - y - 0.5) / 36, -1.5))};
            if (const auto t = STUDENT(hit_sphere)(Vec3{0, 0, -2}, 1.0f, ray))
                image(x, y) = STUDENT(normal_color)(STUDENT(sphere_normal)(Vec3{0, 0, -2}, 1.0f, ray.at(*t)));
        }
    item.show("your sphere", image);
}

LAB_ITEM(20, "a ray through the center meets the front first") {
    // The page's formula has b = -5, c = 21 and the discriminant 4: t = 5 - 2. The formula of school has b = -10.
    const Ray ray{{0, 0, 0}, {0, 0, -1}};
    item.near(
        "t for a ray from (0, 0, 0) along (0, 0, -1) and a sphere with center (0, 0, -5) and radius 2",
        STUDENT(hit_sphere)(Vec3{0, 0, -5}, 2.0f, ray), T(3.0f), 1e-5,
        {{T(7.0f), "This is the back of the sphere: try the smaller root first."},
         {T(-3.0f), "The point lies behind the origin: b = (origin - center)·direction has the wrong sign, or -b "
                    "was written as b."},
         {T(-7.0f), "The point lies behind the origin: b = (origin - center)·direction has the wrong sign, or -b "
                    "was written as b."},
         {T(5 - std::sqrt(2.0f)), "The radius must be squared."},
         {T(1.5f), "This is half of it. With b = q·d one divides by a. Only the formula of school, with twice that "
                   "b, divides by 2a."},
         {T(6.0f), "This is twice as much. With twice the page's b, as in the formula of school, one divides by 2a."},
         {T(5 - std::sqrt(79.0f) / 2),
          "Two formulas are mixed: with b = 2·(q·d) the discriminant is b² - 4ac, with b = q·d it is b² - ac."},
         {T(10 - std::sqrt(79.0f)),
          "Two formulas are mixed: with b = 2·(q·d) the discriminant is b² - 4ac, with b = q·d it is b² - ac."},
         {T(), "The ray passes through the center, so it hits; your function returned nothing. Is "
               "q = origin - center, in this order? With b = q·d, is the discriminant b² - ac, without a 4?"}});
}

LAB_ITEM(10, "a ray through the center meets two surfaces: from inside it finds the back") {
    item.near(
        "t for a ray from the center of a sphere with radius 1",
        STUDENT(hit_sphere)(kCenter, 1.0f, Ray{kCenter, {0, 0, -1}}), T(1.0f), 1e-5,
        {{T(-1.0f), "The nearer root is negative: this point lies behind the origin. Where the smaller root isn't on "
                    "the ray, try the larger."},
         {T(), "From inside there is one point ahead: where the smaller root isn't on the ray, try the larger."}});
    item.near("the second point of the ray, with t_min = 2.5",
              STUDENT(hit_sphere)(kCenter, 1.0f, Ray{{0, 0, 0}, {0, 0, -1}, 2.5f}), T(4.0f), 1e-5,
              {{T(2.0f), "t = 2 is before t_min = 2.5: only points with t_min < t < t_max count."},
               {T(), "The second point, t = 4, lies beyond t_min = 2.5 and counts."}});
    item.near("a sphere behind the ray", STUDENT(hit_sphere)(kCenter, 1.0f, Ray{{0, 0, 0}, {0, 0, 1}}), T(), 0,
              {{T(-2.0f), "Points with negative t lie behind the origin."},
               {T(-4.0f), "Points with negative t lie behind the origin."},
               {T(2.0f), "The sphere is at -z and the ray runs along +z: is q = origin - center, in this order?"}});
    item.near("the same ray with t_max = 1.5", STUDENT(hit_sphere)(kCenter, 1.0f, Ray{{0, 0, 0}, {0, 0, -1}, 0, 1.5f}),
              T(), 0, {{T(2.0f), "t = 2 is beyond t_max = 1.5: only points with t_min < t < t_max count."}});
}

LAB_ITEM(10, "a ray off the axis") {
    // At the height 0.6 the front of the unit sphere is √(1 - 0.36) = 0.8 before its center.
    item.near("t for a ray from (0, 0.6, 0) along (0, 0, -1) and a sphere with center (0, 0, -3) and radius 1",
              STUDENT(hit_sphere)(kCenter, 1.0f, Ray{{0, 0.6f, 0}, {0, 0, -1}}), T(2.2f), 1e-5,
              {{T(2.0f), "This is the distance on the axis: the height of the ray plays no part. Does c = q·q - r² "
                         "have all of q in it?"},
               {T(3.8f), "This is the back of the sphere: try the smaller root first."}});
    item.near("a sphere of radius 2", STUDENT(hit_sphere)(kCenter, 2.0f, Ray{{0, 0, 0}, {0, 0, -1}}), T(1.0f), 1e-5,
              {{T(2.0f), "The radius plays no part: the third coefficient is q·q - r²."},
               {T(3 - std::sqrt(2.0f)), "The radius must be squared."}});
}

LAB_ITEM(10, "a tangent, and misses on both sides of it") {
    const auto at_height = [](float y) { return STUDENT(hit_sphere)(kCenter, 1.0f, Ray{{0, y, 0}, {0, 0, -1}}); };
    item.near("t for a tangent, from (0, 1, 0) along (0, 0, -1) to a sphere with center (0, 0, -3) and radius 1,",
              at_height(1), T(3.0f), 1e-3,
              {{T(), "A ray that touches the sphere has the discriminant 0, and one point: it is a hit."}});
    item.require(at_height(0.999f).has_value(), "A ray at the height 0.999 meets a sphere with radius 1.");
    item.near("a ray at the height 1.001", at_height(1.001f), T(), 0,
              {{T(3.0f), "The discriminant is negative: there is no point. Don't take the root of its absolute value."},
               {T(NAN), "This is not a number: the root of a negative discriminant. Test its sign first."}});
    item.near("a ray at the height 5", at_height(5), T(), 0,
              {{T(NAN), "This is not a number: the root of a negative discriminant. Test its sign first."}});
}

LAB_ITEM(15, "directions of any length") {
    for (const float scale : {0.25f, 2.0f, 100.0f}) {
        const auto t = STUDENT(hit_sphere)(kCenter, 1.0f, Ray{{0, 0, 0}, Vec3{0, 0, -1} * scale});
        item.near(
            message("t for a direction of length ", scale), t, T(2 / scale), 1e-4 / scale,
            {{T(2.0f),
              "This is the distance in meters: t counts lengths of the direction. Don't normalize the direction."},
             {T(2 * scale), "The solution must be divided by a = d·d, not by 1."},
             {T(), "A long or short direction meets the sphere as one of length 1 does: a = d·d isn't 1."}});
    }
    Rng& rng = item.random();
    for (int i = 0; i < 300; ++i) {
        const Vec3 center(Vec3d(rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3))),
            direction(rng.unit_vector() * rng.uniform(0.3, 3));
        const float radius = static_cast<float>(rng.uniform(0.2, 2.5));
        const auto expected = nearest(Vec3d(center), radius, {0, 0, 0}, Vec3d(direction));
        const auto found = STUDENT(hit_sphere)(center, radius, Ray{{0, 0, 0}, direction});
        const auto grazing = nearest(Vec3d(center), radius * 1.001, {0, 0, 0}, Vec3d(direction)).has_value() !=
                             nearest(Vec3d(center), radius * 0.999, {0, 0, 0}, Vec3d(direction)).has_value();
        if (grazing || std::abs(length(Vec3d(center)) - radius) < 1e-2) continue; // rounding decides
        item.near(message("t for center ", describe(center), ", radius ", radius, ", direction ", describe(direction),
                          " from the origin"),
                  found, expected ? T(static_cast<float>(*expected)) : T(), 2e-3,
                  {{T(), length(Vec3d(center)) < double{radius}
                             ? "The ray starts inside this sphere, so there is one point ahead: the larger root."
                             : "This ray meets the sphere, and its direction isn't 1 long: a = d·d isn't 1."}});
    }
}

LAB_ITEM(10, "the normal points outward and has length 1") {
    item.near("the normal at the top of a sphere with radius 2",
              STUDENT(sphere_normal)(Vec3{1, 2, 3}, 2.0f, Vec3{1, 4, 3}), Vec3{0, 1, 0}, 1e-5,
              {{Vec3{0, 2, 0}, "Its length is 2, the radius: divide by it (a normal has length 1)."},
               {Vec3{0, -1, 0}, "It points inward: subtract the center from the point, not the point from the center."},
               {Vec3{0, -2, 0}, "It points inward, and its length is the radius: (p - center) / radius."},
               {Vec3{1 / 5.0990195f, 4 / 5.0990195f, 3 / 5.0990195f},
                "This is the direction of p itself: subtract the center first."}});
    for (int i = 0; i < 50; ++i) {
        const Vec3 n(item.random().unit_vector()), center(item.random().unit_vector() * 5.0);
        const float radius = static_cast<float>(item.random().uniform(0.5, 9));
        item.near("the normal", STUDENT(sphere_normal)(center, radius, center + n * radius), n, 1e-4);
    }
}

LAB_ITEM(10, "a normal as a color") {
    const auto decoded = static_cast<float>(srgb_decode(0.5)), encoded = static_cast<float>(srgb_encode(0.5));
    item.near(
        "the color of (1, 0, 0)", STUDENT(normal_color)(Vec3{1, 0, 0}), Rgb(1, 0.5f, 0.5f), 1e-6,
        {{Rgb(1, 0, 0), "Coordinates below 0 would be lost: map [-1, 1] to [0, 1] by (x + 1) / 2."},
         {Rgb(1, decoded, decoded), "This was decoded, as in the lesson. The lab wants the numbers themselves."},
         {Rgb(1, std::pow(0.5f, 2.2f), std::pow(0.5f, 2.2f)),
          "This was decoded, as in the lesson. The lab wants the numbers themselves."},
         {Rgb(1, encoded, encoded), "This was encoded by the curve of sRGB. The lab wants the numbers themselves."},
         {Rgb(2, 1, 1), "The sum of a coordinate and 1 lies in [0, 2]: halve it."}});
    item.near("the color of (0, -1, 0)", STUDENT(normal_color)(Vec3{0, -1, 0}), Rgb(0.5f, 0, 0.5f), 1e-6,
              {{Rgb(0.5f, 1, 0.5f), "The sign is lost: don't take the absolute value."},
               {Rgb(0, 1, 0), "The sign is lost: don't take the absolute value."}});
}

LAB_ITEM(15, "a cylinder") {
    const auto of = [](float radius, const Ray& ray) { return STUDENT(hit_cylinder)(radius, ray); };
    item.near("t for a ray from (0, 3, 5) along (0, 0, -1) and the radius 1", of(1, {{0, 3, 5}, {0, 0, -1}}), T(4.0f),
              1e-5,
              {{T(), "The cylinder has no end, so the height of the ray plays no part. Leave y out of c."},
               {T(6.0f), "This is the far side: try the smaller root first."},
               {T(5.0f), "This is the axis. The surface is one radius nearer."}});
    // In units of z it is 4 to the surface, and the direction goes 1 in z for each t, however much it goes up.
    item.near(
        "t for a ray from (0, 0, 5) along (0, 1, -1) and the radius 1", of(1, {{0, 0, 5}, {0, 1, -1}}), T(4.0f), 1e-5,
        {{T(), "The cylinder has no end, so rays that rise meet it, too. Leave y out of a and b."},
         {T(4 * std::sqrt(2.0f)), "This is the distance. t counts lengths of the direction: don't normalize it."}});
    item.near("t for a ray from (0.6, -2, 5) along (0, 0, -2) and the radius 1", of(1, {{0.6f, -2, 5}, {0, 0, -2}}),
              T(2.1f), 1e-5, {{T(4.2f), "The direction is 2 long in x and z: divide by a."}});
    item.near(
        "t for a ray from inside, from (0, 0, 0) along (1, 7, 0) and the radius 1", of(1, {{0, 0, 0}, {1, 7, 0}}),
        T(1.0f), 1e-5,
        {{T(), "From inside there is one point ahead: where the smaller root isn't on the ray, try the larger."}});
    item.near("a ray that passes by", of(1, {{2, 0, 5}, {0, 0, -1}}), T(), 0,
              {{T(NAN), "This is not a number: the root of a negative discriminant. Test its sign first."}});
    for (const float x : {0.5f, 1.0f, 3.0f})
        item.near(message("t for a ray along the axis, at the distance ", x, " from it,"),
                  of(1, {{x, 0, 0}, {0, 2, 0}}), T(), 0,
                  {{T(NAN), "This is not a number: 0 / 0. For a ray along the axis a = 0; return nothing."},
                   {T(INFINITY), "Something was divided by 0. For a ray along the axis a = 0; return nothing."}});
    Rng& rng = item.random();
    for (int i = 0; i < 200; ++i) {
        const Vec3 origin(Vec3d(rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3))),
            direction(rng.unit_vector() * rng.uniform(0.3, 3));
        const double radius = rng.uniform(0.2, 2.5), around = std::hypot(double{origin.x}, double{origin.z});
        const auto at = [&](double r) { return nearest_of_cylinder(r, Vec3d(origin), Vec3d(direction)); };
        if (at(radius * 1.001).has_value() != at(radius * 0.999).has_value()) continue; // rounding decides
        if (std::abs(around - radius) < 1e-2 || std::hypot(double{direction.x}, double{direction.z}) < 0.1) continue;
        const auto expected = at(radius);
        item.near(
            message("t for a ray from ", describe(origin), " along ", describe(direction), " and the radius ", radius),
            of(static_cast<float>(radius), {origin, direction}), expected ? T(static_cast<float>(*expected)) : T(),
            5e-3);
    }
    item.near("the second point, with t_min = 5", of(1, {{0, 3, 5}, {0, 0, -1}, 5}), T(6.0f), 1e-5,
              {{T(4.0f), "t = 4 is before t_min = 5: only points with t_min < t < t_max count."}});
}
