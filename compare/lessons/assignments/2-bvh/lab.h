// Assignment 2: a bounding volume hierarchy by the surface area heuristic.
#pragma once

#include "common/vec/ray.h"
#include "tests/grading/lab.h"

#include <optional>
#include <vector>

namespace duet::lab {

struct Triangle {
    Vec3 a, b, c;
};

/// A box with its sides along the axes; low <= high in each coordinate. A flat box is fine.
struct Box {
    Vec3 low, high;
};

/// A node of the tree. An inner node has count 0 and the two children nodes[left] and nodes[right]. A leaf has count >
/// 0 and the triangles order[first], …, order[first + count - 1].
struct Node {
    Box box; ///< holds all triangles below the node
    int left = 0, right = 0;
    int first = 0, count = 0;
};

/// nodes[0] is the root; there are no nodes where there are no triangles. `order` names each triangle exactly once.
struct Tree {
    std::vector<Node> nodes;
    std::vector<int> order;
};

/// The nearest triangle on a ray and its distance; triangle -1 where the ray hits none.
struct TriangleHit {
    int triangle = -1;
    float t = kInfinity;
};

/// Given: the distance at which a ray meets a triangle, t_min < t < t_max. (Möller and Trumbore 1997)
inline std::optional<float> hit_triangle(const Triangle& triangle, const Ray& ray) {
    const Vec3 ab = triangle.b - triangle.a, ac = triangle.c - triangle.a, p = cross(ray.direction, ac);
    const float determinant = dot(ab, p);
    if (determinant == 0) return std::nullopt; // the ray runs along the triangle's plane
    const Vec3 from_a = ray.origin - triangle.a, q = cross(from_a, ab);
    const float u = dot(from_a, p) / determinant, v = dot(ray.direction, q) / determinant;
    if (u < 0 || v < 0 || u + v > 1) return std::nullopt;
    const float t = dot(ac, q) / determinant;
    if (t > ray.t_min && t < ray.t_max) return t;
    return std::nullopt;
}

/// The smallest box that holds a triangle.
Box box_of(const Triangle& triangle);

/// The area of all six sides of a box.
float surface_area(const Box& box);

/// Whether the ray meets the box for some t in [t_min, t_max]. Rays may run along an axis (components of the direction
/// that are 0), may start inside, and may run in negative direction.
bool hit_box(const Box& box, const Ray& ray);

/// A tree over any triangles, also where many of them have the same center. The cost that the surface area heuristic
/// expects (the sum over inner nodes of 1 × area, plus over leaves of count × area, in units of the root's area) must
/// be at most 1.25 times that of the examiner's own tree, which is built with 16 bins along each axis.
Tree build(const std::vector<Triangle>& triangles);

/// The nearest hit of each ray, found through the tree.
std::vector<TriangleHit> trace(const Tree& tree, const std::vector<Triangle>& triangles, const std::vector<Ray>& rays);

} // namespace duet::lab

DUET_LAB(box_of, surface_area, hit_box, build, trace)
