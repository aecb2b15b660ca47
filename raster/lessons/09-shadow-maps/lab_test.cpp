// The examiner of raster lab 09. Depths of a floor and of spheres come from formulas, in double; places that rounding
// could move to another texel or to the other side of a depth are not asked about.
#include "raster/lessons/09-shadow-maps/lab.h"
#include "tests/grading/judge.h"
#include "tests/grading/rays.h"

#include <cmath>
#include <functional>
#include <optional>

using namespace duet;
using namespace duet::grading;
using lab::ShadowMap;

LAB_TITLE("raster-09", "Shadow maps")

namespace {

/// The cube of a map: right, up and toward the sun are its axes, all of length 1.
struct Cube {
    Vec3d right, up, to_sun, center;
    double radius;
    Cube(Vec3d sun, Vec3d c, double r) : to_sun(normalize(sun)), center(c), radius(r) {
        right = normalize(cross(std::abs(to_sun.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1), to_sun));
        up = cross(to_sun, right);
    }
    /// x and y in [-1, 1], and the depth.
    Vec3d place(Vec3d p) const {
        const Vec3d d = (p - center) / radius;
        return {dot(d, right), dot(d, up), (1 - dot(d, to_sun)) / 2};
    }
    Vec3d world(Vec3d q) const { return center + (right * q.x + up * q.y + to_sun * (1 - 2 * q.z)) * radius; }
    Mat4 matrix() const {
        Mat4d m;
        const auto row = [this](Vec3d axis, double scale, double constant) {
            return std::array{axis.x * scale, axis.y * scale, axis.z * scale, constant - dot(axis, center) * scale};
        };
        m[0] = row(right, 1 / radius, 0), m[1] = row(up, 1 / radius, 0), m[2] = row(to_sun, -0.5 / radius, 0.5);
        return Mat4(m);
    }
};

ShadowMap draw_map(const Shapes& scene, const Cube& cube, int side) {
    ShadowMap map{cube.matrix(), static_cast<float>(2 * cube.radius), ImageFloat(side, side, kInfinity)};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const Vec3d o = cube.world({2 * (x + 0.5) / side - 1, 1 - 2 * (y + 0.5) / side, 0});
            const auto hit = first_hit(scene, o, -cube.to_sun);
            if (hit && hit->t <= 2 * cube.radius) map.depth(x, y) = static_cast<float>(hit->t / (2 * cube.radius));
        }
    return map;
}

/// How a student may test a point. The right way has nothing set.
struct Way {
    bool flipped = false, rounded = false, cut_off = false, bias_added = false, bias_in_meters = false,
         reversed = false, outside_dark = false, outside_left_out = false, mean_of_depths = false, dark_share = false;
    int more = 0; // texels to the right and below, too many
};
double answer(const ShadowMap& map, const Cube& cube, Vec3d p, double bias, int reach, Way way) {
    const int side = map.depth.width();
    const Vec3d q = cube.place(p);
    const double x = (1 + q.x) / 2 * side, y = (way.flipped ? 1 + q.y : 1 - q.y) / 2 * side;
    const auto whole = [&way](double v) {
        return static_cast<int>(way.rounded ? std::round(v) : way.cut_off ? std::trunc(v) : std::floor(v));
    };
    const double moved = way.bias_in_meters ? bias : bias / map.size, z = way.bias_added ? q.z + moved : q.z - moved;
    double lit = 0, all = 0, sum = 0;
    for (int j = whole(y) - reach; j <= whole(y) + reach + way.more; ++j)
        for (int i = whole(x) - reach; i <= whole(x) + reach + way.more; ++i) {
            const bool outside = i < 0 || j < 0 || i >= side || j >= side;
            if (outside && way.outside_left_out) continue;
            all += 1;
            const double d = outside ? (way.outside_dark ? -1 : 1e9) : static_cast<double>(map.depth(i, j));
            lit += way.reversed ? z > d : z <= d, sum += d;
        }
    if (way.mean_of_depths) return z <= sum / all ? 1 : 0;
    return way.dark_share ? 1 - lit / all : all > 0 ? lit / all : 1;
}

/// Whether rounding could change what the texels around a point say.
bool is_doubtful(const ShadowMap& map, const Cube& cube, Vec3d p, double bias, int reach) {
    const int side = map.depth.width();
    const Vec3d q = cube.place(p);
    const double x = (1 + q.x) / 2 * side, y = (1 - q.y) / 2 * side, z = q.z - bias / map.size;
    if (std::abs(x - std::round(x)) < 2e-4 || std::abs(y - std::round(y)) < 2e-4) return true;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    for (int j = row - reach; j <= row + reach; ++j)
        for (int i = column - reach; i <= column + reach; ++i)
            if (i >= 0 && j >= 0 && i < side && j < side && std::abs(z - static_cast<double>(map.depth(i, j))) < 1e-5)
                return true;
    return false;
}

struct Query {
    Vec3d p;
    double bias;
    int reach;
};
using Named = WrongMethod<Way>;

/// Compares what a student's function says of many points. If one of the typical ways explains all that was found, its
/// text is told.
void judge(Item& item, const std::string& function, const ShadowMap& map, const Cube& cube,
           const std::vector<Query>& queries, const std::vector<float>& found, const std::vector<Named>& ways) {
    const auto at = [&](std::size_t i, Way way) {
        const Query& q = queries[i];
        return static_cast<float>(answer(map, cube, Vec3d(Vec3(q.p)), q.bias, q.reach, way));
    };
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const float expected = at(i, {});
        if (is_near(found[i], expected, 1e-4)) continue;
        const std::string hint = matching_mistake(found, ways, at);
        const Vec3d place = cube.place(queries[i].p);
        const double side = map.depth.width();
        item.near(message(function, " for a point at column ", (1 + place.x) / 2 * side, ", row ",
                          (1 - place.y) / 2 * side, ", depth ", place.z, " of a map with ", side, " texels a side",
                          queries[i].bias > 0 ? message(", bias ", queries[i].bias, " m, cube ", map.size, " m") : "",
                          queries[i].reach > 0 ? message(", reach ", queries[i].reach) : "", ","),
                  found[i], expected, 1e-4, {{found[i], hint}});
        item.require(false, message(function, " is wrong. ", hint));
    }
}

/// Random points in and around the cube, with a bias in meters.
std::vector<Query> random_queries(Rng& rng, const ShadowMap& map, const Cube& cube, int count, double bias, int reach,
                                  double spread) {
    std::vector<Query> queries;
    while (static_cast<int>(queries.size()) < count) {
        const double x = rng.uniform(-spread, spread), y = rng.uniform(-spread, spread), z = rng.uniform(0.05, 0.95);
        const Query q{cube.world({x, y, z}), bias, reach};
        if (!is_doubtful(map, cube, Vec3d(Vec3(q.p)), bias, reach)) queries.push_back(q);
    }
    return queries;
}

/// A map of random depths, so that each wrong texel shows.
ShadowMap random_map(Rng& rng, const Cube& cube, int side) {
    ShadowMap map{cube.matrix(), static_cast<float>(2 * cube.radius), ImageFloat(side, side, kInfinity)};
    for (float& d : map.depth.pixels())
        if (rng.uniform() < 0.9) d = static_cast<float>(rng.uniform(0.05, 0.95));
    return map;
}
Cube random_cube(Rng& rng) {
    const Vec3d sun = rng.unit_vector();
    const double x = rng.uniform(-3, 3), y = rng.uniform(-3, 3);
    return {sun, {x, y, 1}, rng.uniform(0.7, 5)};
}

const Named kFlipped{{.flipped = true},
                     "The rows are upside down: y points up in clip space, but row 0 is the top row."};
const Named kRounded{{.rounded = true},
                     "The nearest whole number is a corner of a texel. The texel that holds the point "
                     "is the next lower one: std::floor."};
const Named kCutOff{{.cut_off = true},
                    "A cast to int rounds toward zero, so points just left of or above the map count as "
                    "inside of it: use std::floor first."};
const Named kBiasAdded{{.bias_added = true},
                       "The bias has the wrong sign: it must move the point toward the sun, to a "
                       "smaller depth. Now it makes more shadow, not less."};
const Named kMeters{{.bias_in_meters = true},
                    "The bias is in meters, but depths go from 0 to 1: divide the bias by the "
                    "size of the cube."};
const Named kReversed{{.reversed = true},
                      "The comparison is turned around: a point is in shadow if its depth is greater."};
const Named kOutside{{.outside_dark = true}, "Points beside the map are dark: what the map doesn't hold must be lit."};

/// A view of the test scene from a camera of its own: points and normals.
struct View {
    Image<Vec3> points, normals;
};
View draw_view(const Shapes& scene, int width, int height, Vec3d eye, Vec3d target, double tangent) {
    View view{{width, height}, {width, height}};
    const Vec3d back = normalize(eye - target), right = normalize(cross(Vec3d(0, 1, 0), back)), up = cross(back, right);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double px = (2 * (x + 0.5) - width) / height * tangent, py = (1 - 2 * (y + 0.5) / height) * tangent;
            const auto hit = first_hit(scene, eye, normalize(right * px + up * py - back));
            if (hit) view.points(x, y) = Vec3(hit->p), view.normals(x, y) = Vec3(hit->n);
        }
    return view;
}
const Shapes kSpheres{
    {{0, 1, 0, 0}}, {{-0.5, 0.45, 0, 0.45}, {0.5, 0.3, 0.35, 0.3}, {0.15, 0.85, -0.5, 0.25}, {-0.05, 0.12, 0.7, 0.12}}};
const Vec3d kEye{0.6, 2.2, 3.4}, kTarget{0, 0.25, 0};

double bias_of(double texel, Vec3d to_sun, Vec3d n, int reach) {
    const double cosine = std::clamp(dot(n, to_sun), 0.1, 1.0);
    return (reach + 0.5) * std::sqrt(2.0) * texel * std::sqrt(1 - cosine * cosine) / cosine;
}

} // namespace

LAB_ITEM(0, "the picture") {
    const Cube cube({0.5, 0.7, 0.4}, {0, 0.3, 0}, 2);
    const View view = draw_view(kSpheres, 240, 160, kEye, kTarget, 0.36);
    const ImageFloat light =
        STUDENT(sunlight)(draw_map(kSpheres, cube, 256), Vec3(cube.to_sun), view.points, view.normals, 1);
    ImageRgb image(240, 160, Rgb(0.2f, 0.35f, 0.6f));
    for (std::size_t i = 0; i < std::min(image.size(), light.size()); ++i)
        if (length(view.normals[i]) > 0) {
            const bool floor = view.points[i].y < 1e-4f;
            image[i] = (floor ? Rgb(0.6f, 0.52f, 0.42f) : Rgb(0.75f, 0.25f, 0.1f)) *
                       (Rgb(1.2f, 1.1f, 0.9f) * light[i] + Rgb(0.12f, 0.16f, 0.25f));
        }
    item.show("your shadows", image);
}

LAB_ITEM(15, "the matrix of the sun: known points") {
    // The sun to the right: x is toward it. The sphere has the center (4, 5, 6) and the radius 2.
    const Mat4 m = STUDENT(sun_matrix)(Vec3{1, 0, 0}, Vec3{4, 5, 6}, 2.0f);
    const Vec4 center = m * Vec4(4, 5, 6, 1), near = m * Vec4(6, 5, 6, 1), far = m * Vec4(2, 5, 6, 1);
    item.near("The w of the center", center.w, 1.0f, 1e-5, {{0.0f, "The last row must stay (0, 0, 0, 1)."}});
    item.near("The x of the center", center.x, 0.0f, 1e-5);
    item.near("The y of the center", center.y, 0.0f, 1e-5);
    item.near(
        "The depth of the point nearest to the sun", near.z, 0.0f, 1e-5,
        {{1.0f, "Near and far are exchanged: to_sun leads toward the sun, and depth 0 is at the sun's side. A camera "
                "looks along -z, so z becomes a depth by a negative factor."},
         {-1.0f, "Depths go from 0 to 1, not from -1 to 1."},
         {-0.5f, "The eye of the sun is at the center: it must be on the sphere, at center + to_sun · radius."}});
    item.near("The depth of the farthest point", far.z, 1.0f, 1e-5,
              {{2.0f, "The range of depths is the diameter, 2 · radius, not the radius."},
               {-1.0f, "A camera looks along -z: z becomes a depth by a negative factor."}});
    item.near("The depth of the center", center.z, 0.5f, 1e-5);
    const float across = length(Vec3{(m * Vec4(4, 7, 6, 1)).x, (m * Vec4(4, 7, 6, 1)).y, 0});
    item.near(
        "The distance from the middle of the map to a point at the sphere's rim", across, 1.0f, 1e-5,
        {{2.0f, "x and y must be divided by the radius."},
         {0.5f, "x and y are divided by the diameter: from -radius to radius they become -1 to 1, so divide by the "
                "radius."}});
}

LAB_ITEM(15, "the matrix of the sun: any direction, also straight up and down") {
    Rng& rng = item.random();
    for (int i = 0; i < 60; ++i) {
        const Vec3d s = i == 0   ? Vec3d(0, 1, 0)
                        : i == 1 ? Vec3d(0, -1, 0)
                        : i == 2 ? Vec3d(0, 0, 1)
                                 : rng.unit_vector();
        const double cx = rng.uniform(-4, 4), cy = rng.uniform(-4, 4), cz = rng.uniform(-4, 4);
        const Vec3d c(cx, cy, cz);
        const double r = rng.uniform(0.5, 8);
        const Mat4d m(STUDENT(sun_matrix)(Vec3(s), Vec3(c), static_cast<float>(r)));
        const std::string where =
            message("for the sun at ", describe(Vec3(s)), ", the center ", describe(Vec3(c)), " and the radius ", r);
        for (const auto& row : m.m)
            for (const double entry : row)
                item.require(std::isfinite(entry),
                             message("The matrix ", where,
                                     " has an entry that is no number. If the sun is straight above, "
                                     "(0, 1, 0) is no use as the up direction: the cross product with it is zero."));
        const auto place = [&m](Vec3d p) {
            const Vec4d q = m * Vec4d(p, 1.0);
            return Vec3d(q.x, q.y, q.z) / q.w;
        };
        const Vec3d away = place(c - s * r);
        item.near(
            "The place of the center " + where, place(c), Vec3d(0, 0, 0.5), 1e-4,
            {{place(c), std::abs(place(c).x) + std::abs(place(c).y) > 0.01
                            ? "The center must come to the middle. Is the product in the wrong order? The view comes "
                              "first, so it stands on the right: scaling · look_at."
                            : ""}});
        item.near("The place of the farthest point " + where, away, Vec3d(0, 0, 1), 1e-4);
        const Vec3d u = normalize(cross(s, std::abs(s.x) < 0.8 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0))), v = cross(s, u);
        const Vec3d a = place(c + u * r), b = place(c + v * r);
        item.near("The depth of a point at the sphere's rim " + where, a.z, 0.5, 1e-4);
        item.near("The distance of a point at the rim from the middle " + where, std::hypot(a.x, a.y), 1.0, 1e-4);
        // u, v and s are right-handed, so seen from the sun v is a quarter turn counter-clockwise from u.
        item.near("The area of the parallelogram of two directions, a quarter turn apart, " + where,
                  a.x * b.y - a.y * b.x, 1.0, 1e-3, {{-1.0, "The map is mirrored: right is cross(up, to_sun)."}});
    }
}

LAB_ITEM(20, "in shadow or not: one texel") {
    Rng& rng = item.random();
    const auto ask = [&](const ShadowMap& map, const Cube& cube, const std::vector<Query>& queries,
                         const std::vector<Named>& ways) {
        std::vector<float> found;
        for (const Query& q : queries)
            found.push_back(STUDENT(in_shadow)(map, Vec3(q.p), static_cast<float>(q.bias)) ? 0 : 1);
        judge(item, "The light (1: lit, 0: in shadow)", map, cube, queries, found, ways);
    };
    for (int i = 0; i < 6; ++i) {
        const Cube cube = random_cube(rng);
        const ShadowMap map = random_map(rng, cube, 12 + i);
        ask(map, cube, random_queries(rng, map, cube, 60, 0, 0, 0.95), {kFlipped, kRounded, kReversed});
        ask(map, cube, random_queries(rng, map, cube, 60, cube.radius * 0.3, 0, 0.95), {kBiasAdded, kMeters});
        ask(map, cube, random_queries(rng, map, cube, 60, 0, 0, 1.15), {kOutside, kCutOff});
    }
}

LAB_ITEM(15, "the bias from the slope") {
    const Vec3 up{0, 1, 0};
    const auto tilted = [](double degrees_) {
        return Vec3(Vec3d(std::sin(radians(degrees_)), std::cos(radians(degrees_)), 0));
    };
    // tan 60° = √3, and half the diagonal of a texel is 0.1 · √2 / 2.
    const double s60 = std::sin(radians(60)), half = std::sqrt(2.0) / 20;
    item.near(
        "The bias at 60 degrees, texel 0.1 m, reach 0,", STUDENT(slope_bias)(0.1f, up, tilted(60), 0),
        static_cast<float>(half * 2 * s60), 1e-5,
        {{static_cast<float>(0.05 * 2 * s60),
          "The center of a texel can be half a diagonal away, not only half a side: the factor √2 is missing."},
         {static_cast<float>(half * 4 * s60),
          "This is made of the whole diagonal: the center is at most half of it away."},
         {static_cast<float>(half * s60), "This is the sine. Depth changes by the tangent: divide by the cosine."},
         {static_cast<float>(half * 0.5), "This is the cosine: a bias that shrinks where the surface is steep."},
         {static_cast<float>(half / (2 * s60)), "This is cosine / sine: turn the fraction around."},
         {static_cast<float>(half * 2), "This is 1 / cosine; the tangent is sine / cosine."}});
    item.near(
        "The bias at 60 degrees, texel 0.1 m, reach 2,", STUDENT(slope_bias)(0.1f, up, tilted(60), 2),
        static_cast<float>(5 * half * 2 * s60), 1e-5,
        {{static_cast<float>(half * 2 * s60), "The reach is ignored: the texels that are tested are farther away."},
         {static_cast<float>(4 * half * 2 * s60), "The half texel is missing: reach + 1/2."}});
    const float steep = STUDENT(slope_bias)(0.1f, up, tilted(89.5), 0);
    item.near(
        "The bias at 89.5 degrees, texel 0.1 m, reach 0,", steep, static_cast<float>(half * std::sqrt(99.0)), 1e-4,
        {{static_cast<float>(half * std::tan(radians(89.5))), "There is no limit: a cosine below 0.1 counts as 0.1."},
         {static_cast<float>(half * 10), "The limit belongs on the cosine, before the sine is computed from it."}});
    item.near("The bias for a surface that is turned away, texel 0.1 m, reach 0,",
              STUDENT(slope_bias)(0.1f, up, tilted(120), 0), static_cast<float>(half * std::sqrt(99.0)), 1e-4,
              {{static_cast<float>(-half * std::tan(radians(60))),
                "A bias must not be negative: keep the cosine above 0.1."}});
    item.near("The bias for a surface that faces the sun", STUDENT(slope_bias)(0.1f, up, up, 3), 0.0f, 1e-6);
    const Vec3 long_normal{0, 1.0000002f, 0};
    item.near(
        "The bias for a normal of length 1.0000002 toward the sun", STUDENT(slope_bias)(0.1f, up, long_normal, 3), 0.0f,
        1e-3,
        {{NAN, "The cosine may be greater than 1 by rounding. Then 1 - cos² is negative, and has no root: keep the "
               "cosine below 1."}});
    for (int i = 0; i < 60; ++i) {
        const Vec3d s = item.random().unit_vector(), n = item.random().unit_vector();
        const double texel = item.random().uniform(1e-3, 1);
        const int reach = item.random().integer(0, 4);
        const double b = bias_of(texel, s, n, reach);
        item.near(message("The bias for n = ", describe(Vec3(n)), ", to_sun = ", describe(Vec3(s)), ", texel ", texel,
                          ", reach ", reach),
                  STUDENT(slope_bias)(static_cast<float>(texel), Vec3(s), Vec3(n), reach), static_cast<float>(b),
                  2e-3 * b + 1e-4);
    }
}

LAB_ITEM(20, "percentage-closer filtering") {
    Rng& rng = item.random();
    const auto ask = [&](const ShadowMap& map, const Cube& cube, const std::vector<Query>& queries,
                         const std::vector<Named>& ways) {
        std::vector<float> found;
        for (const Query& q : queries)
            found.push_back(STUDENT(lit_fraction)(map, Vec3(q.p), static_cast<float>(q.bias), q.reach));
        judge(item, "The lit fraction", map, cube, queries, found, ways);
    };
    for (int i = 0; i < 6; ++i) {
        const Cube cube = random_cube(rng);
        const ShadowMap map = random_map(rng, cube, 16);
        const int reach = i % 3 + 1;
        std::vector<Named> ways{
            {{.mean_of_depths = true},
             "The depths are averaged and then compared. Compare each depth first, then take the mean "
             "of the answers."},
            {{.dark_share = true}, "This is the fraction in shadow: 1 minus what is asked for."},
            {{.more = -1}, "One row and one column are missing: from -reach to +reach, both included."},
            kFlipped,
            kReversed};
        ask(map, cube, random_queries(rng, map, cube, 30, 0, reach, 0.3), ways);
        ask(map, cube, random_queries(rng, map, cube, 30, cube.radius * 0.3, reach, 0.3), {kBiasAdded, kMeters});
        ask(map, cube, random_queries(rng, map, cube, 40, 0, reach, 1.2),
            {kOutside,
             kCutOff,
             {{.outside_left_out = true}, "Texels beside the map are left out: they must count as lit."}});
        ask(map, cube, random_queries(rng, map, cube, 20, 0, 0, 0.9), {kRounded});
    }
}

LAB_ITEM(15, "spheres in the sun: no acne, no missing shadow") {
    for (int i = 0; i < 3; ++i) {
        Rng& rng = item.random();
        const double turn = rng.uniform(0, 6.28), height = rng.uniform(0.4, 1.4);
        const Cube cube({std::cos(turn), height, std::sin(turn)}, {0, 0.3, 0}, 2);
        const int reach = i, width = 72, rows = 48;
        const ShadowMap map = draw_map(kSpheres, cube, 160);
        const View view = draw_view(kSpheres, width, rows, kEye, kTarget, 0.36);
        ImageFloat found = STUDENT(sunlight)(map, Vec3(cube.to_sun), view.points, view.normals, reach);
        item.size(found, width, rows);
        const double texel = map.size / 160.0;
        const auto drawn = [&](const std::function<double(Vec3d, Vec3d, double)>& light) {
            return each_pixel(width, rows, [&](int x, int y) {
                const Vec3d p(view.points(x, y)), n(view.normals(x, y));
                const double cosine = dot(n, cube.to_sun);
                return static_cast<float>(length(n) > 0 && cosine > 0 ? light(p, n, cosine) : 0);
            });
        };
        const auto lit = [&](Vec3d p, double bias, int r) { return answer(map, cube, p, bias, r, {}); };
        const ImageFloat expected =
            drawn([&](Vec3d p, Vec3d n, double c) { return c * lit(p, bias_of(texel, cube.to_sun, n, reach), reach); });
        for (std::size_t k = 0; k < found.size(); ++k) { // where rounding decides, any answer is right
            const Vec3d p(view.points[k]), n(view.normals[k]);
            const bool doubt = is_doubtful(map, cube, p, bias_of(texel, cube.to_sun, n, reach), reach);
            if (length(n) > 0 && (doubt || std::abs(dot(n, cube.to_sun)) < 1e-5)) found[k] = expected[k];
        }
        item.image(
            message("spheres in the sun, reach ", reach, ","), found, expected, 2e-3,
            {{drawn([&](Vec3d p, Vec3d, double c) { return c * lit(p, 0, reach); }),
              "This is shadow acne: the bias is missing."},
             {drawn([&](Vec3d p, Vec3d n, double c) { return c * lit(p, bias_of(texel, cube.to_sun, n, 0), reach); }),
              "There is some acne: the bias must know the reach of the filter."},
             {drawn([&](Vec3d p, Vec3d, double c) { return c * lit(p, 0.4, reach); }),
              "Shadows are missing where things touch (peter-panning): the bias is too large. Is it in meters, and is "
              "the side "
              "of a texel the size of the cube divided by the number of texels?"},
             {drawn([&](Vec3d p, Vec3d n, double) { return lit(p, bias_of(texel, cube.to_sun, n, reach), reach); }),
              "The cosine is missing: slanted light is weaker."},
             {drawn([&](Vec3d, Vec3d, double c) { return c; }), "There are no shadows."}});
    }
}
