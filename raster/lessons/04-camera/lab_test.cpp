// The examiner of raster lab 04. What it expects is computed in double, from the camera's axes and similar triangles,
// without matrices. Matrices appear where it names a mistake: they hold what the mistake would give.
#include "raster/lessons/04-camera/lab.h"
#include "tests/grading/judge.h"

#include <array>
#include <cmath>
#include <optional>

using namespace duet;
using namespace duet::grading;
using lab::View;

LAB_TITLE("raster-04", "Camera, perspective, matrices")

namespace {

Vec4d to_double(Vec4 v) { return {double(v.x), double(v.y), double(v.z), double(v.w)}; }

struct Axes {
    Vec3d right, top, back;
};
Axes axes_of(Vec3d eye, Vec3d target, Vec3d up) {
    const Vec3d back = normalize(eye - target), right = normalize(cross(up, back));
    return {right, cross(back, right), back};
}
Axes axes_of(const View& view) { return axes_of(Vec3d(view.eye), Vec3d(view.target), Vec3d(view.up)); }

/// World to camera by three axes, whatever they are.
Mat4d rows(Vec3d x, Vec3d y, Vec3d z, Vec3d eye) {
    Mat4d m;
    m[0] = {x.x, x.y, x.z, -dot(x, eye)};
    m[1] = {y.x, y.y, y.z, -dot(y, eye)};
    m[2] = {z.x, z.y, z.z, -dot(z, eye)};
    return m;
}
Mat4d look_at(const View& view) {
    const Axes a = axes_of(view);
    return rows(a.right, a.top, a.back, Vec3d(view.eye));
}
/// Clip space from the two scales and the row of the depth.
Mat4d lens(double x, double y, double a, double b, double w = -1, double one = 0) {
    Mat4d m;
    m[0] = {x, 0, 0, 0};
    m[1] = {0, y, 0, 0};
    m[2] = {0, 0, a, b};
    m[3] = {0, 0, w, one};
    return m;
}
struct Lens {
    double f, aspect, a, b;
};
Lens lens_of(double fov, double aspect, double near, double far) {
    return {1 / std::tan(fov / 2), aspect, far / (near - far), near * far / (near - far)};
}
Mat4d perspective(double fov, double aspect, double near, double far) {
    const Lens l = lens_of(fov, aspect, near, far);
    return lens(l.f / aspect, l.f, l.a, l.b);
}

std::vector<Mistake<Mat4>> look_at_mistakes(const View& view) {
    const Axes a = axes_of(view);
    const Vec3d eye(view.eye), to(Vec3d(view.eye) - Vec3d(view.target)), up(view.up);
    const Mat4d right = look_at(view);
    Mat4d unmoved = right, unturned = right, added = right;
    for (std::size_t i = 0; i < 3; ++i) unmoved[i][3] = 0, unturned[i][3] = -eye[i], added[i][3] = -right[i][3];
    const Vec3d slanted = cross(up, a.back);
    const std::string mirrored = "The camera's x axis points left, so the image is mirrored: it is up × back, in this "
                                 "order (right-handed axes).";
    return {
        {Mat4(rows(-a.right, a.top, a.back, eye)), mirrored},
        {Mat4(rows(-a.right, -a.top, a.back, eye)),
         mirrored + " Yours also stands on its head, because y was computed from that x."},
        {Mat4(rows(a.right, -a.top, a.back, eye)),
         "The camera's y axis points down: it is back × right, in this order."},
        {Mat4(rows(-a.right, a.top, -a.back, eye)),
         "The camera looks along +z: back is eye - target, and the target must come to a negative z."},
        {Mat4(rows(a.right, a.top, -a.back, eye)),
         "The z axis points forward: back is eye - target, and the target must come to a negative z."},
        {Mat4(rows(a.right, -a.top, -a.back, eye)),
         "The camera looks along +z: back is eye - target, and the target must come to a negative z."},
        {Mat4(transpose(right)), "Rows and columns are exchanged: m[row][column], and the axes are the rows."},
        {Mat4(inverse_affine(right)), "This is the inverse, from camera to world: the axes are rows, not columns."},
        {Mat4(unmoved),
         "The eye is not moved to the origin: the last column is minus the dot products of axes and eye."},
        {Mat4(unturned),
         "The last column is -eye. But the eye is moved in the turned axes: -dot(axis, eye) for each row."},
        {Mat4(added), "The sign of the last column is wrong: it is minus the dot products of the axes and the eye."},
        {Mat4(rows(slanted, cross(a.back, slanted), a.back, eye)),
         "The axis that points right doesn't have length 1: normalize the cross product, since up is not always at a "
         "right angle to the line of sight."},
        {Mat4(rows(slanted, a.top, a.back, eye)),
         "The axis that points right doesn't have length 1: normalize the cross product, since up is not always at a "
         "right angle to the line of sight."},
        {Mat4(rows(a.right, cross(to, a.right), to, eye)), "The axis that points back doesn't have length 1."},
        {Mat4(rows(a.right, a.top, to, eye)), "The axis that points back doesn't have length 1."},
        {Mat4(rows(a.right, up, a.back, eye)),
         "The vector up itself was taken for the y axis. It is not at a right angle to the line of sight: y is back × "
         "right."},
        {Mat4(rows(a.right, normalize(up), a.back, eye)),
         "The vector up itself was taken for the y axis. It is not at a right angle to the line of sight: y is back × "
         "right."},
    };
}

std::vector<Mistake<Mat4>> perspective_mistakes(double fov, double aspect, double near, double far) {
    const auto [f, ratio, a, b] = lens_of(fov, aspect, near, far);
    const double doubled = 1 / std::tan(fov), small = 1 / std::tan(radians(fov) / 2), low = std::tan(fov / 2);
    return {
        {Mat4(transpose(lens(f / aspect, f, a, b))), "Rows and columns are exchanged: m[row][column]."},
        {Mat4(lens(doubled / aspect, doubled, a, b)),
         "The field of view is the whole angle, from the lower edge to the upper one: take the tangent of half of it."},
        {Mat4(lens(small / aspect, small, a, b)), "fov is in radians already: don't convert it."},
        {Mat4(lens(low / aspect, low, a, b)),
         "A wider field of view makes things smaller: f is 1 / tan(fov / 2), not the tangent itself."},
        {Mat4(lens(f * aspect, f, a, b)), "x must be divided by the aspect, not multiplied: a wide image shows more."},
        {Mat4(lens(f, f, a, b)), "The aspect plays no part: divide f by it for x."},
        {Mat4(lens(f, f * aspect, a, b)),
         "fov is the vertical field of view: y has f alone, and x has f divided by the aspect."},
        {Mat4(lens(f, f / aspect, a, b)), "The aspect belongs to x: y has f alone."},
        {Mat4(lens(1 / aspect, 1, a, b)), "The field of view plays no part: f is 1 / tan(fov / 2)."},
        {Mat4(lens(f / aspect, f, a, b, 0, 1)),
         "w stays 1, so there is no perspective: the last row is (0, 0, -1, 0), and w becomes the distance."},
        {Mat4(lens(f / aspect, f, a, b, -1, 1)),
         "The last entry of the last row is 0: a new Mat4 has ones on the diagonal, also there."},
        {Mat4(lens(f / aspect, f, a, b, 1)),
         "w is negative in front of the eye: the camera looks along -z, so the distance is -z."},
        {Mat4(lens(f / aspect, f, (far + near) / (near - far), 2 * near * far / (near - far))),
         "The depth goes from -1 to 1, as in OpenGL: here it shall be 0 at near and 1 at far."},
        {Mat4(lens(f / aspect, f, -near / (near - far), -near * far / (near - far))),
         "The depth is 1 at near and 0 at far: here it is the other way around."},
        {Mat4(lens(f / aspect, f, -a, b)), "The depth's row has a wrong sign: z is negative in front of the eye."},
        {Mat4(lens(f / aspect, f, a, -b)), "The depth's row has a wrong sign: z is negative in front of the eye."},
        {Mat4(lens(f / aspect, f, 1, 0)),
         "z goes through unchanged. After the division by w it would be -1 everywhere: the depth needs A and B."},
    };
}

/// A point in an image by similar triangles; nothing at the eye or behind it.
std::optional<Vec3> seen(Vec3d p, const View& view, double width, double height) {
    const Axes axes = axes_of(view);
    const Vec3d q = p - Vec3d(view.eye);
    const double w = -dot(axes.back, q), f = 1 / std::tan(static_cast<double>(view.fov) / 2);
    if (w <= 0) return std::nullopt;
    const double x = f * dot(axes.right, q) / w * height / width, y = f * dot(axes.top, q) / w;
    const double near = static_cast<double>(view.near), far = static_cast<double>(view.far);
    return Vec3(Vec3d((1 + x) / 2 * width, (1 - y) / 2 * height, (1 - near / w) / (1 - near / far)));
}

/// Clip space to an image, for what mistakes give.
Vec3 place(Vec4d c, int width, int height, double w) {
    return Vec3(Vec3d((1 + c.x / w) / 2 * width, (1 - c.y / w) / 2 * height, c.z / w));
}

std::vector<Mistake<std::optional<Vec3>>> project_mistakes(Vec3 p, const View& view, int width, int height) {
    const auto fov = static_cast<double>(view.fov), near = static_cast<double>(view.near),
               far = static_cast<double>(view.far);
    const double aspect = static_cast<double>(width) / height;
    const Mat4d eye = look_at(view);
    const auto with = [&](double ratio) { return perspective(fov, ratio, near, far); };
    const Vec4d point(Vec3d(p), 1.0), clip = with(aspect) * eye * point;
    const Vec4d swapped = eye * with(aspect) * point;
    const std::string order =
        "Are the matrices multiplied in the wrong order? look_at comes first, so it stands on the "
        "right: perspective * look_at * p.";
    return {
        {place(swapped, width, height, swapped.w), order},
        {place({-clip.x, clip.y, clip.z, clip.w}, width, height, clip.w),
         "Left and right are exchanged: the image is mirrored."},
        {place({clip.x, -clip.y, clip.z, clip.w}, width, height, clip.w), "It is upside down."},
        {place(clip, width, height, 1), "The division by w is missing."},
        {place(with(width / height) * eye * point, width, height, clip.w),
         message("The aspect was computed with whole numbers: ", width, " / ", height, " of two int is ",
                 width / height, ". Convert to float first.")},
        {place(with(1 / aspect) * eye * point, width, height, clip.w),
         "The aspect is turned around: it is width / height."},
        {place(with(1) * eye * point, width, height, clip.w), "The aspect must be that of the image, width / height."},
        {place(with(aspect) * point, width, height, (with(aspect) * point).w),
         "The camera's place plays no part: multiply by look_at first."},
        {std::optional<Vec3>(),
         "The point is in front of the eye, but your function returned nothing. " +
             (swapped.w <= 0 ? order : std::string("The distance is w, and -z in camera space."))},
    };
}

/// A camera and a point that it sees.
View random_view(Rng& rng) {
    View view;
    const Vec3d eye(rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-5, 5));
    const Vec3d way = rng.unit_vector();
    Vec3d up = rng.unit_vector();
    while (length(cross(up, way)) < 0.4) up = rng.unit_vector();
    view.eye = Vec3(eye);
    view.target = Vec3(eye + way * rng.uniform(0.5, 4));
    view.up = Vec3(up * rng.uniform(0.5, 3));
    view.fov = static_cast<float>(rng.uniform(0.4, 2));
    view.near = static_cast<float>(rng.uniform(0.1, 1));
    view.far = view.near + static_cast<float>(rng.uniform(5, 40));
    return view;
}

constexpr float kRightAngle = kPi / 2;
const View kFront{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1, 0.1f, 20};

} // namespace

LAB_ITEM(0, "the picture") {
    constexpr int kWidth = 200, kHeight = 130;
    ImageRgb image(kWidth, kHeight, Rgb(0.01f, 0.01f, 0.03f));
    ImageFloat depth(kWidth, kHeight, kInfinity);
    const View view{{1.6f, 1.7f, 3}, {0, 0.35f, -0.6f}, {0, 1, 0}, 0.8f, 0.1f, 20};
    for (int i = 0; i < 6; ++i)
        for (int row = 0; row < 24; ++row)
            for (int k = 0; k < 30; ++k) { // amphorae of points
                const double h = row / 23.0, angle = 2 * kPiDouble * (k + 0.5 * (row % 2)) / 30;
                const double radius =
                    0.05 + 0.28 * std::sin(kPiDouble * std::pow(h, 0.8)) * (1 - 0.35 * h) + 0.12 * h * h * h;
                const Vec3d out(std::sin(angle), 0, std::cos(angle));
                const Vec3 p(out * radius + Vec3d(i % 3 - 1.0, h, -(i / 3)));
                const auto at = STUDENT(project)(p, view, kWidth, kHeight);
                if (!at || !(at->x >= 0 && at->x < kWidth && at->y >= 0 && at->y < kHeight)) continue;
                const int x = static_cast<int>(at->x), y = static_cast<int>(at->y);
                if (at->z < depth(x, y)) depth(x, y) = at->z, image(x, y) = direction_color(Vec3(out));
            }
    item.show("your camera's view of six amphorae of points", image);
}

LAB_ITEM(10, "look_at: a camera at (5, 0, 0) that looks at the origin") {
    const View view{{5, 0, 0}, {0, 0, 0}, {0, 1, 0}, 1, 0.1f, 1};
    const Mat4 m = STUDENT(look_at)(view.eye, view.target, view.up);
    item.near("look_at, as (first row, second row, third row, fourth row),", m, Mat4(look_at(view)), 1e-5,
              look_at_mistakes(view));
    item.near("the eye in camera space", transform_point(m, view.eye), Vec3{0, 0, 0}, 1e-5);
    item.near("the origin in camera space", transform_point(m, Vec3{0, 0, 0}), Vec3{0, 0, -5}, 1e-5);
    item.near("the point (0, 0, -1), which lies to the right,", transform_point(m, Vec3{0, 0, -1}), Vec3{1, 0, -5},
              1e-5);
}

LAB_ITEM(20, "look_at: any place, with an up that is slanted and not of length 1") {
    const View slanted{{1, 4, 6}, {-1, 1, 2}, {0, 2, 0}, 1, 0.1f, 1};
    item.near("look_at of eye (1, 4, 6), target (-1, 1, 2), up (0, 2, 0), as four rows,",
              STUDENT(look_at)(slanted.eye, slanted.target, slanted.up), Mat4(look_at(slanted)), 1e-5,
              look_at_mistakes(slanted));
    for (int i = 0; i < 100; ++i) {
        const View view = random_view(item.random());
        const Mat4 m = STUDENT(look_at)(view.eye, view.target, view.up);
        item.near(message("look_at of eye ", describe(view.eye), ", target ", describe(view.target), ", up ",
                          describe(view.up), ", as four rows,"),
                  m, Mat4(look_at(view)), 1e-4, look_at_mistakes(view));
    }
}

LAB_ITEM(15, "perspective: the field of view and the aspect") {
    const Mat4 m = STUDENT(perspective)(kRightAngle, 1.5f, 1.0f, 5.0f);
    item.near("perspective of 90 degrees, aspect 1.5, near 1, far 5, as four rows,", m,
              Mat4(perspective(kPiDouble / 2, 1.5, 1, 5)), 1e-5, perspective_mistakes(kPiDouble / 2, 1.5, 1, 5));
    item.near("the point (1, 2, -4) in clip space, computed by hand on the page,", m * Vec4(1, 2, -4, 1),
              Vec4(2 / 3.0f, 2, 3.75f, 4), 1e-5);
    for (int i = 0; i < 100; ++i) {
        const View view = random_view(item.random());
        const auto aspect = static_cast<float>(item.random().uniform(0.4, 2.5));
        const std::array<double, 4> v{static_cast<double>(view.fov), static_cast<double>(aspect),
                                      static_cast<double>(view.near), static_cast<double>(view.far)};
        item.near(message("perspective of fov ", view.fov, ", aspect ", aspect, ", near ", view.near, ", far ",
                          view.far, ", as four rows,"),
                  STUDENT(perspective)(view.fov, aspect, view.near, view.far),
                  Mat4(perspective(v[0], v[1], v[2], v[3])), 1e-4, perspective_mistakes(v[0], v[1], v[2], v[3]));
    }
}

LAB_ITEM(10, "perspective: the depth is 0 at near, 1 at far, and grows in between") {
    const Mat4 m = STUDENT(perspective)(1.0f, 1.0f, 0.5f, 20.0f);
    const auto depth = [&m](float distance) {
        const Vec4 clip = m * Vec4(0, 0, -distance, 1);
        return clip.z / clip.w;
    };
    const std::string turned = "It is turned around: 0 at near, 1 at far.";
    item.near("the depth at the near plane", depth(0.5f), 0.0f, 1e-5,
              {{-1, "The depth shall go from 0 to 1. Yours begins at -1, as in OpenGL."}, {1, turned}});
    item.near("the depth at the far plane", depth(20), 1.0f, 1e-5, {{0, turned}});
    item.near("the depth at 1 meter", depth(1), (1 - 0.5f) / (1 - 0.5f / 20), 1e-5,
              {{0.5f / 19.5f, "This grows evenly with the distance. The depth is A + B / w, so that it is even in the "
                              "image."}});
}

LAB_ITEM(15, "to_image: division by w, and pixels from the upper left corner") {
    const auto at = [](Vec4 clip) { return STUDENT(to_image)(clip, 300, 200); };
    const std::string undivided = "x, y and z must be divided by w.";
    item.near("the point in the middle, (0, 0, 1, 2),", at({0, 0, 1, 2}), Vec3{150, 100, 0.5f}, 1e-4,
              {{Vec3{150, 100, 1}, undivided},
               {Vec3{0, 0, 0.5f}, "The middle of the image is (0, 0) in NDC: add 1 and halve."},
               {Vec3{149.5f, 99.5f, 0.5f}, "Half a pixel is missing. The left edge of the image is x = 0 and the right "
                                           "edge is x = width."}});
    item.near("the upper left corner, (-2, 2, 0, 2),", at({-2, 2, 0, 2}), Vec3{0, 0, 0}, 1e-4,
              {{Vec3{0, 200, 0}, "It is upside down: y points up in clip space and down in the image."},
               {Vec3{-150, -100, 0}, undivided},
               {Vec3{300, 0, 0}, "Left and right are exchanged."}});
    item.near("the point (2/3, 2, 3.75, 4), computed by hand on the page,", at({2 / 3.0f, 2, 3.75f, 4}),
              Vec3{175, 50, 0.9375f}, 1e-3,
              {{Vec3{250, -100, 3.75f}, undivided},
               {Vec3{175, 150, 0.9375f}, "It is upside down: y points up in clip space and down in the image."},
               {Vec3{175, 50, 3.75f}, "The depth must be divided by w, too."}});
    for (int i = 0; i < 100; ++i) {
        Rng& rng = item.random();
        const Vec3 xyz(Vec3d(rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(0, 3)));
        const Vec4 clip(xyz, static_cast<float>(rng.uniform(0.5, 4)));
        const int width = rng.integer(1, 2000), height = rng.integer(1, 2000);
        item.near(message("the point ", describe(clip), " in an image of ", width, " × ", height, " pixels"),
                  STUDENT(to_image)(clip, width, height),
                  place(to_double(clip), width, height, static_cast<double>(clip.w)), 5e-2,
                  {{place(to_double(clip), width, height, 1), undivided}});
    }
}

LAB_ITEM(15, "project: from the world to the image") {
    const auto check = [&item](Vec3 p, const View& view, int width, int height) {
        item.near(message("the point ", describe(p), " seen from ", describe(view.eye), " toward ",
                          describe(view.target), " with fov ", view.fov, " in an image of ", width, " × ", height,
                          " pixels"),
                  STUDENT(project)(p, view, width, height), seen(Vec3d(p), view, width, height), 0.02,
                  project_mistakes(p, view, width, height));
    };
    check({1, 2, -4}, {{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, kRightAngle, 1, 5}, 300, 200); // by hand: (175, 50, 0.9375)
    check({1, 0.5f, 0}, kFront, 300, 200);
    check({1, 0.5f, 0}, kFront, 200, 300);
    for (int i = 0; i < 150; ++i) {
        const View view = random_view(item.random());
        const Axes axes = axes_of(view);
        const double w = item.random().uniform(0.5, 8);
        const Vec3 p(Vec3d(view.eye) - axes.back * w + axes.right * (w * item.random().uniform(-0.7, 0.7)) +
                     axes.top * (w * item.random().uniform(-0.7, 0.7)));
        check(p, view, item.random().integer(100, 300), item.random().integer(100, 300));
    }
}

LAB_ITEM(5, "project: nothing at the eye or behind it") {
    const auto check = [&item](const std::string& name, Vec3 p) {
        const auto found = STUDENT(project)(p, kFront, 300, 200);
        const std::string flipped =
            "A point behind the eye has no place in the image. Divided by its negative w it would "
            "appear upside down in front: return nothing where w <= 0.";
        item.require(!found.has_value(), message(name, " was projected to ", describe(found), ". ", flipped));
    };
    check("A point 2 meters behind the eye", {0.5f, 0.5f, 7});
    check("The eye itself", kFront.eye);
    check("A point beside the eye", {1, 0, 5});
    for (int i = 0; i < 100; ++i) {
        const double behind = item.random().uniform(0.1, 9), x = item.random().uniform(-9, 9);
        check("A point behind the eye", Vec3(Vec3d(x, item.random().uniform(-9, 9), 5 + behind)));
    }
}

LAB_ITEM(10, "rays come back: all points of the ray of a pixel are projected to that pixel") {
    for (int i = 0; i < 150; ++i) {
        Rng& rng = item.random();
        const View view = random_view(rng);
        const int width = rng.integer(100, 300), height = rng.integer(100, 300);
        const double x = rng.uniform(0, width), y = rng.uniform(0, height);
        const Axes axes = axes_of(view);
        const double pixel = 2 * std::tan(static_cast<double>(view.fov) / 2) / height; // its side at distance 1
        const Vec3d ray =
            axes.right * ((x - width / 2.0) * pixel) + axes.top * ((height / 2.0 - y) * pixel) - axes.back;
        for (const double t : {0.7, 3.0, 11.0}) {
            const auto found = STUDENT(project)(Vec3(Vec3d(view.eye) + ray * t), view, width, height);
            item.require(found.has_value(), "A point in front of the eye was not projected at all.");
            item.near(message("the point at distance ", t, " on the ray through (", x, ", ", y, ") of an image of ",
                              width, " × ", height, " pixels"),
                      Vec2{found->x, found->y}, Vec2(Vec2d(x, y)), 0.05,
                      {{Vec2(Vec2d(x, height - y)), "It is upside down."},
                       {Vec2(Vec2d(width - x, y)), "Left and right are exchanged."}});
        }
    }
}
