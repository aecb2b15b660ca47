// Finds the tiles of an image whose points no object can shadow from a light, by shaft culling (Haines and Wallace
// 1991, "Shaft Culling for Efficient Ray-Traced Radiosity"). These tiles need no shadow map lookups.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"
#include "raster/shadows/shadow_maps.h"

#include <vector>

namespace duet::raster {

/// Returns whether a box lies outside the convex hull of the boxes `a` and `b`. The test is conservative: it may return
/// false for a box that lies outside, but never true for a box that meets the hull.
bool misses_shaft(const Box3d& a, const Box3d& b, const Box3d& box);

/// Finds the tiles of a G-buffer whose points no object shadows, for each source of Shadows.
class UnblockedTiles {
public:
    /// `data` must have its shadow maps. `threads` = 0 stands for all. In scenes of more than kMostCasters casters or
    /// with moving objects, no tile counts as unblocked.
    UnblockedTiles(const RasterSceneData& data, const GBuffer& gbuffer, int threads);

    /// Returns whether no object can block the light of a source of Shadows in the tile around a pixel.
    bool contains(std::size_t source, int x, int y) const {
        return !sources_.empty() && (sources_[tile(x, y)] >> source & 1) != 0;
    }

    static constexpr int kSide = 32; ///< pixels along a side
    static constexpr std::size_t kMostCasters = 128; ///< objects and quads; each tile tests all of them

private:
    std::size_t tile(int x, int y) const {
        return static_cast<std::size_t>(y / kSide * columns_ + x / kSide);
    }

    int columns_ = 0;
    std::vector<std::uint64_t> sources_; ///< for each tile, one bit per source
    static_assert(Shadows::kMaxSources <= 64);
};

} // namespace duet::raster
