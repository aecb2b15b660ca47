// What mirrors, metal and glass reflect: radiance maps at points of the scene, looked up where the reflected ray meets
// the surfaces that the map saw (Szirmay-Kalos et al. 2005, "Approximate Ray-Tracing on the GPU with Distance
// Impostors").
#pragma once

#include "raster/probes/probe_capture.h"
#include "raster/probes/radiance_map.h"
#include "raster/raster_scene.h"

namespace duet::raster {

/// Holds the reflection probes of a scene, which no view changes. The largest objects that reflect have a probe at
/// their center, which does not see them; all others use the nearest probe.
class ReflectionProbes {
public:
    /// Renders the probes (raster/probes/render_reflection_probes.cpp). Some object must reflect, and `data` must
    /// have its irradiance probes, if the settings want them.
    ReflectionProbes(const RasterSceneData& data, const RasterSettings& settings);

    /// Returns the probe of an object.
    std::size_t probe_of(std::int32_t object) const { return of_object_[static_cast<std::size_t>(object)]; }
    /// Returns the vector from a probe's center to what a ray from the point p, relative to the eye at `eye`, meets in
    /// the unit direction w, with or without lights. It is very long where that is the background. Where the probe does
    /// not see what the ray meets, it points to what lies beside. Lanes that are not in `lanes` are unspecified.
    Vec3T<Floats> trace(std::size_t probe, const Vec3d& eye, const Vec3T<Floats>& p, const Vec3T<Floats>& w,
                        bool lights, const xsimd::batch_bool<float>& lanes) const;
    const RadianceMap& map(std::size_t probe) const { return probes_[probe].map; }
    std::size_t memory_bytes() const;

    /// The largest reflecting objects have probes of their own; all others use the nearest probe.
    static constexpr int kMostProbes = 96;
    /// Texels along a side of the sharp map of the i-th largest mirror, from 0 on. Few are seen so large that their
    /// image shows single texels.
    static constexpr int mirror_side(std::size_t i) { return i < 4 ? 512 : i < 16 ? 256 : 128; }
    static constexpr int kRoughSide = 128; ///< the same for objects that show faint or blurred images

private:
    struct Probe {
        Vec3d center;
        RadianceMap map;
    };
    std::vector<Probe> probes_;
    std::vector<std::size_t> of_object_;
};

/// Returns whether a material reflects more than a diffuse surface does.
bool reflects(const Material& material);

} // namespace duet::raster
