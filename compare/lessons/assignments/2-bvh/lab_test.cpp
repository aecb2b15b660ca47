// The examiner of assignment 2. The truth is every triangle tested for every ray; the measure of quality is the cost of
// the surface area heuristic, which is a number and not a time; the time budget is a ratio to the processor time of the
// examiner's own tree.
#include "compare/lessons/assignments/2-bvh/reference_tree.h"
#include "tests/grading/judge.h"

#include <algorithm>
#include <cmath>
#include <ctime>

using namespace duet;
using namespace duet::grading;
using lab::TriangleHit;

LAB_TITLE("assignment-2", "A hierarchy by the surface area heuristic")

namespace {

bool holds(const Box& outer, const Box& inner) {
    // Rounding is allowed for: a millionth of the larger coordinates.
    const float slack = 2e-6f * (1 + max_component(max(abs(outer.low), abs(outer.high))));
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(outer.low[axis] <= inner.low[axis] + slack && outer.high[axis] >= inner.high[axis] - slack)) return false;
    return true;
}

/// A torus knot: a tube around a curve that is wound about a torus. 2 · around · along triangles.
std::vector<Triangle> knot(int along, int around) {
    const auto curve = [](double s) {
        return Vec3d((2 + std::cos(3 * s)) * std::cos(2 * s), std::sin(3 * s), (2 + std::cos(3 * s)) * std::sin(2 * s));
    };
    const auto point = [&](int i, int j) {
        const double s = 2 * kPiDouble * i / along, a = 2 * kPiDouble * j / around;
        const Vec3d tangent = normalize(curve(s + 1e-3) - curve(s - 1e-3));
        const Vec3d side = normalize(cross(tangent, Vec3d(0.3, 1, 0.2))), up = cross(side, tangent);
        return Vec3(curve(s) + (side * std::cos(a) + up * std::sin(a)) * 0.45);
    };
    std::vector<Triangle> triangles;
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
            triangles.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
            triangles.push_back({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
        }
    return triangles;
}

/// Triangles of all sizes, scattered.
std::vector<Triangle> soup(Rng& rng, int count) {
    std::vector<Triangle> triangles;
    for (int i = 0; i < count; ++i) {
        const Vec3 p = Vec3(Vec3d(rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3)));
        const float size = static_cast<float>(std::pow(10, rng.uniform(-2, 0)));
        triangles.push_back({p, p + Vec3(rng.unit_vector()) * size, p + Vec3(rng.unit_vector()) * size});
    }
    return triangles;
}

std::vector<Ray> random_rays(Rng& rng, int count) {
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        const Vec3 target = Vec3(Vec3d(rng.uniform(-3, 3), rng.uniform(-1.5, 1.5), rng.uniform(-3, 3)));
        const Vec3 origin = Vec3(rng.unit_vector()) * static_cast<float>(rng.uniform(0, 6));
        rays.push_back({origin, normalize(target - origin)});
    }
    for (int i = 0; i < count / 10; ++i) { // along an axis
        Vec3 direction;
        direction[static_cast<std::size_t>(rng.integer(0, 2))] = rng.uniform() < 0.5 ? -1.0f : 1.0f;
        rays.push_back({Vec3(rng.unit_vector()) * 1.5f - direction * 6.0f, direction});
    }
    return rays;
}

TriangleHit nearest(const std::vector<Triangle>& triangles, Ray ray) {
    TriangleHit found;
    for (std::size_t i = 0; i < triangles.size(); ++i)
        if (const auto t = lab::hit_triangle(triangles[i], ray)) ray.t_max = *t, found = {static_cast<int>(i), *t};
    return found;
}

/// Fails the item unless the tree is one: each node reached once, each triangle in one leaf, boxes that hold all below.
void require_valid(Item& item, const Tree& tree, const std::vector<Triangle>& triangles) {
    const auto nodes = static_cast<int>(tree.nodes.size()), count = static_cast<int>(triangles.size());
    item.require(nodes > 0, "The tree has no nodes though there are triangles.");
    item.require(
        static_cast<int>(tree.order.size()) == count,
        message("`order` must name each triangle once: expected ", count, " entries, found ", tree.order.size(), "."));
    std::vector<int> seen_nodes(tree.nodes.size(), 0), seen(triangles.size(), 0), stack{0};
    while (!stack.empty()) {
        const int index = stack.back();
        stack.pop_back();
        item.require(++seen_nodes[static_cast<std::size_t>(index)] == 1, message("Node ", index, " is reached twice."));
        const Node& node = tree.nodes[static_cast<std::size_t>(index)];
        if (node.count == 0) {
            for (const int child : {node.left, node.right}) {
                item.require(child > 0 && child < nodes,
                             message("Node ", index, " has the child ", child, ": expected 1 to ", nodes - 1,
                                     ". A leaf must have count > 0."));
                item.require(holds(node.box, tree.nodes[static_cast<std::size_t>(child)].box),
                             message("The box of node ", index, " doesn't hold that of its child ", child,
                                     ": compute it from all triangles below the node."));
                stack.push_back(child);
            }
            continue;
        }
        item.require(node.first >= 0 && node.count > 0 && node.first <= count - node.count,
                     message("Leaf ", index, " names the entries ", node.first, " to ", node.first + node.count - 1,
                             " of `order`, which has ", count, "."));
        for (int i = node.first; i < node.first + node.count; ++i) {
            const int id = tree.order[static_cast<std::size_t>(i)];
            item.require(id >= 0 && id < count, message("`order` names a triangle ", id, "; there are ", count, "."));
            ++seen[static_cast<std::size_t>(id)];
            item.require(holds(node.box, box(triangles[static_cast<std::size_t>(id)])),
                         message("The box of leaf ", index, " doesn't hold its triangle ", id, "."));
        }
    }
    const auto lost = std::count(seen.begin(), seen.end(), 0);
    item.require(lost == 0,
                 message(lost, " of ", count, " triangles are in no leaf: is the border of a split off by one?"));
    item.require(std::count(seen.begin(), seen.end(), 1) == count, "Some triangles are in several leaves.");
}

void require_hit(Item& item, const TriangleHit& found, const std::vector<Triangle>& triangles, const Ray& ray,
                 const std::string& where) {
    const TriangleHit truth = nearest(triangles, ray);
    item.require(truth.triangle >= 0 || found.triangle < 0,
                 message(where, "it hits nothing, but you found triangle ", found.triangle, "."));
    item.require(
        truth.triangle < 0 || found.triangle >= 0,
        message(where, "it hits triangle ", truth.triangle, " at t = ", truth.t,
                ", but you found nothing. Does hit_box lose boxes that are flat or that the ray only grazes?"));
    item.require(!(found.t > truth.t), message(where, "the nearest hit is at t = ", truth.t, ", but you found one at ",
                                               found.t, ": compare all hits, and shorten the ray (t_max) at each."));
    item.require(found.t == truth.t,
                 message(where, "there is nothing at t = ", found.t, "; the nearest hit is at ", truth.t, "."));
    if (truth.triangle < 0) return;
    const auto id = static_cast<std::size_t>(found.triangle);
    item.require(id < triangles.size() && lab::hit_triangle(triangles[id], ray) == found.t,
                 message(where, "t = ", found.t, " is right, but triangle ", found.triangle, " isn't there; triangle ",
                         truth.triangle, " is. Did you return the place in `order` instead of what stands there?"));
}
void require_hits(Item& item, const std::vector<TriangleHit>& found, const std::vector<Triangle>& triangles,
                  const std::vector<Ray>& rays, std::size_t step = 1) {
    item.require(found.size() == rays.size(),
                 message("One hit is expected for each ray: expected ", rays.size(), ", found ", found.size(), "."));
    for (std::size_t r = 0; r < rays.size(); r += step)
        require_hit(item, found[r], triangles, rays[r],
                    message("Ray ", r, " of ", rays.size(), " (direction ", rays[r].direction.x, ", ",
                            rays[r].direction.y, ", ", rays[r].direction.z, "): "));
}

} // namespace

LAB_ITEM(10, "boxes and their areas") {
    const Box found = STUDENT(box_of)(Triangle{{1, 5, -2}, {3, -1, 0}, {2, 2, 4}});
    item.near("the low corner", found.low, Vec3(1, -1, -2), 0.0f,
              {{Vec3(1, 5, -2), "This is the first corner of the triangle."}});
    item.near("the high corner", found.high, Vec3(3, 5, 4), 0.0f);
    const Box box{{0, 0, 0}, {1, 2, 3}};
    item.near("the area of a box of 1 × 2 × 3", STUDENT(surface_area)(box), 22.0f, 1e-5f,
              {{11.0f, "Each side has a twin across: the factor 2 is missing."}, {6.0f, "This is the volume."}});
    item.near("the area of a flat box", STUDENT(surface_area)(Box{{0, 1, 0}, {4, 1, 5}}), 40.0f, 1e-5f);
}

LAB_ITEM(15, "rays and boxes") {
    const Box box{{-1, -1, -1}, {1, 1, 1}};
    const auto hits = [&](Vec3 origin, Vec3 direction, float t_max = kInfinity) {
        return STUDENT(hit_box)(box, Ray{origin, direction, 0, t_max});
    };
    item.require(hits({-5, -5, -5}, {1, 1, 1}), "A ray along the diagonal must hit.");
    item.require(hits({5, 5, 5}, {-1, -1, -1}),
                 "A ray in negative direction along the diagonal must hit: near and far are exchanged there.");
    item.require(
        hits({-5, 0.2f, 0.3f}, {1, 0, 0}) && hits({0.2f, 0.3f, 5}, {0, 0, -1}),
        "A ray along an axis through the middle of the box must hit it; yours misses. Where a component of the "
        "direction is 0 the ray stays between two planes or outside them.");
    item.require(hits({0, 0, 0}, {0.6f, 0, 0.8f}), "A ray that starts inside the box must hit.");
    item.require(!hits({0, 0, 5}, {0, 0, 1}), "The box lies behind the origin (t < t_min): this is no hit.");
    item.require(!hits({0, 2, 5}, {0, 0, -1}), "A ray along -z that passes above the box must miss.");
    item.require(!hits({-5, 0, 0}, {1, 1, 0}),
                 "A ray that leaves the slab of one axis before it enters another's must miss.");
    item.require(!hits({0, 0, 5}, {0, 0, -1}, 3), "The box begins at t = 4, behind t_max = 3: this is no hit.");
    item.require(STUDENT(hit_box)(Box{{-1, 0, -1}, {1, 0, 1}}, Ray{{0, 3, 0}, {0, -1, 0}}),
                 "A flat box (a floor) can be hit. The ray enters and leaves it at the same t: compare with <=.");
    for (int i = 0; i < 300; ++i) { // a ray that is aimed at a point of the box hits
        Rng& rng = item.random();
        const Vec3 low(Vec3d(rng.uniform(-2, 0), rng.uniform(-2, 0), rng.uniform(-2, 0))),
            high(Vec3d(rng.uniform(0.1, 2), rng.uniform(0.1, 2), rng.uniform(0.1, 2)));
        const Vec3 inside =
            low + (high - low) * Vec3(Vec3d(rng.uniform(0.01, 0.99), rng.uniform(0.01, 0.99), rng.uniform(0.01, 0.99)));
        const Vec3 origin = Vec3(rng.unit_vector()) * 5.0f;
        item.require(STUDENT(hit_box)(Box{low, high}, Ray{origin, inside - origin}),
                     "A ray aimed at a point inside a box misses it.");
        item.require(!STUDENT(hit_box)(Box{low, high}, Ray{origin, origin - inside}),
                     "A ray that runs away from a box hits it.");
    }
}

LAB_ITEM(15, "the tree holds every triangle once, and boxes hold what is below them") {
    for (const int count : {1, 2, 3, 17, 2000}) {
        const auto triangles = soup(item.random(), count);
        require_valid(item, STUDENT(build)(triangles), triangles);
    }
    item.require(STUDENT(build)(std::vector<Triangle>{}).nodes.empty(), "Without triangles there are no nodes.");
    // A thousand triangles with one center can't be told apart by it: a tree of borders between centers must still end.
    const std::vector<Triangle> same(1000, Triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    require_valid(item, STUDENT(build)(same), same);
}

LAB_ITEM(20, "the nearest hit is the one that testing every triangle finds") {
    for (const bool scattered : {true, false}) {
        const auto triangles = scattered ? soup(item.random(), 1500) : knot(60, 12);
        const auto rays = random_rays(item.random(), 1500);
        require_hits(item, STUDENT(trace)(STUDENT(build)(triangles), triangles, rays), triangles, rays);
    }
    item.about("There are no triangles here, so the tree has no nodes: no root either.");
    const auto none = STUDENT(trace)(Tree{}, std::vector<Triangle>{}, std::vector<Ray>{Ray{{0, 0, 0}, {0, 0, -1}}});
    item.require(none.size() == 1 && none[0].triangle == -1,
                 "Without triangles a ray hits nothing: expected triangle -1.");
}

LAB_ITEM(20, "the tree is as cheap as the heuristic promises") {
    item.limit(20);
    for (const bool scattered : {true, false}) {
        const auto triangles = scattered ? soup(item.random(), 8000) : knot(400, 16);
        const Tree tree = STUDENT(build)(triangles);
        require_valid(item, tree, triangles);
        const double found = cost(tree), expected = cost(ReferenceTree(triangles, false).tree);
        item.require(std::isfinite(found),
                     "The boxes of your tree are infinite or not a number: join those of the triangles.");
        const double median = cost(ReferenceTree(triangles, true).tree);
        const std::string values = message(
            "Your tree costs ", found, " on ", scattered ? "scattered triangles" : "a torus knot", ", the examiner's ",
            expected, " (at most 1.25 times that is allowed), one split at medians ", median, ". ");
        item.require(
            found <= 1.25 * expected,
            values +
                (found > 2 * median ? "Is a leaf made too early, with many triangles?"
                 : std::abs(found - median) < 0.1 * median
                     ? "That is what a split at the median gives: compare the costs of many borders, on all three axes."
                     : "Are all three axes tried, and the areas of both sides counted with their triangles?"));
    }
}

LAB_ITEM(20, "the time budget: 100,000 triangles and 40,000 rays") {
    const auto triangles = knot(2500, 20);
    const auto rays = random_rays(item.random(), 36000);
    const std::clock_t start = std::clock();
    const ReferenceTree reference(triangles, false);
    const double budget = 6 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    item.limit(std::max(2.0, 2 * budget));
    const Tree tree = STUDENT(build)(triangles);
    const double built = item.seconds();
    const auto found = STUDENT(trace)(tree, triangles, rays);
    const double traced = item.seconds();
    require_hits(item, found, triangles, rays, 400); // every 400th: a fast answer must be right, too
    item.require(built + traced <= budget,
                 message("Building took ", built, " s and tracing ", traced, " s, together more than the budget of ",
                         budget, " s, six times what the examiner's own (plain) building takes here. ",
                         traced > built
                             ? "Is the nearer child visited first, and are boxes behind the nearest hit skipped?"
                             : "Building is the slow part: sorting at each node costs more than counting into bins."));
}

LAB_ITEM(0, "the picture: a knot") {
    item.limit(10);
    const auto triangles = knot(220, 14); // few enough for the starter, which tests them all
    constexpr int kWidth = 240, kHeight = 180;
    std::vector<Ray> rays;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double right = (x + 0.5 - kWidth / 2) / 275, up = (kHeight / 2 - y - 0.5) / 275 - 0.035;
            rays.push_back({{0, 6.5f, 7}, normalize(Vec3(Vec3d(right, 0.72 * up - 0.66, -0.69 * up - 0.72)))});
        }
    const auto found = STUDENT(trace)(STUDENT(build)(triangles), triangles, rays);
    ImageRgb image(kWidth, kHeight, Rgb(0.02f, 0.022f, 0.03f));
    const Vec3 sun = normalize(Vec3{-0.5f, 1, 0.3f});
    for (std::size_t i = 0; i < std::min(found.size(), rays.size()); ++i) {
        const int id = found[i].triangle;
        if (id < 0 || id >= static_cast<int>(triangles.size())) continue;
        const Triangle& t = triangles[static_cast<std::size_t>(id)];
        const Vec3 normal = normalize(cross(t.b - t.a, t.c - t.a));
        const float diffuse = max(0.0f, std::abs(dot(normal, rays[i].direction))) *
                              (0.25f + 0.75f * max(0.0f, std::abs(dot(normal, sun))));
        const float along = 2 * kPi * static_cast<float>(id) / static_cast<float>(triangles.size());
        const Rgb color(0.55f + 0.4f * std::cos(along), 0.45f + 0.3f * std::cos(along + 2.1f),
                        0.5f + 0.4f * std::cos(along + 4.2f));
        image[i] = color * (0.08f + 0.9f * diffuse);
    }
    item.show("the knot through your tree", image);
}
