// A tree of boxes by halves of the sorted list.
#include "raytrace/lessons/08-bvh/lab.h"

#include <algorithm>

namespace duet::lab {

Box3 box_around(const std::vector<Sphere>& spheres) {
    Box3 box;
    for (const Sphere& sphere : spheres) {
        const Vec3 reach{sphere.radius, sphere.radius, sphere.radius};
        box.extend(sphere.center - reach);
        box.extend(sphere.center + reach);
    }
    return box;
}

std::optional<float> enter_box(const Box3& box, const Ray& ray) {
    float enter = ray.t_min, leave = ray.t_max;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float inverse = 1 / ray.direction[axis];
        float near = (box.low[axis] - ray.origin[axis]) * inverse;
        float far = (box.high[axis] - ray.origin[axis]) * inverse;
        if (inverse < 0) std::swap(near, far);
        if (near > enter) enter = near;
        if (far < leave) leave = far;
    }
    if (enter <= leave) return enter;
    return std::nullopt;
}

namespace {

struct Builder {
    const std::vector<Sphere>& spheres;
    std::vector<int> order;
    std::vector<Node> tree;

    /// Appends the node over order[first], …, order[end - 1], and returns its index.
    int add(int first, int end) {
        const int index = static_cast<int>(tree.size());
        tree.push_back({});
        std::vector<Sphere> mine;
        Box3 centers;
        for (int i = first; i < end; ++i) {
            mine.push_back(spheres[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])]);
            centers.extend(mine.back().center);
        }
        Node node;
        node.box = box_around(mine);
        if (end - first == 1) {
            node.sphere = order[static_cast<std::size_t>(first)];
        } else {
            const std::size_t axis = longest_axis(centers.diagonal());
            std::sort(order.begin() + first, order.begin() + end, [&](int a, int b) {
                return spheres[static_cast<std::size_t>(a)].center[axis] <
                       spheres[static_cast<std::size_t>(b)].center[axis];
            });
            const int middle = (first + end) / 2;
            node.left = add(first, middle);
            node.right = add(middle, end);
        }
        tree[static_cast<std::size_t>(index)] = node;
        return index;
    }
};

/// Looks below a node. Each hit shortens the ray.
void visit(const std::vector<Sphere>& spheres, const std::vector<Node>& tree, int index, Ray& ray, Nearest& nearest) {
    const Node& node = tree[static_cast<std::size_t>(index)];
    if (!enter_box(node.box, ray)) return;
    if (node.sphere >= 0) {
        const auto t = lesson::hit_sphere(spheres[static_cast<std::size_t>(node.sphere)], ray);
        if (t) {
            ray.t_max = *t;
            nearest = {node.sphere, *t};
        }
        return;
    }
    visit(spheres, tree, node.left, ray, nearest);
    visit(spheres, tree, node.right, ray, nearest);
}

} // namespace

std::vector<Node> build(const std::vector<Sphere>& spheres) {
    Builder builder{spheres, {}, {}};
    for (std::size_t i = 0; i < spheres.size(); ++i) builder.order.push_back(static_cast<int>(i));
    builder.add(0, static_cast<int>(spheres.size()));
    return builder.tree;
}

std::vector<Nearest> closest_hits(const std::vector<Sphere>& spheres, const std::vector<Node>& tree,
                                  const std::vector<Ray>& rays) {
    std::vector<Nearest> hits;
    for (Ray ray : rays) {
        Nearest nearest;
        visit(spheres, tree, 0, ray, nearest);
        hits.push_back(nearest);
    }
    return hits;
}

} // namespace duet::lab
