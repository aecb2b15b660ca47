// Divides the visible surfaces into clusters, for which lights are listed. The clusters divide a tile's pixels by depth
// and by normal, and have explicit bounds (Olsson, Billeter and Assarsson 2012, "Clustered Deferred and Forward
// Shading").
#pragma once

#include "raster/gbuffer/gbuffer.h"

#include <optional>

namespace duet::raster {

/// Selects the surfaces of a cluster: those in a rectangle of pixels whose reversed depth is in (farther, nearer] and
/// whose normal is in a box. Surfaces that reflect nothing, such as most emitters, belong to no cluster.
struct Cluster {
    static constexpr float kAll = 2; ///< greater than any reversed depth and any component of a normal

    int x, y, columns, rows;
    float nearer = kAll, farther = 0;
    Vec3 n_low{-kAll, -kAll, -kAll}, n_high{kAll, kAll, kAll}; ///< n_low ≤ n < n_high

    /// Returns the lanes of the batch at column x of row y that belong to the cluster.
    xsimd::batch_bool<float> lanes(const GBuffer& gbuffer, int x, int y) const;
};

/// Calls visit(x, y) for each batch of a cluster's rectangle that lies in the image.
template <typename Visit> void for_each_batch_of(const GBuffer& gbuffer, const Cluster& cluster, const Visit& visit) {
    for (int y = cluster.y; y < std::min(cluster.y + cluster.rows, gbuffer.height()); ++y)
        for (int x = cluster.x; x < std::min(cluster.x + cluster.columns, gbuffer.width());
             x += static_cast<int>(Floats::size))
            visit(x, y);
}

/// Bounds the points and normals of a cluster by boxes.
struct SurfaceBounds {
    Vec3 p_low, p_high, n_low, n_high;

    Vec3 center() const { return (p_low + p_high) * 0.5f; }
    Vec3 extent() const { return (p_high - p_low) * 0.5f; }
    Vec3 mean_normal() const { return (n_low + n_high) / max(length(n_low + n_high), 1e-6f); }
};
/// Returns the bounds of a cluster, or nothing if it has no surfaces.
std::optional<SurfaceBounds> surface_bounds(const GBuffer& gbuffer, const Cluster& cluster);
inline constexpr std::size_t kDepthSlices = 4;
/// Divides a cluster by depth into at most kDepthSlices, and returns their number; 0 if it has no surfaces.
std::size_t slices_of_depth(const GBuffer& gbuffer, const Cluster& cluster, std::array<Cluster, kDepthSlices>& slices);
/// Divides a cluster by its normals if they change abruptly, as at the edge of a box.
std::optional<std::array<Cluster, 2>> split_at_edge(const GBuffer& gbuffer, const Cluster& cluster,
                                                    const SurfaceBounds& surfaces);

} // namespace duet::raster
