// Samples the shadow maps of all lights of a scene with SIMD.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/shadows/pcf.h"
#include "raster/shadows/pcss.h"
#include "raster/shadows/shadow_lookup.h"
#include "raster/shadows/shadow_maps.h"
#include "raster/shadows/unblocked_tiles.h"

namespace duet::raster {

/// Holds the soft shadow maps of a scene. They do not depend on the view.
class SoftShadowMaps {
public:
    explicit SoftShadowMaps(const Shadows& shadows);
    /// Returns the maps of the cells of a source at a moment (Shadows::Source).
    std::span<const SoftShadowMap> of(std::size_t source, std::size_t moment) const { return maps_[source][moment]; }

private:
    std::vector<std::vector<std::vector<SoftShadowMap>>> maps_;
};

/// Samples the shadow maps at the points of one view at one time.
class MapShadows final : public ShadowLookup {
public:
    /// Keeps references to its arguments. `data` must have its shadow maps. The points are those of the G-buffer's
    /// pixels at `time`. A point of a moving object is moved to its position at the map's moment, so that the object
    /// does not shade itself by its motion. `threads` = 0 stands for all.
    MapShadows(const RasterSceneData& data, const GBuffer& gbuffer, float time, int threads);

    std::size_t source(std::size_t light) const override {
        const std::size_t source = shadows_.source_of(light);
        return source < shadows_.sources().size() ? source : kUnshadowed;
    }
    bool noisy(std::size_t source) const override { return !soft_.of(source, moment_).empty(); }
    /// Returns a noisy estimate. Each pixel of a block of 4 × 4 has taps of its own, and add_direct_light()
    /// (raster/lighting/shadow_denoiser.h) averages over the block. If an area light has at most four cells, each pixel
    /// samples one of them, else all.
    Floats visibility(std::size_t source, const Vec3T<Floats>& p, const Vec3T<Floats>& n, int x, int y,
                      const xsimd::batch_bool<float>& mask) const override;

private:
    struct Source {
        std::vector<SharpShadowMap> views;              ///< tried in order
        std::vector<std::vector<SharpShadowMap>> cubes; ///< six faces each
    };

    struct Receivers {
        Vec3T<Floats> p, n;
    };
    Receivers at_moment(const Receivers& receivers, int x, int y) const;
    Floats sharp_visibility(const Source& source, const Vec3T<Floats>& p, const Vec3T<Floats>& n) const;

    const Shadows& shadows_;
    const SoftShadowMaps& soft_;
    const GBuffer& gbuffer_;
    Vec3d eye_;
    std::vector<std::optional<Mat4d>> to_moment_; ///< for each object, from its current position; empty if none moves
    std::size_t moment_;
    UnblockedTiles unblocked_;
    std::vector<Source> sources_;
};

} // namespace duet::raster
