// The examiner of lab 07. Expected values are computed by hand or, in double precision, from spherical coordinates and
// similar triangles.
#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"
#include "raytrace/lessons/07-camera/lab.h"
#include "tests/grading/judge.h"

#include <array>
#include <cmath>

using namespace duet;
using namespace duet::grading;
using lab::Axes;

LAB_TITLE("raytrace-07", "A camera")

namespace {

const Axes kPlain{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

struct AxesD {
    Vec3d right, up, back;
    Axes rounded() const { return {Vec3(right), Vec3(up), Vec3(back)}; }
};

/// The axes of a camera that is turned by `yaw` around +y, to the left, and then looks up by `pitch`, in radians.
AxesD turned(double yaw, double pitch) {
    return {{std::cos(yaw), 0, -std::sin(yaw)},
            {std::sin(yaw) * std::sin(pitch), std::cos(pitch), std::cos(yaw) * std::sin(pitch)},
            {std::sin(yaw) * std::cos(pitch), -std::sin(pitch), std::cos(yaw) * std::cos(pitch)}};
}
AxesD random_axes(Rng& rng) { return turned(rng.uniform(-kPiDouble, kPiDouble), rng.uniform(-1.4, 1.4)); }

/// Judges the axes for a view with an `up` of any length that leans against it.
void check_axes(Item& item, const std::string& name, Vec3d eye, const AxesD& axes, double distance, Vec3d up) {
    const Vec3d look_at = eye - axes.back * distance;
    const Axes expected = axes.rounded();
    const Axes found = STUDENT(camera_axes)(Vec3(eye), Vec3(look_at), Vec3(up));
    const Vec3d sine = cross(up, axes.back);
    const Vec3 r = expected.right, u = expected.up, b = expected.back;
    item.near(
        name + ": back", found.back, b, 2e-5,
        {{-b, "It points to what the camera looks at. back points the other way: it is eye - look_at, made 1 long."},
         {b * static_cast<float>(distance), "It must have length 1: normalize it."},
         {normalize(Vec3(-look_at)), "The eye's position must be subtracted."},
         {normalize(Vec3(look_at)), "The eye's position must be subtracted."}});
    item.require(!(is_near(found.right, -r, 2e-5) && is_near(found.up, u, 2e-5)),
                 name + ": right points to the left, so the picture is mirrored: the axes are left-handed. right is "
                        "cross(up, back), in this order.");
    item.require(!(is_near(found.right, -r, 2e-5) && is_near(found.up, -u, 2e-5)),
                 name + ": right points to the left and up downward, so the picture is turned by 180 degrees. right is "
                        "cross(up, back), in this order.");
    item.near(name + ": right", found.right, r, 2e-5,
              {{-r, "It points to the left: right is cross(up, back), in this order."},
               {Vec3(sine), "It must have length 1. A cross product is only as long as the sine of the angle between "
                            "its vectors (times their lengths)."},
               {Vec3(normalize(up) * 1.0), "This is the given up: right is at right angles to it, cross(up, back)."},
               {Vec3(sine / length(up)), "It must have length 1. A cross product is only as long as the sine of the "
                                         "angle between its vectors (times their lengths)."},
               {Vec3{1, 0, 0}, "It is the x axis, though the camera is turned."}});
    item.near(name + ": up", found.up, u, 2e-5,
              {{-u, "It points downward: up is cross(back, right), in this order."},
               {Vec3(up), "This is the given up, which is not at right angles to the view. Take cross(back, right)."},
               {Vec3(normalize(up)),
                "This is the given up, which is not at right angles to the view. Take cross(back, right)."}});
}

/// Whether three vectors are right-handed axes.
bool are_axes(const Axes& a) {
    return is_near(cross(a.up, a.back), a.right, 1e-4) && is_near(cross(a.back, a.right), a.up, 1e-4) &&
           std::abs(length(a.right) - 1) < 1e-4f && std::abs(length(a.back) - 1) < 1e-4f;
}

void check_direction(Item& item, const std::string& name, const AxesD& axes, double fov, int width, int height,
                     double x, double y) {
    const double w = width, h = height;
    // A direction by tangents; of the classic mistakes as well.
    const auto direction = [&](double tangent, double right, double up) {
        return Vec3(normalize(axes.right * (right * tangent) + axes.up * (up * tangent) - axes.back));
    };
    const double right = (2 * x - w) / h, up = (h - 2 * y) / h, half = std::tan(radians(fov) / 2);
    const Vec3 expected = direction(half, right, up);
    const Vec3 found = STUDENT(pixel_direction)(axes.rounded(), static_cast<float>(fov), width, height,
                                                static_cast<float>(x), static_cast<float>(y));
    const std::string degrees = "std::tan expects radians: multiply degrees by pi / 180.";
    item.near(
        name, found, expected, 2e-5,
        {{Vec3(axes.right * (right * half) + axes.up * (up * half) - axes.back), "It must have length 1."},
         {direction(std::tan(fov / 2), right, up), degrees},
         {direction(std::tan(fov), right, up), degrees},
         {direction(std::tan(radians(fov)), right, up),
          "fov_degrees spans the whole picture: the tangent of half of the angle is the half height at distance 1."},
         {direction(half / 2, right, up), "The picture reaches from -tan to +tan of half of the angle: twice that."},
         {direction(half, right, -up),
          "The picture is upside down: y counts rows downward, the axis up points upward."},
         {direction(half, -right, up), "The picture is mirrored: x grows to the right, as the axis right does."},
         {direction(half, right * h / w, up * h / w),
          "The angle of view is vertical: the height of the picture follows from it, not the width."},
         {direction(half, right * h / w, up),
          "The picture is stretched: pixels are squares, so x and y have one scale."},
         {direction(half, right * h, up * h), "Divide by the number of rows."},
         {Vec3(normalize(axes.right * (right * half) + axes.up * (up * half) + axes.back)),
          "It points backward: the camera looks along -back."},
         {Vec3(normalize(Vec3d(right * half, up * half, -1))), "The camera's axes play no part."}});
}

struct LensSetup {
    AxesD axes;
    Vec3d eye;
    double radius, focus;
};

void check_lens(Item& item, const std::string& name, const LensSetup& setup, double right, double up, Vec2d lens) {
    const AxesD& axes = setup.axes;
    const Vec3d d = normalize(axes.right * right + axes.up * up - axes.back);
    const Vec3d origin = setup.eye + axes.right * (setup.radius * lens.x) + axes.up * (setup.radius * lens.y);
    const Vec3d sharp = setup.eye + (axes.right * right + axes.up * up - axes.back) * setup.focus;
    const Ray found = STUDENT(lens_ray)(Vec3(setup.eye), axes.rounded(), Vec3(d), static_cast<float>(setup.radius),
                                        static_cast<float>(setup.focus), Vec2(lens));
    const double size = length(setup.eye) + setup.radius;
    item.near(
        name + ": the origin", found.origin, Vec3(origin), 2e-6 * size + 1e-6,
        {{Vec3(setup.eye), "The ray starts at the eye, not at a point of the lens."},
         {Vec3(origin * 2.0 - setup.eye), "The lens is too large: aperture_radius is its radius, not its diameter."},
         {Vec3(setup.eye + (origin - setup.eye) * 0.5),
          "The lens is too small: aperture_radius is its radius, not its diameter."},
         {Vec3(origin - setup.eye), "The lens is around the eye: add the eye."},
         {Vec3(setup.eye + Vec3d(lens.x, lens.y, 0) * setup.radius),
          "The lens lies along x and y of the world. It must lie along the camera's axes right and up."}});
    item.near(
        name + ": the direction", found.direction, Vec3(normalize(sharp - origin)), 2e-5,
        {{Vec3(d),
          "The rays of one pixel are parallel, so nothing is sharp. Aim at the point where the ray from the eye "
          "meets the sharp plane."},
         {Vec3(sharp - origin), "It must have length 1."},
         {Vec3(normalize(setup.eye + d * setup.focus - origin)),
          "All rays meet at focus_distance along the direction: that is a sphere around the eye. What is sharp is a "
          "plane: divide focus_distance by the cosine of the angle between direction and view."},
         {Vec3(normalize(origin - sharp)), "It points backward."},
         {Vec3(normalize(sharp - setup.eye - (origin - setup.eye) * 2.0)),
          "The offset of the lens is subtracted twice."}});
    item.require(found.t_min == 0 && found.t_max == kInfinity, name + ": t_min and t_max must be 0 and infinity.");
}

} // namespace

LAB_ITEM(0, "the picture") {
    const std::vector<lesson::Sphere> spheres{
        {{-0.9f, 0.5f, 2}, 0.5f}, {{0, 0.5f, 0}, 0.5f}, {{0.9f, 0.5f, -2}, 0.5f}, {{0, -100, 0}, 100}};
    const std::array<Rgb, 4> colors{Rgb(0.8f, 0.2f, 0.1f), Rgb(0.9f, 0.7f, 0.2f), Rgb(0.1f, 0.3f, 0.8f), Rgb(0.5f)};
    const Vec3 eye{2, 2, 6};
    const Axes axes = STUDENT(camera_axes)(eye, Vec3{0, 0.5f, 0}, Vec3{0, 1, 0});
    ImageRgb image(96, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) {
            const Vec3 d = STUDENT(pixel_direction)(axes, 30.0f, 96, 64, static_cast<float>(x) + 0.5f,
                                                    static_cast<float>(y) + 0.5f);
            for (int i = 0; i < 4; ++i) {
                const Vec2 random(Vec2d(item.random().uniform(), item.random().uniform()));
                const Vec2 lens = STUDENT(lens_point)(random);
                const Ray ray = STUDENT(lens_ray)(eye, axes, d, 0.1f, 6.3f, lens);
                const auto hit = lesson::closest_hit(spheres, ray);
                image(x, y) +=
                    (hit ? colors[hit->index] * (0.6f + 0.4f * hit->n.y) : lesson::sky_color(ray.direction)) * 0.25f;
            }
        }
    item.show("three spheres, the middle one sharp", image);
}

LAB_ITEM(30, "the axes are right-handed, at right angles, and 1 long") {
    check_axes(item, "a camera at zero that looks along -z", {0, 0, 0}, turned(0, 0), 1, {0, 1, 0});
    // From (3, 0, 0) to zero: back is +x, and what is to the right is -z.
    check_axes(item, "a camera at (3, 0, 0) that looks at zero", {3, 0, 0}, turned(kPiDouble / 2, 0), 3, {0, 1, 0});
    // From (0, 4, 3) to zero: back is (0, 0.8, 0.6), right is +x, up is (0, 0.6, -0.8).
    check_axes(item, "a camera at (0, 4, 3) that looks at zero", {0, 4, 3}, turned(0, -std::asin(0.8)), 5, {0, 2, 0});
    for (int i = 0; i < 200; ++i) {
        const AxesD axes = random_axes(item.random());
        const Vec3d eye = item.random().unit_vector() * item.random().uniform(0, 9);
        const double lean = item.random().uniform(-0.9, 0.9), scale = item.random().uniform(0.3, 3);
        check_axes(item, "a camera with an `up` that leans", eye, axes, item.random().uniform(0.5, 9),
                   (axes.up + axes.back * lean) * scale);
    }
}

LAB_ITEM(10, "up parallel to the view") {
    for (const Vec3 up : {Vec3{0, 1, 0}, Vec3{0, -2, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 3}, normalize(Vec3{1, 1, 1})}) {
        const Axes found = STUDENT(camera_axes)(Vec3{0, 0, 0} + up * 4.0f, Vec3{0, 0, 0}, up);
        item.require(!std::isnan(length(found.right)),
                     message("With up = ", describe(up),
                             " parallel to the view, right is not a number: cross(up, back) is "
                             "(0, 0, 0) then, and has no direction. Take another up."));
        item.require(
            are_axes(found) && is_near(found.back, normalize(up), 1e-4),
            message("With up = ", describe(up),
                    " parallel to the view, the axes must still be right-handed, of length 1 and at right angles, "
                    "with back = eye - look_at, made 1 long. cross(up, back) is (almost) (0, 0, 0) then: take "
                    "another up. Found right ",
                    describe(found.right), ", up ", describe(found.up), ", back ", describe(found.back), "."));
    }
}

LAB_ITEM(25, "the direction through a pixel") {
    check_direction(item, "the direction through the middle of the picture", turned(0, 0), 90, 180, 100, 90, 50);
    // The lower edge at 60 degrees of view: 30 degrees downward, (0, -1/2, -√3/2).
    check_direction(item, "60 degrees of view, 180 × 100: the direction through the middle of the lower edge",
                    turned(0, 0), 60, 180, 100, 90, 100);
    // The upper edge at 90 degrees of view: 45 degrees upward, (0, √½, -√½).
    check_direction(item, "90 degrees of view, 180 × 100: the direction through the middle of the upper edge",
                    turned(0, 0), 90, 180, 100, 90, 0);
    // The right edge, 1.8 times as far from the middle: (1.8, 0, -1) / √4.24.
    check_direction(item, "90 degrees of view, 180 × 100: the direction through the middle of the right edge",
                    turned(0, 0), 90, 180, 100, 180, 50);
    check_direction(item, "40 degrees of view, 64 × 48: the direction through the center of the first pixel",
                    turned(0, 0), 40, 64, 48, 0.5, 0.5);
    check_direction(item, "a camera that looks along -x, its upper right corner", turned(kPiDouble / 2, 0), 50, 90, 60,
                    90, 0);
    for (int i = 0; i < 200; ++i) {
        const int width = item.random().integer(10, 2000), height = item.random().integer(10, 2000);
        check_direction(item, "the direction through a random point of a picture", random_axes(item.random()),
                        item.random().uniform(5, 120), width, height, item.random().uniform(0, width),
                        item.random().uniform(0, height));
    }
}

LAB_ITEM(15, "points of the lens, all equally likely") {
    // 4000 pairs of numbers, one at a random place of each cell of a grid, so that chance plays almost no part.
    constexpr int kRows = 64;
    std::array<double, 4> rings{}, quarters{};
    double beyond = 0;
    for (int i = 0; i < kRows * kRows; ++i) {
        const Vec2 random(
            Vec2d((i % kRows + item.random().uniform()) / kRows, (i / kRows + item.random().uniform()) / kRows));
        const Vec2 p = STUDENT(lens_point)(random);
        const double x = static_cast<double>(p.x), y = static_cast<double>(p.y), r2 = x * x + y * y;
        item.require(std::isfinite(r2), "The point is not a number for the random numbers " + describe(random) + ".");
        beyond = std::max(beyond, r2);
        const auto ring = static_cast<std::size_t>(std::min(r2 * 4, 3.0));
        rings[ring] += 1.0 / (kRows * kRows);
        quarters[(x < 0 ? 1u : 0u) + (y < 0 ? 2u : 0u)] += 1.0 / (kRows * kRows);
    }
    item.require(beyond < 1.0001, message("A point lies outside the disk, ", std::sqrt(beyond),
                                          " from its center. If the lens is a square, what is out of focus is "
                                          "smeared into squares."));
    item.require(beyond > 0.9, "All points are near the center: the disk has the radius 1.");
    for (const double quarter : quarters)
        item.require(std::abs(quarter - 0.25) < 0.03,
                     message("Only a part of the disk is covered evenly: the quarters get ", quarters[0], ", ",
                             quarters[1], ", ", quarters[2], " and ", quarters[3],
                             " of all points. The angle must run from 0 to 2 pi."));
    item.require(rings[0] < 0.4,
                 message("Points crowd at the center: the inner quarter of the disk's area gets ", rings[0],
                         " of them. The area within r grows with r², so r is the square root of a "
                         "random number."));
    for (const double ring : rings)
        item.require(std::abs(ring - 0.25) < 0.03,
                     message("Four rings of the same area get ", rings[0], ", ", rings[1], ", ", rings[2], " and ",
                             rings[3], " of all points, from the innermost on; each should get 0.25."));
}

LAB_ITEM(20, "rays through the lens meet in the sharp plane") {
    const LensSetup plain{turned(0, 0), {0, 0, 0}, 0.5, 4};
    check_lens(item, "the center of the lens", plain, 0, 0, {0, 0});
    // From (0.5, 0, 0) to (0, 0, -4).
    check_lens(item, "the right edge of a lens of radius 0.5 focused at 4", plain, 0, 0, {1, 0});
    // From (0, -0.5, 0) to (4, 0, -4): the ray from the eye meets the plane 4√2 away.
    check_lens(item, "the lower edge of the lens, 45 degrees to the right of the view", plain, 1, 0, {0, -1});
    check_lens(item, "an aperture of 0", {turned(0, 0), {0, 0, 0}, 0, 4}, 1, 0.5, {0.6, -0.6});
    check_lens(item, "a camera that looks along -x", {turned(kPiDouble / 2, 0), {3, 1, 0}, 0.25, 2}, 0, 0.5, {1, 0});
    for (int i = 0; i < 200; ++i) {
        const double angle = item.random().uniform(0, 2 * kPiDouble), r = std::sqrt(item.random().uniform());
        check_lens(item, "a random ray",
                   {random_axes(item.random()), item.random().unit_vector() * 5.0, item.random().uniform(0.05, 0.8),
                    item.random().uniform(1, 9)},
                   item.random().uniform(-1, 1), item.random().uniform(-1, 1),
                   {r * std::cos(angle), r * std::sin(angle)});
    }
}
