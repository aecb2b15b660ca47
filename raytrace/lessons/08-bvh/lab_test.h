// What the examiner of lab 08 compares with: random spheres and rays, its own tree over them, and every sphere tested.
#pragma once

#include "raytrace/lessons/08-bvh/lab.h"
#include "tests/grading/judge.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace duet::grading {

using lab::Nearest, lab::Node, lab::Sphere;
using Spheres = std::vector<Sphere>;
using Tree = std::vector<Node>;

inline Vec3 random_point(Rng& rng, double reach) {
    return Vec3(Vec3d(rng.uniform(-reach, reach), rng.uniform(-reach, reach), rng.uniform(-reach, reach)));
}
inline Spheres random_spheres(Rng& rng, int count, double reach = 5) {
    Spheres spheres;
    const double largest = 1.5 * reach / std::cbrt(count);
    for (int i = 0; i < count; ++i)
        spheres.push_back({random_point(rng, reach), static_cast<float>(rng.uniform(0.2, 1) * largest)});
    return spheres;
}

inline Box3 box_of(const Sphere& s) {
    const Vec3 r{s.radius, s.radius, s.radius};
    return {s.center - r, s.center + r};
}
inline Box3 box_of(const Spheres& spheres) {
    Box3 box;
    for (const Sphere& s : spheres) box.extend(box_of(s));
    return box;
}
inline bool same_box(const Box3& a, const Box3& b) {
    const float size = max_component(max(abs(b.low), abs(b.high)));
    return is_near(a, b, 1e-5 * (1 + static_cast<double>(size)));
}

/// The examiner's tree over some spheres. axis 3 is the right one; 0 to 2 is a mistake, and so is 4: not sorted.
inline Tree make_tree(const Spheres& spheres, std::vector<int> some, int axis = 3) {
    Tree tree;
    const auto at = [&](int i) -> const Sphere& { return spheres[static_cast<std::size_t>(i)]; };
    const auto add = [&](const auto& self, int first, int count) -> int {
        const auto index = static_cast<int>(tree.size());
        tree.emplace_back();
        Node node;
        Box3 centers;
        const auto begin = some.begin() + first;
        std::for_each(begin, begin + count,
                      [&](int i) { node.box.extend(box_of(at(i))), centers.extend(at(i).center); });
        const std::size_t by = axis == 3 ? longest_axis(centers.diagonal()) : static_cast<std::size_t>(axis % 4);
        if (axis != 4)
            std::sort(begin, begin + count, [&](int a, int b) { return at(a).center[by] < at(b).center[by]; });
        if (count == 1) node.sphere = *begin;
        if (count > 1) {
            node.left = self(self, first, count / 2);
            node.right = self(self, first + count / 2, count - count / 2);
        }
        tree[static_cast<std::size_t>(index)] = node;
        return index;
    };
    add(add, 0, static_cast<int>(some.size()));
    return tree;
}
inline std::vector<int> all_of(const Spheres& spheres) {
    std::vector<int> all(spheres.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
}
inline Tree make_tree(const Spheres& spheres, int axis = 3) { return make_tree(spheres, all_of(spheres), axis); }

/// How many boxes a ray that meets the root's box enters, if all rays are equally likely.
inline double cost(const Tree& tree) {
    double sum = 0;
    for (const Node& node : tree) sum += static_cast<double>(node.box.half_area());
    return sum / static_cast<double>(tree[0].box.half_area());
}

inline std::vector<Ray> random_rays(Rng& rng, int count, double reach) {
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        const Vec3 from = Vec3(rng.unit_vector() * (rng.uniform(0, 3) * reach));
        rays.push_back({from, random_point(rng, reach) - from});
        if (i % 10 == 0) { // along an axis, through the middle of the scene
            const auto axis = static_cast<std::size_t>(rng.integer(0, 2));
            Vec3 direction{0, 0, 0};
            direction[axis] = rng.uniform() < 0.5 ? -1.0f : 1.0f;
            rays.push_back({random_point(rng, reach) - direction * static_cast<float>(4 * reach), direction});
        }
    }
    return rays;
}

inline Nearest nearest_of(const Spheres& spheres, const std::vector<int>& some, Ray ray) {
    Nearest nearest;
    for (const int i : some)
        if (const auto t = lesson::hit_sphere(spheres[static_cast<std::size_t>(i)], ray)) nearest = {i, ray.t_max = *t};
    return nearest;
}

} // namespace duet::grading
