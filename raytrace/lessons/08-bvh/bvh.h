// A tree of boxes: the nearest of many objects on a ray, without a test of each.
#pragma once

#include "common/vec/box.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"

#include <algorithm>
#include <functional>
#include <span>

namespace duet::lesson {

struct Object {
    Box3 box;                                          ///< around all of it
    std::function<std::optional<Hit>(const Ray&)> hit; ///< where a ray meets it, t_min < t < t_max
};

/// A triangle. Its corners come counter-clockwise, seen from outside. `index` is that of its hits.
inline Object triangle_object(Vec3 a, Vec3 b, Vec3 c, std::size_t index = 0) {
    const auto hit = [=, n = cross(b - a, c - a)](const Ray& ray) -> std::optional<Hit> {
        const float t = dot(n, a - ray.origin) / dot(n, ray.direction); // where the ray meets the plane
        const auto is_left = [&](Vec3 from, Vec3 to) { return dot(n, cross(to - from, ray.at(t) - from)) >= 0; };
        if (!(t > ray.t_min && t < ray.t_max && is_left(a, b) && is_left(b, c) && is_left(c, a))) return std::nullopt;
        return make_hit(ray, t, normalize(n), index);
    };
    return {{min(a, min(b, c)), max(a, max(b, c))}, hit};
}

/// Where a ray enters a box: the smallest t in [t_min, t_max] whose point is inside; nothing where it misses.
/// (Kay and Kajiya 1986; the factor against rounding is that of Ize 2013, "Robust BVH Ray Traversal")
inline std::optional<float> enter_box(const Box3& box, const Ray& ray) {
    float enter = ray.t_min, leave = ray.t_max;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float scale = 1 / ray.direction[axis]; // infinite where the ray runs along the slab
        float near = (box.low[axis] - ray.origin[axis]) * scale, far = (box.high[axis] - ray.origin[axis]) * scale;
        if (scale < 0) std::swap(near, far);
        if (near > enter) enter = near; // what is not a number is neither greater nor less
        if (far < leave) leave = far;
    }
    return enter <= leave * (1 + 3 * 0x1p-23f) ? std::optional(enter) : std::nullopt;
}

struct Bvh {
    std::span<const Object> objects; ///< all that are below this node
    Box3 box;                        ///< around all of them
    std::size_t axis = 0;            ///< along which the first child has the lower centers
    std::vector<Bvh> children;       ///< two, with one half of the objects each; a leaf has none
};

/// A tree over objects, which it sorts, and refers to. Leaves have `most` objects at most.
inline Bvh build(std::span<Object> objects, std::size_t most = 1) {
    Bvh node{objects, {}, 0, {}};
    Box3 centers;
    for (const Object& object : objects) node.box.extend(object.box), centers.extend(object.box.center());
    node.axis = longest_axis(centers.diagonal());
    if (objects.size() <= most) return node;
    std::ranges::sort(objects, {}, [&](const Object& object) { return object.box.center()[node.axis]; });
    node.children.push_back(build(objects.first(objects.size() / 2), most));
    node.children.push_back(build(objects.subspan(objects.size() / 2), most));
    return node;
}

/// The nearest hit of all objects below a node. enter(box, ray) is enter_box, unless you count calls or make a mistake.
template <typename Enter = decltype(enter_box)>
std::optional<Hit> closest_hit(const Bvh& node, Ray ray, const Enter& enter = enter_box) {
    std::optional<Hit> closest;
    if (!enter(node.box, ray)) return closest;
    const std::size_t near = ray.direction[node.axis] < 0 ? 1 : 0;
    for (std::size_t i = 0; i < node.children.size(); ++i) // a hit shortens the ray: what lies beyond needs no test
        if (const auto hit = closest_hit(node.children[i ^ near], ray, enter)) closest = hit, ray.t_max = hit->t;
    for (std::size_t i = 0; i < node.objects.size() && node.children.empty(); ++i)
        if (const auto hit = node.objects[i].hit(ray)) closest = hit, ray.t_max = hit->t;
    return closest;
}

} // namespace duet::lesson
