// Computes soft shadows of area lights with SIMD: percentage-closer soft shadows (Fernando 2005, "Percentage-Closer
// Soft Shadows") in a cube of depths seen from the light's center. Neighboring pixels use different taps, and four
// neighbors in a row share the blockers that they find, so few taps per pixel suffice.
#pragma once

#include "raster/gbuffer/screen_projection.h"
#include "raster/geometry/packet.h"
#include "raster/shadows/depth_cube.h"
#include "raster/shadows/emitter.h"
#include "raster/shadows/near_casters.h"
#include "raster/shadows/pcf.h"

#include <optional>

namespace duet::raster {

struct LightOutline; // as seen from a receiver

/// Holds the map of one area light, or of one cell of it.
class SoftShadowMap {
public:
    SoftShadowMap(const CellMaps& maps, const Emitter& emitter);

    /// Returns the visible fraction of the light at points relative to the eye at `eye`, with unit normals: a noisy
    /// estimate, unspecified outside `lanes`. The batch starts at a multiple of 4 pixels in row y. The taps of a block
    /// of 4 × 4 pixels together cover the light evenly.
    Floats visibility(const Vec3d& eye, const Vec3T<Floats>& p, const Vec3T<Floats>& n, int y,
                      const xsimd::batch_bool<float>& lanes) const;

    /// Returns 1 where points see the light's center, else 0. If casters surround the light closely, it returns the
    /// visible fraction past them.
    Floats visibility(const Vec3d& eye, const Vec3T<Floats>& p) const;

    std::size_t memory_bytes() const;

    static constexpr int kSearchTaps = 4, kFilterTaps = 4; ///< per pixel; a block of 4 × 4 pixels has 64 of each

private:
    LightOutline outline_from(const Vec3T<Floats>& p) const;
    Vec3T<Floats> local(const Vec3T<Floats>& w) const;
    template <typename Lookup> Floats combined(const Vec3T<Floats>& p, const Lookup& lookup) const;

    DepthCube cube_;
    std::optional<DepthCube> distant_; ///< CellMaps::distant
    OctahedralMap near_visibility_;    ///< CellMaps::near_visibility
    float reach_;                      ///< CellMaps::reach
    Emitter::Kind kind_;
    float radius_ = 0;
    Vec3 corner_, u_, v_, dual_u_, dual_v_; ///< geometry of a flat light in the cube's frame; its normal is +z
};

/// Returns the visible fraction of a sun's disk, whose angular radius has the given sine, by the map of its center: an
/// estimate as that of SoftShadowMap. `inside` receives the lanes for which the map shows what may hide the disk;
/// others are unspecified.
Floats sun_visibility(const SharpShadowMap& map, float sine, const Vec3T<Floats>& p, const Vec3T<Floats>& n, int y,
                      const xsimd::batch_bool<float>& lanes, xsimd::batch_bool<float>& inside);

} // namespace duet::raster
