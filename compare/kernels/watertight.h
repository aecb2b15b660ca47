// This file traces rays from inside at the weakest points of a closed triangle mesh. None may escape or slip through.
#pragma once

#include "common/system/control.h"
#include "compare/kernels/hit_oracle.h"
#include "compare/kernels/kernel_scene.h"

#include <functional>
#include <vector>

namespace duet::compare {

/// Returns a kernel's tracer for the given rays.
using TracerFactory = std::function<Tracer(std::span<const Ray>)>;

/// Holds the results of the rays, per kernel. One third of the rays is aimed at random points of random triangles, one
/// third at points of their edges, and one third at vertices. The rays start at points inside a closed mesh or anywhere
/// in a closed room. The double-precision ray judges every hit, also at silhouettes. Sixteen consecutive rays share
/// their origin and are aimed at neighbors in the mesh, so that packet kernels trace coherent packets.
struct Watertight {
    struct Kernel {
        std::int64_t misses = 0; ///< rays without a hit, which escaped
        KernelErrors faults;     ///< over all rays: leaks through an edge to the surface behind, other wrong hits
    };
    std::int64_t rays = 0;
    std::vector<Kernel> kernels; ///< in the order given
};

/// Runs the test. The scene must be closed (KernelScene::closed). The rays depend only on the seed and their
/// number. The result is meaningless if `control` was stopped. Throws Error if no point inside was found
/// because the mesh is too thin.
Watertight test_watertight(const KernelScene& scene, const HitOracle& oracle, const std::vector<TracerFactory>& kernels,
                           std::int64_t rays, std::uint64_t seed, int threads, const Control& control);

/// Returns points inside a closed mesh, where the winding number of the double-precision ray is above 0.
std::vector<Vec3> points_inside(const KernelScene& scene, const HitOracle& oracle, std::size_t count,
                                std::uint64_t seed);

} // namespace duet::compare
