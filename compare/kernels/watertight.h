// Rays aimed where a surface of triangles is weakest, from within a closed scene: none may get out or slip through.
#pragma once

#include "common/system/control.h"
#include "compare/kernels/judge.h"
#include "compare/kernels/kernel_scene.h"

#include <functional>
#include <vector>

namespace duet::compare {

/// A kernel for any rays.
using TracerFor = std::function<Tracer(std::span<const Ray>)>;

/// What became of the rays, by kernel. A third each is aimed at random points of random triangles, at points of their
/// edges, and at vertices. They start within: at points inside a closed mesh, anywhere in a closed room; everything
/// that they meet, outlines too, is judged by the double-precision ray. Sixteen on end start at one point and are aimed
/// at neighbours in the mesh, so that packets are tried as packets.
struct Watertight {
    struct Kernel {
        std::int64_t misses = 0; ///< rays that found nothing, and so got out
        Faults faults;           ///< of all rays: slipped through an edge to what lies behind, or wrong otherwise
    };
    std::int64_t rays = 0;
    std::vector<Kernel> kernels; ///< in the order given
};

/// The scene must be closed (KernelScene::closed). Rays depend on the seed and their number alone. What is found means
/// nothing where `control` was stopped. Throws Error where no point inside was found: the mesh is too thin.
Watertight test_watertight(const KernelScene& scene, const Judge& judge, const std::vector<TracerFor>& kernels,
                           std::int64_t rays, std::uint64_t seed, int threads, const Control& control);

/// Points within a closed mesh, by the double-precision ray: the winding number around each is above 0.
std::vector<Vec3> points_inside(const KernelScene& scene, const Judge& judge, std::size_t count, std::uint64_t seed);

} // namespace duet::compare
