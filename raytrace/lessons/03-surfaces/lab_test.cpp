// The examiner of lab 03. The nearest hit is found here from a list of all distances that is sorted afterwards.
#include "raytrace/lessons/03-surfaces/lab.h"
#include "tests/grading/judge.h"

#include <algorithm>

using namespace duet;
using namespace duet::grading;
using lab::Hit;
using lab::Sphere;

LAB_TITLE("raytrace-03", "The nearest surface")

namespace {

const Ray kAhead{{0, 0, 0}, {0, 0, -1}};
const std::vector<Sphere> kRow{{{0, 0, -9}, 1}, {{0, 0, -3}, 1}, {{0, 0, -6}, 1}}; // the second is the nearest

/// The sphere at each distance at which the ray meets one, from the nearest on.
std::vector<std::pair<float, int>> all_hits(const std::vector<Sphere>& spheres, const Ray& ray) {
    std::vector<std::pair<float, int>> hits;
    for (std::size_t i = 0; i < spheres.size(); ++i)
        if (const auto t = lesson::hit_sphere(spheres[i], ray)) hits.emplace_back(*t, static_cast<int>(i));
    std::sort(hits.begin(), hits.end());
    return hits;
}

/// Spheres around the origin, which lies outside of all of them, or inside the first where `around`.
std::vector<Sphere> random_spheres(Rng& rng, int count, bool around = false) {
    std::vector<Sphere> spheres;
    if (around) spheres.push_back({Vec3(rng.unit_vector() * rng.uniform(0, 2)), static_cast<float>(rng.uniform(3, 6))});
    for (int i = 0; i < count; ++i)
        spheres.push_back({Vec3(rng.unit_vector() * rng.uniform(2, 8)), static_cast<float>(rng.uniform(0.2, 1.8))});
    return spheres;
}

} // namespace

LAB_ITEM(0, "the picture") {
    ImageRgb image(96, 64, Rgb(0.6f, 0.8f, 1));
    const std::vector<Sphere> spheres{
        {{0.5f, -0.1f, -1.2f}, 0.4f}, {{0, 0, -2}, 0.6f}, {{-0.8f, 0, -1.7f}, 0.4f}, {{0, -100.5f, -1}, 100}};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) {
            const Ray ray{{0, 0, 0}, Vec3(Vec3d((x - 47.5) / 36, (31.5 - y) / 36, -1))};
            if (const auto hit = STUDENT(closest_hit)(spheres, ray)) image(x, y) = direction_color(hit->n);
        }
    item.show("your scene", image);
}

LAB_ITEM(20, "a hit from outside and from inside") {
    const Hit outside = STUDENT(make_hit)(kAhead, 2.0f, Vec3{0, 0, 1}, 7);
    item.near("t", outside.t, 2.0f, 0);
    item.near("the point", outside.p, Vec3{0, 0, -2}, 1e-6,
              {{Vec3{0, 0, -1}, "The direction must be multiplied by t."}});
    item.near("the normal from outside", outside.n, Vec3{0, 0, 1}, 1e-6,
              {{Vec3{0, 0, -1}, "From outside the outward normal already runs against the ray: don't turn it."}});
    item.equal("`front` from outside", outside.front, true);
    item.equal("the index", outside.index, 7);
    const Hit inside = STUDENT(make_hit)(kAhead, 2.0f, Vec3{0, 0, -1}, 0);
    item.equal("`front` from inside", inside.front, false,
               {{true, "The ray runs along the outward normal, so it comes from inside."}});
    item.near("the normal from inside", inside.n, Vec3{0, 0, 1}, 1e-6,
              {{Vec3{0, 0, -1}, "It points outward: from inside it must be turned, so that it runs against the ray."}});
}

LAB_ITEM(20, "the nearest of three spheres in a row") {
    const auto hit = STUDENT(closest_hit)(kRow, kAhead);
    item.require(hit.has_value(),
                 "The ray passes through the centers of all three spheres; your function returned nothing.");
    item.near("the distance of the nearest", hit->t, 2.0f, 1e-5,
              {{8.0f, "This is the first sphere of the list. Try all of them, and keep the nearest."},
               {5.0f, "This is the last sphere of the list. Each hit must shorten the ray (t_max), or be compared with "
                      "the best so far."}});
    item.equal("the index of the nearest", hit->index, 1, {{0, "The index must be that of the sphere that was hit."}});
    item.near("the normal", hit->n, Vec3{0, 0, 1}, 1e-5,
              {{Vec3{0, 0, -1}, "It points along the ray: turn it against the ray, in make_hit alone."},
               {Vec3{0, 0, 7}, "The normal was computed with the center of another sphere."},
               {Vec3{0, 0, 4}, "The normal was computed with the center of another sphere."}});
}

LAB_ITEM(15, "the order of the list doesn't matter") {
    for (int i = 0; i < 150; ++i) {
        auto spheres = random_spheres(item.random(), 8);
        const Ray ray{{0, 0, 0}, Vec3(item.random().unit_vector())};
        const auto first = STUDENT(closest_hit)(spheres, ray);
        std::reverse(spheres.begin(), spheres.end());
        const auto second = STUDENT(closest_hit)(spheres, ray);
        item.require(
            first.has_value() == second.has_value() && (!first || first->t == second->t),
            "The reversed list gives another hit: a later hit replaces a nearer one, or the search ends too early.");
    }
}

LAB_ITEM(20, "random scenes: distance, point, normal and index") {
    for (int i = 0; i < 300; ++i) {
        const auto spheres = random_spheres(item.random(), 12, i % 3 == 0);
        const Ray ray{{0, 0, 0}, Vec3(item.random().unit_vector() * item.random().uniform(0.5, 2))};
        const auto hits = all_hits(spheres, ray);
        const auto found = STUDENT(closest_hit)(spheres, ray);
        item.require(found.has_value() == !hits.empty(), hits.empty() ? "A ray that misses all spheres got a hit."
                                                                      : "A ray that hits a sphere got nothing.");
        if (hits.empty()) continue;
        const Sphere& sphere = spheres[static_cast<std::size_t>(hits[0].second)];
        const Vec3 outward = (ray.at(hits[0].first) - sphere.center) / sphere.radius;
        std::vector<Mistake<float>> farther; // other spheres that this ray meets
        for (std::size_t k = 1; k < hits.size(); ++k)
            farther.push_back({hits[k].first, "A sphere is hit there, but another one stands before it."});
        item.near("the distance", found->t, hits[0].first, 1e-5, farther);
        item.equal("the index", found->index, hits[0].second);
        item.near("the point", found->p, ray.at(hits[0].first), 1e-4);
        item.equal("`front`", found->front, dot(ray.direction, outward) < 0,
                   {{true, "This ray starts inside of the sphere that it meets."}});
        item.near("the normal", found->n, dot(ray.direction, outward) < 0 ? outward : -outward, 1e-4,
                  {{dot(ray.direction, outward) < 0 ? -outward : outward, "It must be turned against the ray."},
                   {outward * sphere.radius, "Its length is the radius: divide by it."},
                   {-outward * sphere.radius, "Its length is the radius: divide by it."}});
    }
}

LAB_ITEM(10, "limits of the ray, and no spheres") {
    item.require(!STUDENT(closest_hit)(std::vector<Sphere>{}, kAhead), "Without spheres there is no hit.");
    Ray limited = kAhead;
    limited.t_min = 4.5f;
    const auto later = STUDENT(closest_hit)(kRow, limited);
    item.require(later.has_value(), "With t_min = 4.5 the ray still meets the sphere at t = 5.");
    item.near("the distance with t_min = 4.5", later->t, 5.0f, 1e-5,
              {{2.0f, "t = 2 is before t_min: pass the ray's limits on to hit_sphere."}});
    limited = kAhead;
    limited.t_max = 1.5f;
    item.require(!STUDENT(closest_hit)(kRow, limited),
                 "With t_max = 1.5 nothing is hit: start from the ray's own t_max, not from infinity.");
}

LAB_ITEM(15, "any hit, for shadows") {
    item.require(STUDENT(any_hit)(kRow, kAhead), "Three spheres stand in the way; your function says that none does.");
    item.require(!STUDENT(any_hit)(kRow, Ray{{0, 0, 0}, {0, 1, 0}}), "Nothing stands in the way upward.");
    Ray limited = kAhead;
    limited.t_max = 1.5f;
    item.require(!STUDENT(any_hit)(kRow, limited),
                 "All spheres lie beyond t_max = 1.5: a lamp at that distance isn't hidden by what stands behind it.");
    for (int i = 0; i < 100; ++i) {
        const auto spheres = random_spheres(item.random(), 6);
        const Ray ray{{0, 0, 0}, Vec3(item.random().unit_vector())};
        item.equal(
            "whether anything is hit", STUDENT(any_hit)(spheres, ray), !all_hits(spheres, ray).empty(),
            {{false, "This ray meets a sphere further down the list: a miss must not end the search, only a hit."},
             {true, "This ray passes by all spheres."}});
    }
}
