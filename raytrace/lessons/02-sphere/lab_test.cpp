// The examiner of lab 02. The expected values are computed by hand, or in double precision by the distance from the
// center to the ray.
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
    const Ray ray{{0, 0, 0}, {0, 0, -1}};
    item.near("the distance of the front of a sphere with radius 1 at distance 3",
              STUDENT(hit_sphere)(kCenter, 1.0f, ray), T(2.0f), 1e-5,
              {{T(4.0f), "This is the back of the sphere: try the smaller root first."},
               {T(-2.0f), "The point lies behind the origin: b = (origin - center)·direction has the wrong sign, or -b "
                          "was written as b."},
               {T(-4.0f), "The point lies behind the origin: b = (origin - center)·direction has the wrong sign, or -b "
                          "was written as b."},
               {T(1.0f), "Is the 2 in front of b counted once too often? The solution is (-b ± √(b² - ac)) / a for "
                         "a·t² + 2b·t + c = 0."},
               {T(), "The ray passes through the center, so it hits; your function returned nothing. "
                     "Is q = origin - center, in this order, and b² - a·c the discriminant?"}});
}

LAB_ITEM(15, "a ray through the center meets two surfaces: from inside it finds the back") {
    item.near(
        "the distance to the surface from the center", STUDENT(hit_sphere)(kCenter, 1.0f, Ray{kCenter, {0, 0, -1}}),
        T(1.0f), 1e-5,
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

LAB_ITEM(15, "a ray off the axis") {
    // At the height 0.6 the front of the unit sphere is √(1 - 0.36) = 0.8 before its center.
    item.near("the distance at the height 0.6", STUDENT(hit_sphere)(kCenter, 1.0f, Ray{{0, 0.6f, 0}, {0, 0, -1}}),
              T(2.2f), 1e-5,
              {{T(2.0f), "This is the distance on the axis: the height of the ray plays no part. Does c = q·q - r² "
                         "have all of q in it?"},
               {T(3.8f), "This is the back of the sphere: try the smaller root first."}});
    item.near("a sphere of radius 2", STUDENT(hit_sphere)(kCenter, 2.0f, Ray{{0, 0, 0}, {0, 0, -1}}), T(1.0f), 1e-5,
              {{T(2.0f), "The radius plays no part: the third coefficient is q·q - r²."},
               {T(3 - std::sqrt(2.0f)), "The radius must be squared."}});
}

LAB_ITEM(10, "a tangent, and misses on both sides of it") {
    const auto at_height = [](float y) { return STUDENT(hit_sphere)(kCenter, 1.0f, Ray{{0, y, 0}, {0, 0, -1}}); };
    item.near("the tangent at the height 1", at_height(1), T(3.0f), 1e-3,
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
                  found, expected ? T(static_cast<float>(*expected)) : T(), 2e-3);
    }
}

LAB_ITEM(15, "the normal points outward and has length 1") {
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
    item.near("the color of (1, 0, 0)", STUDENT(normal_color)(Vec3{1, 0, 0}), Rgb(1, 0.5f, 0.5f), 1e-6,
              {{Rgb(1, 0, 0), "Coordinates below 0 would be lost: map [-1, 1] to [0, 1] by (x + 1) / 2."}});
    item.near("the color of (0, -1, 0)", STUDENT(normal_color)(Vec3{0, -1, 0}), Rgb(0.5f, 0, 0.5f), 1e-6,
              {{Rgb(0.5f, 1, 0.5f), "The sign is lost: don't take the absolute value."},
               {Rgb(0, 1, 0), "The sign is lost: don't take the absolute value."}});
}
