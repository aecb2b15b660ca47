// The examiner of lab 08. Boxes are computed by hand or in double precision; the truth about hits is every sphere of
// the tree tested for every ray.
#include "raytrace/lessons/08-bvh/lab_test.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace duet;
using namespace duet::grading;

LAB_TITLE("raytrace-08", "A tree of boxes")

namespace {

using T = std::optional<float>;

/// Fails the item unless the tree is one, with the spheres in the leaves, and boxes that fit.
void require_tree(Item& item, const Tree& tree, const Spheres& spheres) {
    const auto nodes = static_cast<int>(tree.size()), count = static_cast<int>(spheres.size());
    const std::string of = message(" (", count, count == 1 ? " sphere)" : " spheres)");
    item.require(nodes > 0, "The tree has no nodes" + of + ": even one sphere needs a leaf.");
    std::vector<int> seen(spheres.size(), 0), visits(tree.size(), 0);
    std::vector<Spheres> all_below(tree.size());
    int deepest = 0;
    const auto visit = [&](const auto& self, int index, int depth) -> Spheres {
        const Node& node = tree[static_cast<std::size_t>(index)];
        item.require(++visits[static_cast<std::size_t>(index)] == 1,
                     message("Node ", index, " is reached twice", of, "."));
        deepest = std::max(deepest, depth);
        const std::string name = message(index == 0 ? "the root" : "node ", index == 0 ? "" : std::to_string(index));
        Spheres below;
        if (node.left < 0 && node.right < 0) {
            item.require(
                node.sphere >= 0 && node.sphere < count,
                message("The leaf ", index, " holds the sphere ", node.sphere, ": expected 0 to ", count - 1, "."));
            ++seen[static_cast<std::size_t>(node.sphere)];
            below = {spheres[static_cast<std::size_t>(node.sphere)]};
        } else {
            for (const int child : {node.left, node.right}) {
                item.require(child > 0 && child < nodes,
                             message("A child of ", name, " is ", child, of, ": expected 1 to ", nodes - 1,
                                     ". A leaf has no children: -1 and -1."));
                const Spheres more = self(self, child, depth + 1);
                below.insert(below.end(), more.begin(), more.end());
            }
        }
        all_below[static_cast<std::size_t>(index)] = below;
        return below;
    };
    visit(visit, 0, 0);
    const auto lost = std::count(seen.begin(), seen.end(), 0);
    item.require(lost == 0, message(lost, " of ", count,
                                    " spheres are in no leaf: is the border between the halves the "
                                    "same for both?"));
    item.require(std::count(seen.begin(), seen.end(), 1) == count,
                 "Some spheres are in two leaves: is the border between the halves the same for both?");
    for (std::size_t i = 0; i < tree.size(); ++i) {
        const Spheres& below = all_below[i];
        if (below.empty()) continue; // never reached
        const std::string name = i == 0 ? "the root" : message("node ", i);
        const Box3 expected = box_of(below);
        if (!same_box(tree[i].box, expected)) {
            Box3 centers, whole = box_of(spheres);
            for (const Sphere& s : below) centers.extend(s.center);
            const std::string hint =
                same_box(tree[i].box, centers)
                    ? "It is the box around the centers: that serves to find the axis, but the "
                      "node needs the box around the whole spheres."
                : same_box(tree[i].box, whole) ? "It is the box around all spheres of the scene: each node has its own."
                : tree[i].box.empty()          ? "It is empty: was it computed before or after the node was stored?"
                                               : "It must be the smallest box around all spheres below.";
            item.near(message("The box of ", name, of), tree[i].box, expected, 0, {{tree[i].box, hint}});
        }
    }
    const int needed = static_cast<int>(std::ceil(std::log2(count)));
    item.require(deepest <= needed, message("The tree is not balanced", of, ": its deepest leaf is ", deepest,
                                            " steps below the root, and halves "
                                            "need ",
                                            needed, ". Both children must get half of the spheres."));
}

/// Compares the hits of all rays. Those that pass a sphere so closely that rounding decides are left out.
void check_hits(Item& item, const std::string& what, const std::vector<Nearest>& found, const Spheres& spheres,
                const std::vector<int>& some, const std::vector<Ray>& rays) {
    item.require(found.size() == rays.size(),
                 message("One hit is expected for each ray: expected ", rays.size(), ", found ", found.size(), "."));
    Spheres larger = spheres, smaller = spheres;
    for (Sphere& s : larger) s.radius *= 1.001f;
    for (Sphere& s : smaller) s.radius *= 0.999f;
    for (std::size_t r = 0; r < rays.size(); ++r) {
        const Nearest expected = nearest_of(spheres, some, rays[r]);
        if (nearest_of(larger, some, rays[r]).sphere != nearest_of(smaller, some, rays[r]).sphere) continue;
        if (found[r].sphere == expected.sphere && is_near(found[r].t, expected.t, 1e-3 * (1 + std::abs(expected.t))))
            continue;
        const int i = found[r].sphere;
        const bool is_one = i >= 0 && i < static_cast<int>(spheres.size());
        const bool in_tree = is_one && std::find(some.begin(), some.end(), i) != some.end();
        const auto t = is_one ? lesson::hit_sphere(spheres[static_cast<std::size_t>(i)], rays[r]) : std::nullopt;
        std::string hint = "Print the boxes that this ray enters: at which node does it turn away?";
        if (i < 0 && expected.sphere >= 0)
            hint = "This ray hits, but you found nothing. Does a miss in the first child hide a hit in the second?";
        else if (is_one && !in_tree)
            hint =
                "That sphere is in no leaf of the tree: test the spheres of the leaves that the ray reaches, not the "
                "whole list.";
        else if (is_one && t && expected.sphere >= 0 && *t > expected.t)
            hint = "This hit lies behind the nearest one: shorten the ray (t_max) at each hit, so that a farther one "
                   "can't "
                   "replace it.";
        else if (is_one && !t)
            hint = "The ray does not hit that sphere at all.";
        item.near(message(what, ": the hit of the ray from ", describe(rays[r].origin), " in direction ",
                          describe(rays[r].direction)),
                  found[r], expected, 0, {{found[r], hint}});
    }
}

} // namespace

LAB_ITEM(0, "the picture: spheres through your tree") {
    Spheres spheres;
    for (int i = 0; i < 300; ++i) {
        const float angle = 2.39996f * static_cast<float>(i), y = 1 - (static_cast<float>(i) + 0.5f) / 150;
        const float r = std::sqrt(1 - y * y);
        spheres.push_back({Vec3{r * std::cos(angle), y, r * std::sin(angle)}, 0.09f});
    }
    constexpr int kWidth = 160, kHeight = 120;
    std::vector<Ray> rays;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            rays.push_back({{0, 0, 4}, Vec3(Vec3d((x - kWidth / 2 + 0.5) / 190, (kHeight / 2 - y - 0.5) / 190, -1))});
    const auto found = STUDENT(closest_hits)(spheres, STUDENT(build)(spheres), rays);
    ImageRgb image(kWidth, kHeight, Rgb(0.02f, 0.03f, 0.08f));
    for (std::size_t i = 0; i < std::min(found.size(), rays.size()); ++i) {
        if (found[i].sphere < 0 || found[i].sphere >= 300) continue;
        const Sphere& s = spheres[static_cast<std::size_t>(found[i].sphere)];
        const Vec3 n = (rays[i].at(found[i].t) - s.center) / s.radius;
        image[i] =
            (Rgb(0.5f) + Rgb(s.center.x, s.center.y, s.center.z) * 0.5f) * max(0.1f, dot(n, Vec3{0.5f, 0.6f, 0.62f}));
    }
    item.show("spheres on a sphere, through your tree", image);
}

LAB_ITEM(10, "boxes around spheres") {
    const Spheres one{{{1, 2, -3}, 0.5f}};
    item.near("the box around a sphere with center (1, 2, -3) and radius 0.5", STUDENT(box_around)(one),
              Box3{{0.5f, 1.5f, -3.5f}, {1.5f, 2.5f, -2.5f}}, 1e-6,
              {{Box3{{1, 2, -3}, {1, 2, -3}}, "This is the center alone: the sphere reaches its radius to both sides."},
               {Box3{{0, 0, -3.5f}, {1.5f, 2.5f, 0}},
                "The box begins at the origin, where there is no sphere: begin with an empty box, which Box3{} is."},
               {Box3{{1, 2, -3}, {1.5f, 2.5f, -2.5f}}, "The sphere reaches its radius to both sides of the center."},
               {Box3{{0.75f, 1.75f, -3.25f}, {1.25f, 2.25f, -2.75f}},
                "The box is half as large as it should be: 0.5 is the radius, not the diameter."},
               {Box3{{1.5f, 2.5f, -2.5f}, {0.5f, 1.5f, -3.5f}}, "low and high are exchanged."}});
    const Spheres two{{{0, 0, 0}, 1}, {{3, -2, 0.5f}, 0.25f}};
    item.near("the box around two spheres", STUDENT(box_around)(two), Box3{{-1, -2.25f, -1}, {3.25f, 1, 1}}, 1e-6,
              {{box_of(Spheres{two[0]}), "This is the box around the first sphere."},
               {box_of(Spheres{two[1]}), "This is the box around the last sphere: it must be extended by each."},
               {Box3{{-1, -2.25f, -1}, {3.25f, 0, 1}}, "All corners of a box start empty, not at zero."},
               {Box3{{0, -2, 0}, {3, 0, 0.5f}}, "This is the box around the centers."}});
    const Spheres away{{{5, 6, 7}, 1}, {{7, 6, 5}, 0.5f}};
    item.near("the box around two spheres far from the origin", STUDENT(box_around)(away),
              Box3{{4, 5, 4.5f}, {7.5f, 7, 8}}, 1e-5,
              {{Box3{{0, 0, 0}, {7.5f, 7, 8}}, "The box begins at the origin, where there is no sphere: begin with an "
                                               "empty box, which Box3{} is."}});
    for (int i = 0; i < 20; ++i) {
        const Spheres spheres = random_spheres(item.random(), 1 + i);
        item.near(message("the box around ", spheres.size(), " spheres"), STUDENT(box_around)(spheres), box_of(spheres),
                  1e-4);
    }
}

LAB_ITEM(15, "rays that enter a box") {
    const Box3 box{{-1, -1, -1}, {1, 1, 1}};
    const auto enter = [&](Vec3 origin, Vec3 direction, float t_min = 0, float t_max = kInfinity) {
        return STUDENT(enter_box)(box, Ray{origin, direction, t_min, t_max});
    };
    item.near(
        "the entry from (-5, -4, -3) in direction (1, 1, 1), all positive,", enter({-5, -4, -3}, {1, 1, 1}), T(4.0f),
        1e-5,
        {{T(2.0f), "That is the smallest of the three entries. The ray is inside when it has entered all three "
                   "slabs: take the greatest."},
         {T(4.0f / std::sqrt(3.0f)), "t counts lengths of the direction: don't normalize it."},
         {T(0.0f), "The ray begins outside: it enters at t = 4."},
         {T(), "It enters the slabs at 4, 3 and 2, and leaves them at 6, 5 and 4: there is t = 4 in all three."}});
    item.near("the entry from (5, 4, 3.5) in direction (-1, -1, -1)", enter({5, 4, 3.5f}, {-1, -1, -1}), T(4.0f), 1e-5,
              {{T(), "In a negative direction the ray enters at the high side and leaves at the low one: exchange near "
                     "and far."}});
    item.near(
        "the entry from (5, -4, 3.5) in direction (-1, 1, -1)", enter({5, -4, 3.5f}, {-1, 1, -1}), T(4.0f), 1e-5,
        {{T(), "Near and far are exchanged for each axis alone, where that coordinate of the direction is negative."}});
    item.near("the entry of a ray that begins inside", enter({0.5f, 0, 0}, {1, 0.5f, 0.25f}), T(0.0f), 1e-6,
              {{T(-1.5f), "This point lies behind the origin: begin with the interval [t_min, t_max], not with all t."},
               {T(0.5f), "This is where the ray leaves the box."},
               {T(), "A ray that begins inside is in the box at once, at t_min."}});
    item.near("the entry with t_min = 5 of a ray that is in the box from t = 4 to 6",
              enter({-5, 0, 0}, {1, 0.01f, 0.01f}, 5), T(5.0f), 1e-5,
              {{T(4.0f), "Only t from t_min on count: the first of them with a point inside is t_min itself."}});
    item.near("the entry of a ray that runs away from the box", enter({5, 0.1f, 0.2f}, {1, 0.1f, 0.1f}), T(), 0,
              {{T(-6.0f), "The box lies behind the origin."}, {T(0.0f), "The box lies behind the origin."}});
    item.near(
        "the entry of a ray that leaves one slab before it enters another, from (-5, 0, 0) in direction (1, 1, 0.1)",
        enter({-5, 0, 0}, {1, 1, 0.1f}), T(), 0,
        {{T(4.0f), "At t = 4 the ray is far above the box: it left the slab of y at t = 1. No t is in all slabs."}});
    item.near("the entry of a ray that ends before the box, with t_max = 3", enter({-5, 0, 0}, {1, 0.1f, 0.1f}, 0, 3),
              T(), 0, {{T(4.0f), "t = 4 is beyond t_max = 3."}});
    Rng& rng = item.random();
    for (int i = 0; i < 300; ++i) {
        const Vec3 low = random_point(rng, 2), high = low + abs(random_point(rng, 2)) + Vec3{0.05f, 0.05f, 0.05f};
        const Vec3 origin = random_point(rng, 5), direction = Vec3(rng.unit_vector() * rng.uniform(0.3, 3));
        double near = 0, far = 1e30;
        for (std::size_t axis = 0; axis < 3; ++axis) { // in double, by comparison of both planes
            const double d = static_cast<double>(direction[axis]), o = static_cast<double>(origin[axis]);
            const double a = (static_cast<double>(low[axis]) - o) / d, b = (static_cast<double>(high[axis]) - o) / d;
            near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
        }
        if (std::abs(near - far) < 1e-3) continue; // it grazes an edge: rounding decides
        item.near(message("the entry from ", describe(origin), " in direction ", describe(direction),
                          " into the box from ", describe(low), " to ", describe(high)),
                  STUDENT(enter_box)(Box3{low, high}, Ray{origin, direction}),
                  near <= far ? T(static_cast<float>(near)) : T(), 1e-3 * (1 + near));
    }
}

LAB_ITEM(15, "rays along an axis, and flat boxes") {
    const Box3 box{{-1, -1, -1}, {1, 1, 1}};
    const std::string zero = "Where a coordinate of the direction is 0, the ray stays in that slab for all t, or never "
                             "is in it.";
    item.near("the entry along +x, from (-5, 0.2, 0.3)", STUDENT(enter_box)(box, Ray{{-5, 0.2f, 0.3f}, {1, 0, 0}}),
              T(4.0f), 1e-5, {{T(), "It hits in the middle. " + zero}, {T(NAN), "This is not a number. " + zero}});
    item.near("the entry along -z, from (0.2, 0.3, 5)", STUDENT(enter_box)(box, Ray{{0.2f, 0.3f, 5}, {0, 0, -1}}),
              T(4.0f), 1e-5, {{T(), "It hits in the middle. " + zero}});
    item.near(
        "the entry along -z with zeros that are negative, direction (-0, -0, -1)",
        STUDENT(enter_box)(box, Ray{{0.2f, 0.3f, 5}, {-0.0f, -0.0f, -1}}), T(4.0f), 1e-5,
        {{T(), "1 / -0 is minus infinity: decide by the sign of 1 / direction which plane is near, or exchange the "
               "two distances if the first is greater."}});
    item.near("the entry along -z above the box, from (0, 2, 5)", STUDENT(enter_box)(box, Ray{{0, 2, 5}, {0, 0, -1}}),
              T(), 0, {{T(4.0f), "The ray is above the slab of y for all t. " + zero}});
    item.near("the entry along +x beside the box, from (-5, 0, -3)",
              STUDENT(enter_box)(box, Ray{{-5, 0, -3}, {1, 0, 0}}), T(), 0,
              {{T(4.0f), "The ray is outside of the slab of z for all t. " + zero}});
    item.near("the entry into a flat box (a floor) from above",
              STUDENT(enter_box)(Box3{{-1, 0, -1}, {1, 0, 1}}, Ray{{0, 3, 0}, {0.1f, -1, 0.1f}}), T(3.0f), 1e-5,
              {{T(), "A flat box is entered and left at the same t, and that is a hit: compare with <=, not with <."}});
    for (const float side : {-1.0f, 1.0f}) { // 0 * infinity: any answer for that slab is right, but no NaN may come out
        const auto t = STUDENT(enter_box)(box, Ray{{-5, side, 0}, {1, 0, 0}});
        item.require(!t || is_near(*t, 4.0f, 1e-4),
                     message("A ray that runs exactly in the side y = ", side, " enters at t = 4 or not at all; yours ",
                             t ? describe(*t) : "",
                             ". There 0 · infinity occurs, which is not a number: a comparison with "
                             "it is false."));
        const auto outside = STUDENT(enter_box)(box, Ray{{-5, side, 3}, {1, 0, 0}});
        item.require(!outside,
                     "A ray that runs in the plane of one side, but misses the box by the slab of z, must miss. "
                     "0 · infinity is not a number: does it wipe out the interval?");
    }
    int lost = 0;
    for (int i = 0; i < 400; ++i) { // aimed at points of a flat box, from anywhere
        Rng& rng = item.random();
        const float y = static_cast<float>(rng.uniform(-3, 3));
        const Vec3 origin = random_point(rng, 6),
                   target{static_cast<float>(rng.uniform(-0.9, 0.9)), y, static_cast<float>(rng.uniform(-0.9, 0.9))};
        lost += !STUDENT(enter_box)(Box3{{-1, y, -1}, {1, y, 1}}, Ray{origin, target - origin});
    }
    item.require(lost == 0,
                 message(lost, " of 400 rays that are aimed at a flat box miss it. The two distances of the flat "
                               "slab must be computed by the same formula, so that they round alike."));
}

LAB_ITEM(25, "the tree: each sphere in one leaf, halves, and boxes that fit") {
    for (const int count : {1, 2, 3, 7, 64, 500}) {
        const Spheres spheres = random_spheres(item.random(), count);
        require_tree(item, STUDENT(build)(spheres), spheres);
    }
    const Spheres same(100, Sphere{{1, 2, 3}, 0.5f});
    require_tree(item, STUDENT(build)(same), same);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Spheres row; // along one axis, mixed up
        for (int i = 0; i < 256; ++i) {
            Vec3 center = random_point(item.random(), 0.5);
            center[axis] = static_cast<float>((i * 101) % 256);
            row.push_back({center, 0.4f});
        }
        const Tree tree = STUDENT(build)(row);
        require_tree(item, tree, row);
        const double found = cost(tree), expected = cost(make_tree(row));
        const std::string name = std::string(1, static_cast<char>('x' + axis));
        std::string hint = "Are the spheres sorted by the centers, along the axis along which these reach farthest?";
        for (int wrong = 0; wrong < 3; ++wrong)
            if (static_cast<std::size_t>(wrong) != axis && std::abs(found - cost(make_tree(row, wrong))) < 0.02 * found)
                hint = message("Your tree is what cuts along ", static_cast<char>('x' + wrong),
                               " give: choose the axis along which the centers reach farthest, at each node anew.");
        if (std::abs(found - cost(make_tree(row, 4))) < 0.02 * found)
            hint = "Your tree is what halves of the list give in the order in which it came: sort the spheres by their "
                   "centers before you cut.";
        item.require(found <= 1.1 * expected,
                     message("For 256 spheres in a row along ", name,
                             " the boxes overlap: a ray that enters the root's box "
                             "enters ",
                             std::round(found), " boxes, and could do with ", std::round(expected), ". ", hint));
    }
}

LAB_ITEM(20, "the nearest hit is the one that testing every sphere finds") {
    Rng& rng = item.random();
    const Spheres two{{{0, 0, -3}, 1}, {{0.1f, 0, -6}, 1}};
    const std::vector<Ray> through{{{0, 0, 0}, {0, 0, -1}}, {{0, 0, -10}, {0, 0, 1}}};
    check_hits(item, "two spheres, one behind the other", STUDENT(closest_hits)(two, make_tree(two), through), two,
               {0, 1}, through);
    for (const int count : {1, 5, 60, 2000}) {
        const Spheres spheres = random_spheres(rng, count);
        const auto rays = random_rays(rng, 500, 5);
        check_hits(item, message(count, " spheres in the examiner's tree"),
                   STUDENT(closest_hits)(spheres, make_tree(spheres), rays), spheres, all_of(spheres), rays);
    }
    const Spheres spheres = random_spheres(rng, 400);
    const auto rays = random_rays(rng, 500, 5);
    check_hits(item, "400 spheres in your own tree", STUDENT(closest_hits)(spheres, STUDENT(build)(spheres), rays),
               spheres, all_of(spheres), rays);
}

LAB_ITEM(15, "only leaves whose boxes the ray enters are tested") {
    Rng& rng = item.random();
    const Spheres spheres = random_spheres(rng, 300);
    std::vector<int> some;
    for (int i = 0; i < 300; i += 3) some.push_back(i);
    const auto rays = random_rays(rng, 500, 5);
    check_hits(item, "a tree with a third of the spheres",
               STUDENT(closest_hits)(spheres, make_tree(spheres, some), rays), spheres, some, rays);
    // In these trees one box was moved away from its sphere, so that no ray to the sphere enters it.
    const Spheres three{{{-4, 0, -8}, 1}, {{0, 0, -8}, 1}, {{4, 0, -8}, 1}};
    const std::vector<Ray> to_each{{{0, 0, 0}, {-4, 0, -8}}, {{0, 0, 0}, {0, 0, -8}}, {{0, 0, 0}, {4, 0, -8}}};
    const Tree right = make_tree(three);
    for (std::size_t moved = 0; moved < right.size(); ++moved) {
        Tree tree = right;
        tree[moved].box = {{90, 90, 90}, {91, 91, 91}};
        std::vector<bool> hidden(three.size(), false);
        const auto hide = [&](const auto& self, int index) -> void {
            const Node& node = tree[static_cast<std::size_t>(index)];
            if (node.sphere >= 0) return void(hidden[static_cast<std::size_t>(node.sphere)] = true);
            self(self, node.left), self(self, node.right);
        };
        hide(hide, static_cast<int>(moved));
        const auto found = STUDENT(closest_hits)(three, tree, to_each);
        item.require(found.size() == 3,
                     message("One hit is expected for each ray: expected 3, found ", found.size(), "."));
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string which = moved == 0 ? "the root" : right[moved].sphere >= 0 ? "a leaf" : "an inner node";
            item.require(!hidden[i] || found[i].sphere < 0,
                         message("The box of ", which,
                                 " was moved away from the ray, and yet you found a sphere below it: "
                                 "first ask enter_box, then go on. Do so for the root and for leaves, too."));
            item.require(hidden[i] || found[i].sphere == static_cast<int>(i),
                         message("The box of ", which, " was moved away, but the ray ", i,
                                 " goes to a sphere elsewhere, which "
                                 "you did not find. Does a missed box end the search as a whole?"));
        }
    }
    item.limit(2); // 20,000 spheres and 8,000 rays are 160 million tests without a tree
    const Spheres many = random_spheres(rng, 20000);
    const auto more = random_rays(rng, 8000, 5);
    item.require(STUDENT(closest_hits)(many, make_tree(many), more).size() == more.size(),
                 "One hit is expected for each ray.");
}
