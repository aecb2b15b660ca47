// Samples the radiance that arrives at points from given directions: from reflection probes, or else from the
// environment.
#pragma once

#include "raster/geometry/lane_math.h"
#include "raster/gbuffer/gbuffer.h"
#include "raster/probes/reflection_probes.h"
#include "raster/raster_scene.h"

namespace duet::raster {

/// Provides incident radiance for one batch of pixels, whose objects select the probes.
class RadianceLookup {
public:
    /// If `probes` is null, only the environment's radiance arrives.
    RadianceLookup(const RasterSceneData& data, const GBuffer& gbuffer, const ReflectionProbes* probes, int x, int y);

    /// Returns the radiance that arrives at points p, relative to the eye, from the unit direction w, filtered by a GGX
    /// lobe of width alpha on a surface of normal n. Mirrors see the lights, wider lobes do not.
    RgbT<Floats> operator()(const Vec3T<Floats>& p, const Vec3T<Floats>& n, const Vec3T<Floats>& w, const Floats& alpha,
                            const xsimd::batch_bool<float>& lanes) const;

private:
    struct Query;
    RgbT<Floats> from_probe(std::size_t probe, const Query& query, const xsimd::batch_bool<float>& lanes) const;

    const RasterSceneData& data_;
    const GBuffer& gbuffer_;
    const ReflectionProbes* probes_;
    Ints probe_ = Ints(0); ///< of each visible lane
};

} // namespace duet::raster
