// The examiner of raster lab 10. Distances of a floor, a wall and spheres come from formulas, in double; points that
// rounding could move to another pixel or beyond a bound are not asked about. The truth of the images is rays in
// double.
#include "raster/lessons/10-ambient-occlusion/lab.h"
#include "tests/grading/judge.h"
#include "tests/grading/rays.h"

#include <cmath>
#include <optional>

using namespace duet;
using namespace duet::grading;
using lab::DepthImage, lab::Search;

LAB_TITLE("raster-10", "Ambient occlusion")

namespace {

/// A camera with perspective, and what it sees.
struct View {
    Vec3d eye, right, up, back;
    double tangent; // of half the angle of view
    int width, height;
    DepthImage seen;
    Image<Vec3> points, normals;

    View(const Shapes& scene, Vec3d from, Vec3d target, double tangent_, int w, int h)
        : eye(from), back(normalize(from - target)), tangent(tangent_), width(w), height(h), points(w, h),
          normals(w, h) {
        right = normalize(cross(Vec3d(0, 1, 0), back)), up = cross(back, right);
        const double aspect = static_cast<double>(w) / h;
        Mat4d m;
        const auto row = [&](Vec3d axis, double s) {
            return std::array{axis.x * s, axis.y * s, axis.z * s, -dot(axis, eye) * s};
        };
        m[0] = row(right, 1 / (tangent * aspect)), m[1] = row(up, 1 / tangent), m[2] = row(back, -1),
        m[3] = row(back, -1);
        m[2][3] -= 0.1; // a near plane; nobody needs z here
        seen.clip_from_world = Mat4(m), seen.distance = ImageFloat(w, h, kInfinity);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const double px = (2 * (x + 0.5) / w - 1) * aspect * tangent, py = (1 - 2 * (y + 0.5) / h) * tangent;
                const Vec3d d = right * px + up * py - back;
                if (const auto hit = first_hit(scene, eye, normalize(d))) {
                    points(x, y) = Vec3(hit->p), normals(x, y) = Vec3(hit->n);
                    seen.distance(x, y) = static_cast<float>(dot(eye - hit->p, back));
                }
            }
    }
    /// Pixels from the upper left corner, and the distance in front of the eye.
    Vec3d place(Vec3d p) const {
        const Vec3d v = p - eye;
        const double w = -dot(v, back), aspect = static_cast<double>(width) / height;
        return {(1 + dot(v, right) / (w * tangent * aspect)) / 2 * width, (1 - dot(v, up) / (w * tangent)) / 2 * height,
                w};
    }
};

/// How a student may ask the depth buffer. The right way has nothing set.
struct Way {
    bool flipped = false, no_range = false, no_bias = false, in_front = false, outside_hidden = false, clamped = false,
         each_point = false, even_steps = false;
};
bool hidden(const View& view, Vec3d q, double bias, double range, Way way) {
    Vec3d at = view.place(q);
    if (at.z <= 0) return false;
    if (way.flipped) at.y = view.height - at.y;
    int x = static_cast<int>(std::floor(std::clamp(at.x, -1e6, 1e6))),
        y = static_cast<int>(std::floor(std::clamp(at.y, -1e6, 1e6)));
    if (way.clamped) x = std::clamp(x, 0, view.width - 1), y = std::clamp(y, 0, view.height - 1);
    if (x < 0 || y < 0 || x >= view.width || y >= view.height) return way.outside_hidden;
    const double behind = (at.z - static_cast<double>(view.seen.distance(x, y))) * (way.in_front ? -1 : 1);
    return behind > (way.no_bias ? 0 : bias) && (way.no_range || behind < range);
}
bool is_doubtful(const View& view, Vec3d q, double bias, double range) {
    for (const Way way : {Way{}, Way{.flipped = true}}) {
        const Vec3d at = view.place(q);
        const double y0 = way.flipped ? view.height - at.y : at.y;
        if (std::abs(at.z) < 0.02) return true;
        if (std::abs(at.x - std::round(at.x)) < 1e-3 || std::abs(y0 - std::round(y0)) < 1e-3) return true;
        const int x = static_cast<int>(std::floor(std::clamp(at.x, -1e6, 1e6))),
                  y = static_cast<int>(std::floor(std::clamp(y0, -1e6, 1e6)));
        if (x < 0 || y < 0 || x >= view.width || y >= view.height) continue;
        const double behind = at.z - static_cast<double>(view.seen.distance(x, y));
        for (const double bound : {0.0, bias, range})
            if (std::abs(behind - bound) < 2e-5 || std::abs(behind + bound) < 2e-5) return true;
    }
    return false;
}

double fraction(const View& view, Vec3d p, const std::vector<Vec3>& directions, const Search& s, Way way) {
    double blocked = 0;
    for (const Vec3& d : directions) {
        int count = 0;
        for (int k = 1; k <= s.steps; ++k) {
            const double t = static_cast<double>(k) / s.steps, step = way.even_steps ? t : t * t;
            count += hidden(view, p + Vec3d(d) * (static_cast<double>(s.radius) * step), static_cast<double>(s.bias),
                            static_cast<double>(s.range), way);
        }
        blocked += way.each_point ? static_cast<double>(count) / s.steps : count > 0;
    }
    return directions.empty() ? 0 : blocked / static_cast<double>(directions.size());
}

using Named = WrongMethod<Way>;
const Named kFlipped{{.flipped = true},
                     "The rows are upside down: y points up in clip space, but row 0 is the top row."};
const Named kNoRange{{.no_range = true}, "The range is not tested: what is far in front of the point hides it, too."};
const Named kNoBias{{.no_bias = true}, "The bias is not tested: a point must be hidden by more than that."};
const Named kInFront{{.in_front = true},
                     "The sign is turned around: a point is hidden if its w is greater than the pixel's "
                     "distance."};
const Named kOutside{{.outside_hidden = true},
                     "Points outside of the image count as hidden: nothing is known of them, so they "
                     "are free."};
const Named kClamped{{.clamped = true},
                     "Points outside of the image are moved to its border: they must count as free."};
/// A floor, a wall behind it and a few spheres.
Shapes corner() {
    return {{{0, 1, 0, 0}, {0, 0, 1, -1}}, {{-0.4, 0.35, -0.3, 0.35}, {0.45, 0.25, 0.1, 0.25}, {0, 0.12, 0.6, 0.12}}};
}
const Vec3d kEye{0.5, 1.6, 3.2}, kTarget{0, 0.25, -0.2};

/// The truth: cosine-weighted rays of a length, 24 × 24 of Malley's.
double traced(const Shapes& scene, Vec3d p, Vec3d n, double radius) {
    const Vec3d u = normalize(cross(n, std::abs(n.x) < 0.8 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0))), v = cross(n, u);
    int blocked = 0;
    for (int i = 0; i < 576; ++i) {
        const double s = (i % 24 + 0.5) / 24, r = std::sqrt(s), a = 2 * kPiDouble * (i / 24 + 0.5) / 24;
        const auto hit =
            first_hit(scene, p + n * 1e-5, u * (r * std::cos(a)) + v * (r * std::sin(a)) + n * std::sqrt(1 - s));
        blocked += hit && hit->t < radius;
    }
    return blocked / 576.0;
}

} // namespace

LAB_ITEM(0, "the picture") {
    item.limit(10);
    const View view(corner(), kEye, kTarget, 0.3, 240, 160);
    const ImageFloat found = STUDENT(occlusion_image)(view.seen, view.points, view.normals, 12, Search{});
    ImageRgb image(240, 160, Rgb(0.3f, 0.45f, 0.7f));
    for (std::size_t i = 0; i < std::min(image.size(), found.size()); ++i)
        if (length(view.normals[i]) > 0) image[i] = Rgb(0.85f, 0.8f, 0.72f) * (1 - found[i]);
    item.show("your corner", image);
}

LAB_ITEM(20, "directions as dense as their cosine") {
    Rng& rng = item.random();
    for (int i = 0; i < 8; ++i) {
        const std::array<Vec3d, 4> fixed{Vec3d(0, 0, 1), Vec3d(0, 0, -1), Vec3d(0, 1, 0), Vec3d(1, 0, 0)};
        const Vec3d n = i < 4 ? fixed[static_cast<std::size_t>(i)] : rng.unit_vector();
        const std::string where = message(" for n = ", describe(Vec3(n)));
        constexpr int kSide = 32;
        double mean = 0, squares = 0, below = 0;
        Vec3d sum;
        for (int k = 0; k < kSide * kSide; ++k) {
            const Vec2 u(Vec2d((k % kSide + 0.5) / kSide, (k / kSide + 0.5) / kSide));
            const Vec3 found = STUDENT(hemisphere_direction)(Vec3(n), u);
            item.require(is_finite(found), message("A direction", where,
                                                   " is not a number. A cross product with a vector that is "
                                                   "parallel to n is zero."));
            item.near(message("The length of the direction", where, ", u = ", describe(u)), length(found), 1.0f, 1e-4,
                      {{length(found), "The point of the disk at the distance r from its center is lifted to the "
                                       "height √(1 - r²), and all three axes must be unit vectors."}});
            const double c = dot(Vec3d(found), n);
            below += c < -1e-6, mean += c / (kSide * kSide), squares += c * c / (kSide * kSide);
            sum += Vec3d(found) / double{kSide * kSide};
        }
        item.require(below == 0, message(below, " of 1024 directions", where,
                                         " point below the surface: all must be on the side "
                                         "of n. Is the third coordinate along n?"));
        item.near(
            "The mean cosine of the directions with n" + where, mean, 2.0 / 3, 0.006,
            {{mean, std::abs(mean - 0.5) < 0.01
                        ? "It is 1/2 for directions that are all alike. Here they must be denser near "
                          "n: r = √u for the point of the disk, and √(1 - r²) for its height."
                    : std::abs(mean - kPiDouble / 4) < 0.01 ? "The points are too dense in the middle of the disk: r = "
                                                              "√u, not u, spreads them evenly over its area."
                    : std::abs(mean - 2 / kPiDouble) < 0.006
                        ? "The angle θ is uniform: that is neither even nor like the cosine."
                        : ""}});
        item.near("The mean squared cosine of the directions with n" + where, squares, 0.5, 0.006);
        const Vec3d across = sum - n * dot(sum, n);
        item.require(length(across) < 0.02,
                     message("The directions", where, " lean to one side: their mean is ", describe(Vec3(sum)),
                             "; expected 2/3 n. Does the angle go all the way around, 2π?"));
    }
}

LAB_ITEM(20, "a point is hidden, or not") {
    Rng& rng = item.random();
    const View view(corner(), kEye, kTarget, 0.3, 48, 32);
    const auto ask = [&](const std::string& kind, double bias, double range, const std::vector<Named>& ways,
                         const auto& draw) {
        std::vector<Vec3d> points;
        while (points.size() < 120) {
            const Vec3d q{Vec3(draw())}; // as the student gets it
            if (!is_doubtful(view, q, bias, range)) points.push_back(q);
        }
        std::vector<float> found;
        for (const Vec3d& q : points)
            found.push_back(
                STUDENT(is_hidden)(view.seen, Vec3(q), static_cast<float>(bias), static_cast<float>(range)));
        const auto expected = [&](std::size_t k, Way way) {
            return hidden(view, points[k], bias, range, way) ? 1.0f : 0.0f;
        };
        for (std::size_t k = 0; k < points.size(); ++k) {
            const Vec3d at = view.place(points[k]);
            item.near(message("Whether a point ", kind, " is hidden (column ", at.x, ", row ", at.y, ", w ", at.z,
                              ", bias ", bias, ", range ", range, ")"),
                      found[k], expected(k, {}), 0, {{found[k], matching_mistake(found, ways, expected)}});
        }
    };
    ask("in the scene", 0.01, 0.3, {kFlipped, kInFront, kNoRange, kNoBias}, [&] {
        const double x = rng.uniform(-0.8, 0.8), y = rng.uniform(-0.3, 1);
        return Vec3d(x, y, rng.uniform(-1.3, 1));
    });
    ask("close behind a surface", 0.05, 0.3, {kNoBias, kFlipped}, [&] {
        const int px = rng.integer(1, 46), py = rng.integer(1, 30);
        const Vec3d p(view.points(px, py));
        return p + (p - view.eye) * rng.uniform(0.002, 0.03);
    });
    ask("near the borders of the image", 0.01, 1e9, {kOutside, kClamped, kFlipped}, [&] {
        const double x = rng.uniform(-4, 4), y = rng.uniform(-2, 3);
        return Vec3d(x, y, rng.uniform(-2, 1));
    });
    ask("behind the eye", 0.01, 1e9, {kInFront}, [&] {
        const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1);
        return view.eye + view.right * x + view.up * y + view.back * rng.uniform(0.1, 4);
    });
}

LAB_ITEM(20, "the occlusion of a point") {
    Rng& rng = item.random();
    const View view(corner(), kEye, kTarget, 0.3, 96, 64);
    const std::array<Search, 3> searches{Search{1, 0.5f, 0.01f, 0.5f}, {4, 0.4f, 0.01f, 0.3f}, {7, 0.8f, 0.02f, 1e9f}};
    for (const Search& s : searches) {
        std::vector<std::vector<Vec3>> directions;
        std::vector<Vec3> points;
        while (points.size() < 40) {
            const int px = rng.integer(2, 93), py = rng.integer(2, 61);
            const Vec3 p = view.points(px, py), n = view.normals(px, py);
            if (length(n) == 0) continue;
            std::vector<Vec3> list;
            for (int tries = 0; list.size() < 12 && tries < 200; ++tries) {
                const Vec3d d = normalize(rng.unit_vector() + Vec3d(n));
                bool doubt = false;
                for (int k = 1; k <= s.steps; ++k)
                    for (const double t : {static_cast<double>(k) / s.steps, sqr(static_cast<double>(k) / s.steps)})
                        doubt |= is_doubtful(view, Vec3d(p) + Vec3d(Vec3(d)) * (static_cast<double>(s.radius) * t),
                                             static_cast<double>(s.bias), static_cast<double>(s.range));
                if (!doubt) list.push_back(Vec3(d));
            }
            points.push_back(p), directions.push_back(list);
        }
        std::vector<float> found;
        for (std::size_t k = 0; k < points.size(); ++k)
            found.push_back(STUDENT(occlusion)(view.seen, points[k], directions[k], s));
        const auto expected = [&](std::size_t k, Way way) {
            return static_cast<float>(fraction(view, Vec3d(points[k]), directions[k], s, way));
        };
        const std::string hint = matching_mistake<Way>(
            found,
            {{{.each_point = true},
              "Each hidden point counts. A direction must count once, as soon as one of its points is hidden."},
             {{.even_steps = true},
              "The points are at k / steps of the radius. They must be at the square of that, to be closer "
              "together near the surface."},
             kNoRange,
             kNoBias,
             kFlipped},
            expected);
        for (std::size_t k = 0; k < points.size(); ++k)
            item.near(message("The occlusion at ", describe(points[k]), " with ", directions[k].size(), " directions, ",
                              s.steps, " steps, radius ", s.radius, ", bias ", s.bias, ", range ", s.range),
                      found[k], expected(k, {}), 1e-4, {{found[k], hint}});
    }
    item.near("The occlusion without any direction",
              STUDENT(occlusion)(view.seen, Vec3{0, 0, 0}, std::vector<Vec3>{}, Search{}), 0.0f, 0,
              {{NAN, "Nothing is divided by nothing: return 0 where there are no directions."}});
}

LAB_ITEM(15, "the blur") {
    Rng& rng = item.random();
    for (int i = 0; i < 6; ++i) {
        const int width = 9 + i, height = 7 + i % 3, reach = i % 3 + 1;
        const float tolerance = 0.05f;
        ImageFloat values(width, height), distance(width, height);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                values(x, y) = static_cast<float>(rng.uniform());
                distance(x, y) = (i > 1 && x > width / 2 ? 4.0f : 2.0f) + static_cast<float>(rng.uniform(0, 0.04));
                if (i > 3 && y == 0) distance(x, y) = kInfinity; // the sky
            }
        /// mode 0: right; 1: distances ignored; 2: divides by all; 3: one row and column missing; 4: own value left out
        const auto blurred = [&](int mode) {
            return each_pixel(width, height, [&](int x, int y) {
                double sum = 0, count = 0;
                for (int b = y - reach; b <= y + reach - (mode == 3); ++b)
                    for (int a = x - reach; a <= x + reach - (mode == 3); ++a) {
                        const bool own = a == x && b == y;
                        if (a < 0 || b < 0 || a >= width || b >= height || (own && mode == 4)) continue;
                        if (!own && mode != 1 && !(std::abs(distance(a, b) - distance(x, y)) <= tolerance)) continue;
                        sum += static_cast<double>(values(a, b)), count += 1;
                    }
                return static_cast<float>(sum / (mode == 2 ? sqr(2 * reach + 1) : std::max(count, 1.0)));
            });
        };
        const ImageFloat found = STUDENT(blur)(values, distance, reach, tolerance);
        item.size(found, width, height);
        for (const float value : found)
            item.require(!std::isnan(value), "A pixel is not a number. Infinity minus infinity is none, so the sky "
                                             "differs from itself: a pixel must always count itself.");
        item.image(message("the blur, reach ", reach), found, blurred(0), 1e-4,
                   {{blurred(1), "The distances are ignored: pixels of another surface must be left out."},
                    {blurred(2),
                     "The sum is divided by (2 reach + 1)² always: divide by the number of pixels that were added."},
                    {blurred(3), "One row and one column are missing: from -reach to +reach, both included."},
                    {blurred(4), "The pixel itself must be one of those in the mean."}});
    }
}

LAB_ITEM(25, "images: a floor alone, a corner, and no halos") {
    item.limit(10);
    const auto ask = [&](const View& view, const Search& s, int count) {
        const ImageFloat found = STUDENT(occlusion_image)(view.seen, view.points, view.normals, count, s);
        item.size(found, view.width, view.height);
        for (const float o : found.pixels())
            item.require(o >= 0 && o <= 1, message("An occlusion is ", o, "; it must be from 0 to 1."));
        return found;
    };
    const Search search{4, 0.4f, 0.02f, 0.4f};
    // A floor alone hides nothing of its sky. Seen at these angles, a bias of 2 cm is enough.
    const View floor({{{0, 1, 0, 0}}, {}}, {0, 2.2, 2.2}, {0, 0, 0}, 0.3, 72, 48);
    const ImageFloat none = ask(floor, search, 8);
    double dark = 0;
    for (const float o : none.pixels()) dark += static_cast<double>(o) / static_cast<double>(none.size());
    item.require(dark < 0.005, message("A floor alone has the mean occlusion ", dark,
                                       "; expected 0. Do the directions point into the "
                                       "floor, or is the bias forgotten?"));
    // Against rays, over pixels whose surroundings are in the image.
    const View view(corner(), kEye, kTarget, 0.3, 96, 64);
    const ImageFloat found = ask(view, search, 24);
    double error = 0, mean = 0, truth_mean = 0, halo = 0;
    int pixels = 0, behind = 0;
    ImageFloat expected_image(96, 64), found_image(96, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) {
            const Vec3d p(view.points(x, y)), n(view.normals(x, y));
            if (length(n) == 0) continue;
            const double truth = traced(corner(), p, n, 0.4), o = static_cast<double>(found(x, y));
            expected_image(x, y) = static_cast<float>(1 - truth), found_image(x, y) = static_cast<float>(1 - o);
            if (x < 8 || y < 8 || x >= 88 || y >= 56) continue;
            error += sqr(o - truth), mean += o, truth_mean += truth, ++pixels;
            if (n.z > 0.9 && p.y > 0.45 && truth < 0.01) halo += o, ++behind;
        }
    item.show("the truth by rays", expected_image);
    item.show("yours", found_image);
    mean /= pixels, truth_mean /= pixels, halo /= std::max(behind, 1), error = std::sqrt(error / pixels);
    item.require(behind == 0 || halo < 0.03,
                 message("The wall behind the spheres, where nothing is near it, has the mean occlusion ", halo,
                         "; expected 0. These are halos: is the range passed on?"));
    const std::string what = message("The mean occlusion of the corner is ", mean, ", by rays ", truth_mean,
                                     ", and the error is ", error, " (root mean square; expected below 0.11). ");
    item.require(mean > 0.35 * truth_mean,
                 what + "Far too little is hidden. Do you take `count` directions at each pixel, about its own "
                        "normal?");
    item.require(error < 0.11, what + "Do the directions lie about each pixel's own normal?");
    // One direction a pixel: if all pixels take the same one, whole regions are equally wrong.
    const ImageFloat sparse = ask(view, search, 2);
    double differs = 0;
    for (int y = 8; y + 4 < 56; y += 4)
        for (int x = 8; x + 4 < 88; x += 4) {
            double block = 0, exact = 0;
            for (int k = 0; k < 16; ++k) {
                block += static_cast<double>(sparse(x + k % 4, y + k / 4)) / 16;
                exact += static_cast<double>(found(x + k % 4, y + k / 4)) / 16;
            }
            differs += sqr(block - exact);
        }
    differs = std::sqrt(differs / (12 * 20));
    item.require(differs < 0.06,
                 message("With 2 directions a pixel, blocks of 4 × 4 pixels differ from those with 24 directions by ",
                         differs,
                         " (root mean square; expected below 0.06). Neighboring pixels must take different "
                         "directions, or there are bands."));
}
