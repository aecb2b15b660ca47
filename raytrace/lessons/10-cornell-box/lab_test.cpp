// The examiner of lab 10. Expected values are computed by hand, by another way in double precision, or by formulas in
// closed form; what depends on chance is judged by means of thousands of paths.
#include "raytrace/lessons/10-cornell-box/lab.h"
#include "tests/grading/judge.h"

#include <array>
#include <cmath>

using namespace duet;
using namespace duet::grading;
using lab::Quad;

LAB_TITLE("raytrace-10", "Light sources, quads, the Cornell box")

namespace {

using T = std::optional<float>;

/// t, a and b by Cramer's rule for origin + t·direction = corner + a·u + b·v: another way than the lesson's.
std::array<double, 3> solve(const Quad& quad, const Ray& ray) {
    const Vec3d u(quad.u), v(quad.v), d(ray.direction), q = Vec3d(ray.origin) - Vec3d(quad.corner);
    const double whole = dot(u, cross(v, -d));
    return {dot(u, cross(v, q)) / whole, dot(q, cross(v, -d)) / whole, dot(u, cross(q, -d)) / whole};
}

/// The mean of many paths along one ray.
Rgb mean_color(const std::vector<Quad>& quads, const Ray& ray, int bounces, int paths) {
    Rgbd sum;
    for (int i = 0; i < paths; ++i) sum += Rgbd(STUDENT(path_color)(quads, ray, bounces, i + 1));
    return Rgb(sum / static_cast<double>(paths));
}

/// A closed room, 2 wide, that looks inward; all its walls are alike.
std::vector<Quad> room(Rgb albedo, Rgb emission) {
    std::vector<Quad> quads;
    const auto wall = [&](Vec3 corner, Vec3 u, Vec3 v) { quads.push_back({corner, u, v, albedo, emission}); };
    wall({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}), wall({-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
    wall({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}), wall({-1, -1, 1}, {0, 2, 0}, {2, 0, 0});
    wall({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}), wall({1, -1, -1}, {0, 0, 2}, {0, 2, 0});
    return quads;
}

/// A floor under a square light of the same size, 1 above it, and the light's fraction of all directions off the middle
/// of the floor, each counted with its cosine.
std::vector<Quad> floor_and_light(Rgb albedo, Rgb emission) {
    return {{{-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, albedo}, {{-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, Rgb(0), emission}};
}
const double kFraction = 4 / kPiDouble / std::sqrt(2.0) * std::atan(1 / std::sqrt(2.0)); // 0.5541

const Ray kDown{{0, 0.5f, 0}, {0, -1, 0}};

} // namespace

LAB_ITEM(0, "the picture") {
    std::vector<Quad> quads = STUDENT(box_of_quads)(Vec3{-0.2f, -1, -0.5f}, Vec3{0.5f, -0.3f, 0.2f}, Rgb(0.7f));
    const Rgb white(0.7f);
    quads.push_back({{-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, white});
    quads.push_back({{-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white});
    quads.push_back({{-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, white});
    quads.push_back({{-1, -1, 1}, {0, 0, -2}, {0, 2, 0}, {0.6f, 0.07f, 0.05f}});
    quads.push_back({{1, -1, -1}, {0, 0, 2}, {0, 2, 0}, {0.05f, 0.2f, 0.55f}});
    quads.push_back({{-0.6f, 0.98f, -0.6f}, {1.2f, 0, 0}, {0, 0, 1.2f}, Rgb(0), Rgb(4, 3.6f, 3)});
    ImageRgb image(48, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) {
            const Ray ray{{0, 0, 4.8f}, Vec3(Vec3d((x - 23.5) / 90, (23.5 - y) / 90, -1))};
            Rgb sum;
            for (int i = 0; i < 8; ++i) sum += STUDENT(path_color)(quads, ray, 10, 1 + i + 8 * (x + 48 * y));
            image(x, y) = sum / 8.0f;
        }
    item.show("your box", image);
}

LAB_ITEM(25, "a ray meets a quad") {
    const Quad square{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
    const auto at = [&](const Quad& quad, float x, float y) {
        return STUDENT(hit_quad)(quad, Ray{{x, y, 3}, {0, 0, -1}});
    };
    const std::string plane =
        "This point of the plane lies outside of the quad: find its a and b, and test that both are from 0 to 1.";
    item.near("t in the middle of a quad, 3 in front of it", at(square, 1, 0.5f), T(3.0f), 1e-5,
              {{T(-3.0f), "t has the wrong sign: t = n·(corner - origin) / (n·direction)."},
               {T(), "The ray goes through the middle of the quad, (a, b) = (0.5, 0.5)."}});
    item.near("a ray that meets the plane at a = -0.1", at(square, -0.2f, 0.5f), T(), 0, {{T(3.0f), plane}});
    item.near("a ray that meets the plane at a = 1.1", at(square, 2.2f, 0.5f), T(), 0, {{T(3.0f), plane}});
    item.near("a ray that meets the plane at b = -0.1", at(square, 1, -0.1f), T(), 0, {{T(3.0f), plane}});
    item.near("a ray that meets the plane at b = 1.1", at(square, 1, 1.1f), T(), 0, {{T(3.0f), plane}});
    const Quad slanted{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}};
    const std::string angles = "u and v are not at right angles here. Lengths along u and v, as by dot(d, u) / dot(u, "
                               "u), are not a and b then: solve d = a·u + b·v.";
    item.near("a ray at a = 0.1, b = 0.9 of a parallelogram", at(slanted, 2, 0.9f), T(3.0f), 1e-5, {{T(), angles}});
    item.near("a ray at a = -0.4, b = 0.9 of a parallelogram", at(slanted, 1, 0.9f), T(), 0, {{T(3.0f), angles}});
    item.near("the quad from behind", STUDENT(hit_quad)(square, Ray{{1, 0.5f, -2}, {0, 0, 4}}), T(0.5f), 1e-5,
              {{T(), "A quad is met from both sides."},
               {T(2.0f), "t counts lengths of the direction, which is 4 long here."}});
    const std::string limits = "Only points with t_min < t < t_max count.";
    item.near("a quad behind the origin", STUDENT(hit_quad)(square, Ray{{1, 0.5f, -2}, {0, 0, -1}}), T(), 0,
              {{T(-2.0f), "This point lies behind the origin. " + limits}});
    item.near("t = 3 with t_max = 2", STUDENT(hit_quad)(square, Ray{{1, 0.5f, 3}, {0, 0, -1}, 0, 2}), T(), 0,
              {{T(3.0f), limits}});
    item.near("t = 3 with t_min = 4", STUDENT(hit_quad)(square, Ray{{1, 0.5f, 3}, {0, 0, -1}, 4}), T(), 0,
              {{T(3.0f), limits}});
    const auto parallel = STUDENT(hit_quad)(square, Ray{{-1, 0.5f, 1}, {1, 0, 0}});
    item.require(!parallel, "A ray that runs parallel to the quad misses it; yours hits. n·direction is 0 there.");
    Rng& rng = item.random();
    const auto vector = [&] { return Vec3(rng.unit_vector() * rng.uniform(0.5, 2)); };
    for (int i = 0; i < 400; ++i) {
        const Quad quad{vector(), vector(), vector()};
        const Vec3d target =
            Vec3d(quad.corner) + Vec3d(quad.u) * rng.uniform(-0.5, 1.5) + Vec3d(quad.v) * rng.uniform(-0.5, 1.5);
        const Vec3 origin = vector();
        const Ray ray{origin, Vec3(target - Vec3d(origin)) * 0.5f};
        const auto [t, a, b] = solve(quad, ray);
        const double slant = std::abs(dot(normalize(cross(quad.u, quad.v)), normalize(ray.direction)));
        const auto close = [](double x) { return std::abs(x) < 2e-3 || std::abs(x - 1) < 2e-3; };
        if (close(a) || close(b) || slant < 0.1 || length(cross(quad.u, quad.v)) < 0.2f) continue; // rounding decides
        const bool inside = a > 0 && a < 1 && b > 0 && b < 1 && t > 0;
        item.near(message("t at a = ", a, ", b = ", b, " of the quad with u = ", describe(quad.u),
                          ", v = ", describe(quad.v)),
                  STUDENT(hit_quad)(quad, ray), inside ? T(static_cast<float>(t)) : T(), 1e-3);
    }
}

LAB_ITEM(20, "a box of six quads that look outward") {
    for (int i = 0; i < 20; ++i) {
        const Vec3d low(item.random().uniform(-2, 2), item.random().uniform(-2, 2), item.random().uniform(-2, 2));
        const Vec3d size(item.random().uniform(0.5, 3), item.random().uniform(0.5, 3), item.random().uniform(0.5, 3));
        const Rgb albedo(0.3f, 0.5f, 0.7f);
        const auto quads = STUDENT(box_of_quads)(Vec3(low), Vec3(low + size), albedo);
        item.require(quads.size() == 6, message("A box has six sides; found ", quads.size(), "."));
        // Each side has its middle half a size from the middle of the box along one axis, and an area of the two
        // others.
        std::array<int, 6> sides{};
        for (const Quad& quad : quads) {
            const Vec3d middle = Vec3d(quad.corner) + (Vec3d(quad.u) + Vec3d(quad.v)) * 0.5 - low - size * 0.5;
            const Vec3d n = cross(Vec3d(quad.u), Vec3d(quad.v));
            bool found = false;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t p = (axis + 1) % 3, q = (axis + 2) % 3;
                if (std::abs(middle[p]) > 1e-4 || std::abs(middle[q]) > 1e-4) continue;
                if (std::abs(std::abs(middle[axis]) - size[axis] / 2) > 1e-4) continue;
                found = true, ++sides[2 * axis + (middle[axis] > 0)];
                const std::string name = message("The side at the ", middle[axis] > 0 ? "high " : "low ", "xyz"[axis]);
                item.require(std::abs(std::abs(n[axis]) - size[p] * size[q]) < 1e-3,
                             name + " doesn't cover the whole side: look at the lengths of u and v.");
                item.require(n[axis] * middle[axis] > 0, name + " looks inward: u × v must point out of the box. Swap "
                                                                "u and v.");
            }
            item.require(found, "The middle of the quad with the corner " + describe(quad.corner) +
                                    ", u = " + describe(quad.u) + ", v = " + describe(quad.v) +
                                    " is not the middle of a side of the box from " + describe(Vec3(low)) + " to " +
                                    describe(Vec3(low + size)) + ".");
            item.near("the albedo of a side", quad.albedo, albedo, 1e-6);
            item.near("the emission of a side", quad.emission, Rgb(0), 0);
        }
        for (const int count : sides)
            item.require(count == 1, "One side is missing and another is there twice: three pairs, low and high.");
    }
}

LAB_ITEM(15, "a quad shines on its front alone") {
    const Rgb light(17, 12, 4);
    const Quad lamp{{-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, Rgb(0), light}; // u × v points down
    item.near("the light of a lamp that looks down, seen from below", STUDENT(emitted)(lamp, Vec3{0, 1, 0}), light,
              1e-4,
              {{Rgb(0), "The lamp is dark on its front: it shines to the side of u × v, so against a ray that comes "
                        "against that normal."}});
    item.near("the same from above", STUDENT(emitted)(lamp, Vec3{0, -1, 0}), Rgb(0), 0,
              {{light, "The lamp shines on its back, too: the front is the side to which u × v points."}});
    item.near("the same from below at a slant, with a long direction", STUDENT(emitted)(lamp, Vec3{4, 3, 0}), light,
              1e-4,
              {{light * 0.6f, "Radiance doesn't depend on the angle: no cosine here."},
               {light * 3.0f, "Radiance doesn't depend on the length of the direction."}});
    for (int i = 0; i < 100; ++i) {
        const Quad quad{Vec3{0, 0, 0}, Vec3(item.random().unit_vector()), Vec3(item.random().unit_vector()), Rgb(0),
                        light};
        const Vec3 d(item.random().unit_vector());
        const double against = dot(cross(Vec3d(quad.u), Vec3d(quad.v)), Vec3d(d));
        if (std::abs(against) < 1e-3) continue;
        item.near("the light of a quad with u = " + describe(quad.u) + ", v = " + describe(quad.v) +
                      " against the direction " + describe(d),
                  STUDENT(emitted)(quad, d), against < 0 ? light : Rgb(0), 1e-4);
    }
}

LAB_ITEM(10, "the nearest of many quads") {
    std::vector<Quad> quads;
    for (const float z : {-3.0f, -1.0f, -2.0f}) quads.push_back({{-1, -1, z}, {2, 0, 0}, {0, 2, 0}});
    const auto hit = STUDENT(closest_hit)(quads, Ray{{0, 0, 0}, {0, 0, -1}});
    item.require(hit.has_value(), "The ray goes through three quads, and your function returned nothing.");
    item.equal("the index of the nearest of three quads", static_cast<int>(hit->index), 1,
               {{0, "This is the first quad of the list, not the nearest."},
                {2, "This is the last quad of the list, not the nearest: shorten the ray at each hit."}});
    item.near("its t", hit->t, 1, 1e-5);
    item.near("its point", hit->p, Vec3{0, 0, -1}, 1e-5);
    item.near("its normal", hit->n, Vec3{0, 0, 1}, 1e-5,
              {{Vec3{0, 0, 4}, "The normal must have length 1: u × v is as long as the quad's area."}});
    item.require(hit->front, "The ray comes against u × v, so it meets the front.");
    const auto back = STUDENT(closest_hit)(quads, Ray{{0, 0, -5}, {0, 0, 1}});
    item.require(back && back->index == 0, "From behind, the quad at z = -3 is the nearest.");
    item.near("the normal from behind", back->n, Vec3{0, 0, -1}, 1e-5,
              {{Vec3{0, 0, 1}, "n is on the side from which the ray came. lesson::make_hit turns it."}});
    item.require(!back->front, "The ray runs along u × v, so it meets the back.");
    item.require(!STUDENT(closest_hit)(quads, Ray{{5, 0, 0}, {0, 0, -1}}), "This ray misses all quads.");
}

LAB_ITEM(15, "light in a room whose walls all shine alike") {
    // Each path, whichever way it goes, brings e·(1 + a + a² + …), one term more with each bounce.
    const Rgb albedo(0.5f, 0.8f, 0.2f), emission(1, 2, 3);
    const auto expected = [&](int bounces, bool stop = false) {
        Rgb sum, weight(1);
        for (int i = 0; i <= bounces; ++i) sum += weight * emission, weight *= stop ? Rgb(0) : albedo;
        return sum;
    };
    const auto found = [&](int bounces, int seed) {
        return STUDENT(path_color)(room(albedo, emission), Ray{{0.1f, 0.2f, 0.3f}, {0.3f, -0.5f, 0.6f}}, bounces, seed);
    };
    item.near("the color with 0 bounces", found(0, 1), emission, 1e-4,
              {{Rgb(0), "With 0 bounces one sees what the first quad itself sends out: the limit is off by one."},
               {emission * albedo, "The light that a quad sends out is not dimmed by its own albedo: only by those of "
                                   "the quads that the path met before."}});
    for (const int bounces : {1, 2, 7})
        for (int seed = 1; seed <= 20; ++seed) {
            Rgb last = emission;
            for (int i = 0; i < bounces; ++i) last *= albedo;
            item.near(message("the color with ", bounces, " bounces"), found(bounces, seed), expected(bounces), 1e-3,
                      {{emission, "The path ends at the first light. A quad that shines reflects light, too: go on."},
                       {last, "Only the last quad's light is there: add the light of each one (+=, not =)."},
                       {expected(bounces - 1), "The limit is off by one: one reflection is missing."},
                       {expected(bounces + 1), "The limit is off by one: there is one reflection too many."},
                       {expected(bounces) * albedo, "The light that a quad sends out is not dimmed by its own albedo."},
                       {emission * (1.0f + static_cast<float>(bounces)), "The albedos are missing."}});
        }
}

LAB_ITEM(15, "direct and indirect light on a floor") {
    const Rgb albedo(0.8f, 0.5f, 0.2f), emission(2, 1, 3);
    const auto both = floor_and_light(albedo, emission);
    const Rgb expected = albedo * emission * static_cast<float>(kFraction);
    // A path meets the light or not: of 4000 the fraction is off by 0.008. Five times that is allowed.
    const double tolerance = 0.04 * 1.6;
    item.near("the floor under a large light, one bounce", mean_color(both, kDown, 1, 4000), expected, tolerance,
              {{Rgb(0), "It is black: is the light found from below, where its front is?"},
               {emission * static_cast<float>(kFraction), "The albedo of the floor is missing."},
               {albedo * emission, "Every path finds the light: do directions depend on chance?"},
               {albedo * emission * static_cast<float>(kFraction * kFraction), "The light is counted too little."}});
    auto turned = both;
    std::swap(turned[1].u, turned[1].v);
    item.near("the floor under a light that shines up", mean_color(turned, kDown, 8, 300), Rgb(0), 0,
              {{expected, "The light shines on its back."}});
    const Rgb a = STUDENT(path_color)(both, kDown, 1, 1);
    bool differs = false;
    for (int seed = 2; seed < 40; ++seed) differs = differs || STUDENT(path_color)(both, kDown, 1, seed) != a;
    item.require(differs, "All seeds give the same path: make the random numbers from the seed.");
    // A white ceiling around the light would add more; here a red wall beside the floor makes the floor red.
    auto walls = both;
    for (Quad& quad : walls) quad.albedo = Rgb(0.8f);
    walls[1].albedo = Rgb(0);
    walls.push_back({{-1, 0, 1}, {0, 0, -2}, {0, 1, 0}, {0.9f, 0.05f, 0.05f}});
    walls.push_back({{1, 0, -1}, {0, 0, 2}, {0, 1, 0}, {0.9f, 0.05f, 0.05f}});
    walls[1].emission = Rgb(1);
    const Rgb bled = mean_color(walls, kDown, 10, 3000), direct = mean_color(walls, kDown, 1, 3000);
    item.require(
        bled.r > direct.r + 0.02f,
        message("Light that comes by way of the walls makes the floor brighter in red than direct light alone. "
                "Found ",
                bled.r, " with 10 bounces, ", direct.r, " with 1."));
    item.require(bled.r > bled.b + 0.02f,
                 message("Red walls make a white floor reddish (color bleeding); found red ", bled.r, ", blue ", bled.b,
                         ". Multiply the weight by the albedo of each quad."));
}
