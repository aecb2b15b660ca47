// The library's builder (raytrace/acceleration/bvh_build.h) with a plain walk through its binary tree.
#include "common/geometry/triangle.h"
#include "compare/lessons/assignments/2-bvh/lab.h"
#include "raytrace/acceleration/bvh_build.h"

namespace duet::lab {

Box box_of(const Triangle& triangle) {
    Box3 box;
    for (const Vec3 p : {triangle.a, triangle.b, triangle.c}) box.extend(p);
    return {box.low, box.high};
}

float surface_area(const Box& box) {
    const Vec3 size = box.high - box.low;
    return 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

bool hit_box(const Box& box, const Ray& ray) {
    float enter = ray.t_min, leave = ray.t_max;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float inverse = 1 / ray.direction[axis];
        const float a = (box.low[axis] - ray.origin[axis]) * inverse, b = (box.high[axis] - ray.origin[axis]) * inverse;
        // A NaN (0 times infinity: the ray runs in a side of the box) leaves both limits as they are.
        enter = std::fmax(enter, std::fmin(a, b));
        leave = std::fmin(leave, std::fmax(a, b) * 1.0000004f);
    }
    return enter <= leave;
}

Tree build(const std::vector<Triangle>& triangles) {
    raytrace::BuildItems items;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Box box = box_of(triangles[i]);
        items.push_back({{box.low, box.high}, static_cast<std::uint32_t>(i), raytrace::PrimitiveKind::kTriangle});
    }
    const raytrace::BinaryTree binary = raytrace::build_binary_tree(std::move(items), 1);
    Tree tree;
    for (const raytrace::BinaryNode& node : binary.nodes)
        tree.nodes.push_back({{node.box.low, node.box.high},
                              static_cast<int>(node.left),
                              static_cast<int>(node.right),
                              static_cast<int>(node.first),
                              static_cast<int>(node.count)});
    for (const raytrace::BuildItem& item : binary.items) tree.order.push_back(static_cast<int>(item.index));
    return tree;
}

std::vector<Found> trace(const Tree& tree, const std::vector<Triangle>& triangles, const std::vector<Ray>& rays) {
    std::vector<Found> found(rays.size());
    std::vector<int> stack;
    for (std::size_t r = 0; r < rays.size(); ++r) {
        Ray ray = rays[r];
        if (!tree.nodes.empty()) stack.push_back(0);
        while (!stack.empty()) {
            const Node& node = tree.nodes[static_cast<std::size_t>(stack.back())];
            stack.pop_back();
            if (!hit_box(node.box, ray)) continue;
            if (node.count == 0) {
                stack.push_back(node.left);
                stack.push_back(node.right);
                continue;
            }
            for (int i = node.first; i < node.first + node.count; ++i) {
                const int id = tree.order[static_cast<std::size_t>(i)];
                if (const auto t = hit_triangle(triangles[static_cast<std::size_t>(id)], ray)) {
                    ray.t_max = *t;
                    found[r] = {id, *t};
                }
            }
        }
    }
    return found;
}

} // namespace duet::lab
