// The examiner of lab compare-12. Known values are computed by hand; the camera's by tangents in double precision; the
// errors by other sums than the page's.
#include "compare/lessons/12-both-ways/lab.h"
#include "tests/grading/judge.h"

#include <array>
#include <cmath>
#include <string>

using namespace duet;
using namespace duet::grading;
using lab::Camera, lab::Cause, lab::ErrorComponents, lab::Errors, lab::PixelResult;

LAB_TITLE("compare-12", "Both ways")

namespace {

const Camera kPlain{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 90}; // a pixel of an image of height 2 is 1 wide at distance 1

/// A camera that is turned by yaw and pitch; its up leans against the view.
struct Setup {
    Camera camera;
    Vec3d eye, right, up, forward;
    double tangent; ///< of half the angle of view

    explicit Setup(Rng& rng) {
        const double yaw = rng.uniform(-3, 3), pitch = rng.uniform(-0.9, 0.9), fov = rng.uniform(25, 100);
        right = {std::cos(yaw), 0, -std::sin(yaw)};
        up = {std::sin(yaw) * std::sin(pitch), std::cos(pitch), std::cos(yaw) * std::sin(pitch)};
        forward = {-std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)};
        eye = {rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3)};
        camera = {Vec3(eye), Vec3(eye + forward * rng.uniform(0.5, 4)), Vec3(up * 1.5 + forward * rng.uniform(-1, 1)),
                  static_cast<float>(fov)};
        tangent = std::tan(fov * kPiDouble / 360);
    }
    Vec3d point(double across, double upward, double distance) const {
        return eye + (right * across + up * upward + forward) * distance;
    }
};

/// A place in the image as tangents of the angles to the right and upward. `side` is what the angle of view spans.
Vec2d tangents(double x, double y, double width, double height, double tangent, double side) {
    return {(x - width / 2) * 2 / side * tangent, (height / 2 - y) * 2 / side * tangent};
}

double decode(double e) { return e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4); }

ImageRgb random_image(Rng& rng, int width, int height, double low, double high) {
    ImageRgb image(width, height);
    for (Rgb& pixel : image.pixels())
        for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<float>(rng.uniform(low, high));
    return image;
}

/// Errors by a formula for each value: `of` maps encoded values to those that are compared.
template <typename Of> Errors errors_by(const ImageRgb& image, const ImageRgb& reference, const Of& of) {
    Errors sum;
    const double n = 3.0 * static_cast<double>(image.size());
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < image.size(); ++i) {
            const double a = of(image[i][c]), b = of(reference[i][c]);
            sum.mean += (a - b) / n;
            sum.mse += (a * a - 2 * a * b + b * b) / n;
            sum.relmse += (a - b) * (a - b) / (0.01 + b * b) / n;
        }
    return sum;
}

constexpr const char* kDecode = "The encoded values were compared. Decode both images by the sRGB curve first: light "
                                "adds up in linear values.";
constexpr const char* kAlong =
    "It was divided by the distance from the eye. Divide by the distance along the view: else "
    "straight lines become curves.";

void check_errors(Item& item, const std::string& name, const ImageRgb& image, const ImageRgb& reference) {
    const Errors e = errors_by(image, reference, decode);
    const Errors raw = errors_by(image, reference, [](double x) { return x; });
    const Errors power = errors_by(image, reference, [](double x) { return std::pow(x, 2.2); });
    const Errors swapped = errors_by(reference, image, decode);
    const Errors found = STUDENT(errors)(image, reference);
    double absolute = 0;
    for (std::size_t i = 0; i < 3 * image.size(); ++i)
        absolute += std::abs(decode(image[i / 3][i % 3]) - decode(reference[i / 3][i % 3]));
    const double n = 3.0 * static_cast<double>(image.size());
    const char* sums = "It is three times too large: divide by the number of values, three for each pixel.";
    const char* total = "It is the sum. Divide it by the number of values.";
    const char* curve = "The power 2.2 only resembles the sRGB curve. Take the formula of lab.h.";
    item.near(name + ": mse", found.mse, e.mse, 1e-9 + 1e-5 * e.mse,
              {{raw.mse, kDecode},
               {3 * e.mse, sums},
               {n * e.mse, total},
               {power.mse, curve},
               {std::sqrt(e.mse), "This is the root of it. The mean squared error has no root."}});
    item.near(name + ": mean", found.mean, e.mean, 1e-9 + 1e-5 * std::abs(e.mean),
              {{raw.mean, kDecode},
               {3 * e.mean, sums},
               {n * e.mean, total},
               {-e.mean, "The sign is turned around: d is the image minus the reference."},
               {absolute / n, "The signs are lost: the mean of d itself, not of its absolute value."}});
    item.near(
        name + ": relmse", found.relmse, e.relmse, 1e-9 + 1e-5 * e.relmse,
        {{raw.relmse, kDecode},
         {3 * e.relmse, sums},
         {n * e.relmse, total},
         {swapped.relmse, "It was divided by the image's value. The reference stands below the line: b² + 0.01."}});
}

} // namespace

LAB_ITEM(0, "the picture") {
    ImageRgb image(24, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x) image(x, y) = direction_color(STUDENT(pixel_ray)(kPlain, 24, 16, x, y).direction);
    ImageRgb large(240, 160);
    for (int y = 0; y < 160; ++y)
        for (int x = 0; x < 240; ++x) large(x, y) = image(x / 10, y / 10);
    item.show("the directions of your rays: red grows to the right, green upward", large);
}

LAB_ITEM(10, "rays of a camera that looks along -z, by hand") {
    // At the distance 1, an image of height 2 and the angle 90 degrees is 2 high, so a pixel is 1 wide and high.
    const Ray ray = STUDENT(pixel_ray)(kPlain, 4, 2, 3, 0);
    const auto unit = [](double x, double y) { return Vec3(normalize(Vec3d{x, y, -1})); };
    item.near(
        "The direction of pixel (3, 0) of a 4 x 2 image", ray.direction, unit(1.5, 0.5), 1e-5,
        {{unit(1, 1), "The ray passes through the pixel's corner. Its center is half a pixel farther right and down."},
         {unit(2, 0), "The ray passes through the lower right corner of the pixel. Its center is at x + 0.5, y + 0.5."},
         {unit(1.5, -0.5), "It is upside down: row 0 is the top row, and y grows downward."},
         {unit(-1.5, 0.5), "It is mirrored: x grows to the right."},
         {unit(0.75, 0.25), "The angle of view is the vertical one; here it was used for the width."},
         {unit(0.75, 0.5), "Pixels are squares, but these are twice as high as wide: x must be scaled by width / "
                           "height."},
         {{1.5f, 0.5f, -1}, "The direction must have length 1: normalize it."}});
    item.near("The origin", ray.origin, Vec3{0, 0, 0}, 1e-6);
    const Ray middle = STUDENT(pixel_ray)({{1, 2, 3}, {1, 2, -5}, {0, 3, 0}, 40}, 5, 3, 2, 1);
    item.near("The direction of the middle pixel of a 5 x 3 image", middle.direction, Vec3{0, 0, -1}, 1e-5,
              {{{0, 0, 1}, "It points backward: the camera looks from eye to target."}});
    item.near("The origin", middle.origin, Vec3{1, 2, 3}, 1e-6, {{Vec3{0, 0, 0}, "Rays start at the eye."}});
}

LAB_ITEM(15, "rays of cameras anywhere") {
    for (int i = 0; i < 40; ++i) {
        const Setup s(item.random());
        const int width = item.random().integer(3, 40), height = item.random().integer(3, 40);
        const int x = item.random().integer(0, width - 1), y = item.random().integer(0, height - 1);
        const auto direction = [&](double px, double py, double side, double tangent) {
            const Vec2d t = tangents(px, py, width, height, tangent, side);
            return Vec3(normalize(s.point(t.x, t.y, 1) - s.eye));
        };
        const double cx = x + 0.5, cy = y + 0.5;
        const Ray ray = STUDENT(pixel_ray)(s.camera, width, height, x, y);
        item.near("The ray's origin", ray.origin, s.camera.eye, 1e-5);
        item.near(
            "The direction of a ray", ray.direction, direction(cx, cy, height, s.tangent), 1e-4,
            {{direction(x, y, height, s.tangent),
              "It passes through the pixel's corner: the center is half a pixel farther."},
             {direction(cx, height - cy, height, s.tangent), "It is upside down: row 0 is the top row."},
             {direction(width - cx, cy, height, s.tangent), "It is mirrored: the axes are left-handed. right is "
                                                            "cross(forward, up), in this order."},
             {direction(cx, cy, width, s.tangent),
              "The angle of view is the vertical one; here it was used for the width."},
             {direction(cx, cy, height, std::tan(2 * std::atan(s.tangent))),
              "The whole angle of view was taken. From the middle of the image it is half of it to the upper edge."}});
        item.near("t_min", ray.t_min, 0.0f, 0), item.near("t_max", ray.t_max, kInfinity, 0);
    }
}

LAB_ITEM(20, "points of the world in the image") {
    const auto check = [&](const std::string& name, const Camera& camera, int width, int height, Vec3 p, Vec2d expected,
                           double tolerance, const std::vector<Mistake<std::optional<Vec2>>>& more) {
        std::vector<Mistake<std::optional<Vec2>>> mistakes{
            {Vec2(expected - Vec2d(0.5, 0.5)),
             "It is half a pixel off. Coordinates count from the image's corner, so the "
             "center of the first pixel is (0.5, 0.5)."},
            {Vec2(Vec2d{expected.x, height - expected.y}), "It is upside down: y grows downward, from the top edge."},
            {Vec2(Vec2d{width - expected.x, expected.y}),
             "It is mirrored: x grows to the right. right is cross(forward, "
             "up), in this order."},
            {std::nullopt,
             "The point is in front of the eye, so it has a place, even where that is outside of the image."}};
        mistakes.insert(mistakes.end(), more.begin(), more.end());
        item.near(name, STUDENT(project)(camera, width, height, p), Vec2(expected), tolerance, mistakes);
    };
    check("The place of (6, 2, -4) in a 4 x 2 image", kPlain, 4, 2, {6, 2, -4}, {3.5, 0.5}, 1e-5,
          {{Vec2(Vec2d(2 + 3 / std::sqrt(14), 1 - 1 / std::sqrt(14))), kAlong},
           {Vec2{8, -1}, "There is no perspective: divide by the distance along the view."},
           {Vec2{5, 0}, "The angle of view is the vertical one; here it was used for the width."}});
    const auto behind = STUDENT(project)(kPlain, 4, 2, {0.3f, 0.2f, 1});
    item.require(!behind, "The point (0.3, 0.2, 1) is behind a camera that looks along -z. The division by a negative "
                          "distance brings it into the image, turned around. Return nothing.");
    item.require(!STUDENT(project)(kPlain, 4, 2, {0.3f, 0.2f, 0}), "A point beside the eye is not in front of it: the "
                                                                   "division by 0 gives no place. Return nothing.");
    for (int i = 0; i < 40; ++i) {
        const Setup s(item.random());
        const int width = item.random().integer(3, 40), height = item.random().integer(3, 40);
        const double x = item.random().uniform(-10, width + 10), y = item.random().uniform(-10, height + 10);
        const double distance = item.random().uniform(0.5, 20);
        const Vec2d t = tangents(x, y, width, height, s.tangent, height);
        const Vec3d v = Vec3d{t.x, t.y, 1} * distance;
        const double ray = length(v);
        const auto place = [&](double side, double by) {
            return Vec2(
                Vec2d{width / 2.0 + v.x / by / s.tangent * side / 2, height / 2.0 - v.y / by / s.tangent * side / 2});
        };
        check("A point's place", s.camera, width, height, Vec3(s.point(t.x, t.y, distance)), {x, y}, 2e-2,
              {{place(width, distance), "The angle of view is the vertical one; here it was used for the width."},
               {place(height, ray), kAlong}});
    }
}

LAB_ITEM(10, "a point on the ray of a pixel is at that pixel's center") {
    for (int i = 0; i < 60; ++i) {
        const Setup s(item.random());
        const int width = item.random().integer(3, 60), height = item.random().integer(3, 60);
        const int x = item.random().integer(0, width - 1), y = item.random().integer(0, height - 1);
        const Ray ray = STUDENT(pixel_ray)(s.camera, width, height, x, y);
        const Vec3 p = ray.at(static_cast<float>(item.random().uniform(0.5, 10)));
        const auto found = STUDENT(project)(s.camera, width, height, p);
        const Vec2 center{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
        item.near("project(pixel_ray(…).at(t))", found, center, 1e-2,
                  {{center - Vec2(0.5f, 0.5f), "It is half a pixel off: one of your two functions forgets the center."},
                   {center + Vec2(0.5f, 0.5f), "It is half a pixel off: one of your two functions forgets the center."},
                   {Vec2(center.x, static_cast<float>(height) - center.y), "One of your two functions is upside down."},
                   {Vec2(static_cast<float>(width) - center.x, center.y), "One of your two functions is mirrored."}});
    }
}

LAB_ITEM(15, "the errors of an image") {
    // By hand: red instead of blue is d = (1, 0, -1); black instead of white is d = -1 with b = 1.
    check_errors(item, "red instead of blue", ImageRgb(3, 2, Rgb(1, 0, 0)), ImageRgb(3, 2, Rgb(0, 0, 1)));
    check_errors(item, "black instead of white", ImageRgb(3, 2, Rgb(0)), ImageRgb(3, 2, Rgb(1)));
    check_errors(item, "a brighter image", ImageRgb(2, 2, Rgb(0.8f, 0.6f, 0.4f)),
                 ImageRgb(2, 2, Rgb(0.5f, 0.5f, 0.03f)));
    const ImageRgb reference = random_image(item.random(), 12, 7, 0, 1);
    check_errors(item, "random images", random_image(item.random(), 12, 7, 0, 0.8), reference);
    check_errors(item, "equal images", reference, reference);
}

LAB_ITEM(15, "the cause of a difference") {
    const auto check = [&](const std::string& name, const PixelResult& a, const PixelResult& b, Cause expected,
                           const std::vector<Mistake<Cause>>& mistakes) {
        item.equal("The cause (0 kSame, 1 kEdge, 2 kShadow, 3 kLight) where " + name,
                   STUDENT(classify_pixel)(a, b, 0.1f), expected, mistakes);
    };
    const Rgb gray(0.5f), dark(0.2f);
    check("the colors are equal, and the triangles are neighbors", {7, 1, gray}, {8, 1, gray}, Cause::kSame,
          {{Cause::kEdge, "The colors are the same, so nothing has to be explained: ask for the colors first."}});
    check("another triangle is seen", {7, 1, gray}, {8, 1, dark}, Cause::kEdge, {});
    check("another triangle is seen, in shadow", {7, 1, gray}, {8, 0, dark}, Cause::kEdge,
          {{Cause::kShadow, "They see different triangles, so their shadows are not those of one point: ask for the "
                            "triangles before the shadows."}});
    check("only one sees a triangle", {-1, 1, gray}, {3, 1, dark}, Cause::kEdge,
          {{Cause::kLight, "-1 is no triangle: one of the two sees the background, so this is an edge."},
           {Cause::kSame, "-1 is no triangle: one of the two sees the background, so this is an edge."}});
    check("the same triangle is in sun and in shadow", {7, 1, gray}, {7, 0, dark}, Cause::kShadow, {});
    check("the first is in shadow", {7, 0, dark}, {7, 1, gray}, Cause::kShadow,
          {{Cause::kSame, "The difference is negative: compare its absolute value with the tolerance."},
           {Cause::kLight, "The difference is negative: compare its absolute value with the tolerance."}});
    check("triangle and sun are the same", {7, 1, gray}, {7, 1, dark}, Cause::kLight, {});
    check("the first image is darker", {7, 1, dark}, {7, 1, gray}, Cause::kLight,
          {{Cause::kSame, "The difference is negative: compare its absolute value with the tolerance."}});
    check("the sun differs by less than the tolerance", {7, 0.5f, gray}, {7, 0.45f, dark}, Cause::kLight,
          {{Cause::kShadow, "The fractions of the sun's light may differ by the tolerance."}});
    check("only blue differs", {7, 1, {0.5f, 0.5f, 0.8f}}, {7, 1, {0.5f, 0.5f, 0.5f}}, Cause::kLight,
          {{Cause::kSame, "Each channel counts: a difference in blue alone is a difference."}});
    check("red is brighter and green is darker", {7, 1, {0.7f, 0.3f, 0.5f}}, {7, 1, gray}, Cause::kLight,
          {{Cause::kSame, "The channels' differences cancel each other: compare each channel by itself."}});
    check("all differ by less than the tolerance", {7, 1, {0.55f, 0.45f, 0.5f}}, {7, 1, gray}, Cause::kSame,
          {{Cause::kLight, "No channel differs by more than the tolerance."}});
}

LAB_ITEM(15, "bias and noise") {
    const auto check = [&](const std::string& name, const std::vector<ImageRgb>& images, const ImageRgb& reference) {
        ErrorComponents e;
        const double n = static_cast<double>(images.size()), values = 3.0 * static_cast<double>(reference.size());
        double deviation = 0, bias = 0, raw = 0;
        for (std::size_t i = 0; i < reference.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                // All pairs of images: the mean of (a - a')² / 2 is the variance, without the mean of the images.
                double pairs = 0, sum = 0;
                for (std::size_t j = 0; j < images.size(); ++j) {
                    sum += images[j][i][c];
                    for (std::size_t k = 0; k < j; ++k)
                        pairs += sqr(static_cast<double>(images[j][i][c]) - static_cast<double>(images[k][i][c]));
                }
                const double noise = pairs / (n * (n - 1)), off = sum / n - static_cast<double>(reference[i][c]);
                e.noise += noise / values, e.squared_bias += (off * off - noise / n) / values;
                deviation += std::sqrt(noise) / values, bias += off / values, raw += off * off / values;
            }
        const double slack = 1e-9 + 1e-5 * (e.noise + raw);
        const ErrorComponents found = STUDENT(split_error)(images, reference);
        item.near(
            name + ": the noise", found.noise, e.noise, slack,
            {{e.noise * (n - 1) / n, "The squares were divided by n. They are taken about the images' own mean, which "
                                     "lies nearer to them than the true one: divide by n - 1."},
             {e.noise / n, "This is the noise of the mean of all images. Asked for is that of one image."},
             {deviation, "This is the standard deviation. The variance is its square."},
             {e.noise * (n - 1), "This is the sum of the squares: divide by n - 1."},
             {raw + e.noise * (n - 1) / n,
              "The squares were taken about the reference: that counts the bias, too. Take "
              "them about the images' mean."},
             {(raw + e.noise * (n - 1) / n) * n / (n - 1),
              "The squares were taken about the reference: that counts the "
              "bias, too. Take them about the images' mean."}});
        item.near(
            name + ": the squared bias", found.squared_bias, e.squared_bias, slack,
            {{raw, "The mean of n images has noise, too, and its square is never negative. Subtract noise / n."},
             {raw - e.noise, "The whole noise of one image was subtracted. The mean of n images has only noise / n."},
             {bias * bias, "The differences were averaged before they were squared, so biases of opposite signs "
                           "cancel: square the difference of each value."},
             {std::max(e.squared_bias, 0.0),
              "It may be negative: do not cut it off. Else its mean over many tests is too large."},
             {raw + e.noise * (n - 1) / n, "This is the mean squared error of single images, noise and all."}});
    };
    // By hand: values 1 and 3 have the mean 2 and the variance 2; with the reference 5, 9 - 2/2 = 8.
    check("the values 1 and 3, and the reference 5", {ImageRgb(2, 1, Rgb(1)), ImageRgb(2, 1, Rgb(3))},
          ImageRgb(2, 1, Rgb(5)));
    for (const double bias : {0.0, 0.25}) {
        const ImageRgb reference = random_image(item.random(), 8, 6, 0.5, 1);
        std::vector<ImageRgb> images;
        for (int k = 0; k < 5; ++k) {
            images.push_back(random_image(item.random(), 8, 6, -0.4, 0.4));
            for (std::size_t i = 0; i < reference.size(); ++i)
                images.back()[i] += reference[i] + Rgb(static_cast<float>(i % 2 ? bias : -bias));
        }
        check(bias == 0 ? "images without bias" : "images with a bias of opposite signs", images, reference);
    }
}
