// Declares the photon map, which finds the photons near a point. Photons are the vertices of light subpaths that
// vertices of camera subpaths merge with (Jensen 1996; Hachisuka and Jensen 2009).
#pragma once

#include "raytrace/bidirectional/subpath.h"

#include <array>
#include <vector>

namespace duet::raytrace {

/// Represents a vertex of a light subpath that camera subpaths may merge with.
struct Photon {
    Vec3 p;
    Vec3 to_previous; ///< unit direction to the previous vertex of the light subpath
    Rgb flux;         ///< throughput of the subpath, in W, times the ratio of the shading to the geometric cosine
    MisSums mis;
    int depth; ///< number of scatterings before this vertex
};

/// Stores photons in a grid whose cells are twice as wide as the radius. Cells are found by a hash, so that their
/// number does not depend on the scene's extent (Teschner et al. 2003). The order of photons, and thus of all sums,
/// does not depend on threads.
class PhotonMap {
public:
    /// Builds the grid. The radius must be positive. `threads` is the number of threads (0 = all).
    PhotonMap(std::vector<Photon> photons, float radius, int threads);

    /// Calls visit(photon) for each photon within the radius of p.
    template <typename Visit> void for_each_near(Vec3 p, const Visit& visit) const {
        const Cell corner = cell(p - Vec3(radius_, radius_, radius_));
        for (int i = 0; i < 8; ++i) {
            const Cell at{corner[0] + (i & 1), corner[1] + (i >> 1 & 1), corner[2] + (i >> 2)};
            const std::size_t slot = slot_of(at);
            for (std::uint32_t k = starts_[slot]; k < starts_[slot + 1]; ++k)
                if (length_squared(photons_[k].p - p) <= sqr(radius_) && cell(photons_[k].p) == at) visit(photons_[k]);
        }
    }
    float radius() const { return radius_; }

private:
    using Cell = std::array<std::int64_t, 3>;
    Cell cell(Vec3 p) const;
    std::size_t slot_of(const Cell& cell) const;

    std::vector<Photon> photons_; ///< sorted by slot
    std::vector<std::uint32_t> starts_;
    float radius_;
    double cells_per_meter_;
    int slot_bits_ = 0;
};

} // namespace duet::raytrace
