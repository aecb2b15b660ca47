// Rays aimed where a surface of triangles is weakest, from inside a closed mesh: none may get out.
#pragma once

#include "common/system/control.h"
#include "compare/kernels/judge.h"
#include "compare/kernels/kernel_scene.h"

#include <functional>
#include <vector>

namespace duet::compare {

/// A kernel for any rays.
using TracerFor = std::function<Tracer(std::span<const Ray>)>;

/// How many of the rays found nothing, by kernel. A third each is aimed at random points of random triangles, at points
/// of their edges, and at vertices; they start at points within the mesh, where a surface lies in every direction.
struct Watertight {
    std::int64_t rays = 0;
    std::vector<std::int64_t> misses; ///< one a kernel
};

/// The mesh must be closed (Mesh::closed). Rays depend on the seed and their number alone. What is found means nothing
/// where `control` was stopped. Throws Error where no point inside was found: the mesh is too thin.
Watertight test_watertight(const KernelScene& scene, const Judge& judge, const std::vector<TracerFor>& kernels,
                           std::int64_t rays, std::uint64_t seed, int threads, const Control& control);

/// Points within a closed mesh, by the double-precision ray: the winding number around each is above 0.
std::vector<Vec3> points_inside(const KernelScene& scene, const Judge& judge, std::size_t count, std::uint64_t seed);

} // namespace duet::compare
