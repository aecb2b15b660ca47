// Lab 08: a tree of boxes.
#pragma once

#include "common/vec/box.h"
#include "raytrace/lessons/02-sphere/sphere.h"
#include "tests/grading/lab.h"

#include <vector>

namespace duet::lab {

using lesson::Sphere;

/// A node of the tree. A leaf holds one sphere of the list, and has no children: left and right are -1. An inner node
/// has two children, tree[left] and tree[right], and its sphere is -1.
struct Node {
    Box3 box; ///< the smallest box around all spheres below the node
    int left = -1, right = -1;
    int sphere = -1; ///< index into the list of spheres
};

/// The nearest hit of a ray: which sphere, and where; sphere -1 and t infinite where it hits none.
struct Nearest {
    int sphere = -1;
    float t = kInfinity;
};

/// The smallest box around all spheres of the list, which has at least one. Radii are greater than 0.
Box3 box_around(const std::vector<Sphere>& spheres);

/// The smallest t with ray.t_min <= t <= ray.t_max whose point lies in the box or on its surface; nothing where there
/// is none. A box may be flat (low == high along an axis). One or two coordinates of the direction may be 0: then the
/// ray runs along the slab. If it runs exactly in a side of the box, both answers are right for that slab.
std::optional<float> enter_box(const Box3& box, const Ray& ray);

/// A tree over at least one sphere. tree[0] is the root. Each inner node cuts its spheres in two halves (one more in
/// either of them where their number is odd): sort them by their centers along the axis along which the centers reach
/// farthest, and cut in the middle of the sorted list.
std::vector<Node> build(const std::vector<Sphere>& spheres);

/// The nearest hit of each ray, found through the tree. A sphere counts only if the ray enters the box of its leaf, and
/// of all nodes above. The tree may come from the examiner, and hold a part of the spheres. lesson::hit_sphere is yours
/// to use.
std::vector<Nearest> closest_hits(const std::vector<Sphere>& spheres, const std::vector<Node>& tree,
                                  const std::vector<Ray>& rays);

} // namespace duet::lab

DUET_LAB(box_around, enter_box, build, closest_hits)
