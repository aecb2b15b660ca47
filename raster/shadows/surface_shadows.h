// Computes shadows on the surfaces of a G-buffer by lookups in the shadow maps.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/shadows/light_visibility.h"
#include "raster/shadows/shadow_maps.h"
#include "raster/shadows/unblocked_tiles.h"

namespace duet::raster {

/// Samples the shadow maps at the points of one view at one time.
class SurfaceShadows final : public LightVisibility {
public:
    /// Keeps references to its arguments. `data` must have its shadow maps. The points are those of the G-buffer's
    /// pixels at `time`. A point of a moving object is moved to its position at the map's moment, so that the object
    /// does not shade itself by its motion. `threads` = 0 stands for all.
    SurfaceShadows(const RasterSceneData& data, const GBuffer& gbuffer, float time, int threads);

    std::size_t source(std::size_t light) const override {
        const std::size_t source = shadows_.source_of(light);
        return source < shadows_.sources().size() ? source : kUnshadowed;
    }
    bool noisy(std::size_t source) const override { return is_wide_sun(source) || !maps_.soft(source).empty(); }
    /// Returns a noisy estimate. Each pixel of a block of 4 × 4 has taps of its own, and add_direct_light()
    /// (raster/lighting/shadow_denoiser.h) averages over the block. If an area light has at most four cells, each pixel
    /// samples one of them, else all.
    Floats visibility(std::size_t source, const Vec3T<Floats>& p, const Vec3T<Floats>& n, int x, int y,
                      const xsimd::batch_bool<float>& mask) const override;

private:
    struct Receivers {
        Vec3T<Floats> p, n;
    };
    bool is_wide_sun(std::size_t source) const;
    Receivers at_moment(const Receivers& receivers, int x, int y) const;

    const Shadows& shadows_;
    MapsAtTime maps_;
    const GBuffer& gbuffer_;
    Vec3d eye_;
    std::vector<std::optional<Mat4d>> to_moment_; ///< for each object, from its current position; empty if none moves
    UnblockedTiles unblocked_;
};

/// Returns the shadows at `time`, or nothing if the settings or the scene have none. It keeps references to `data` and
/// `gbuffer`.
std::optional<SurfaceShadows> surface_shadows(const RasterSceneData& data, const RasterSettings& settings,
                                              const GBuffer& gbuffer, float time);

} // namespace duet::raster
