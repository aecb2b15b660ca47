// Provides the reflections of mirrors, metal and glass from radiance maps at points of the scene. A map is sampled in
// the direction where the reflected ray first hits the surfaces that the map shows, but for those that are narrower
// than a step of the search (McGuire, Mara, Nowrouzezahrai and Luebke 2017, "Real-Time Global Illumination using
// Precomputed Light Field Probes", §4).
#pragma once

#include "raster/probes/radiance_map.h"
#include "raster/raster_scene.h"

namespace duet::raster {

/// Holds the reflection probes of a scene. They do not depend on the view. The largest objects that reflect have a
/// probe at their center, from which they are left out; all other objects use the nearest probe.
class ReflectionProbes {
public:
    /// Renders the probes (raster/probes/render_reflection_probes.cpp). At least one object must reflect, and `data`
    /// must have its irradiance probes if the settings request them.
    ReflectionProbes(const RasterSceneData& data, const RasterSettings& settings);

    /// Returns the probe of an object.
    std::size_t probe_of(std::int32_t object) const { return of_object_[static_cast<std::size_t>(object)]; }
    /// Returns the vector from a probe's center to the hit of a ray, with or without lights. The ray starts at the
    /// point p, relative to the eye at `eye`, in the unit direction w. The vector is very long if the ray hits the
    /// background. If the probe does not see the hit, the vector points past the silhouette that hides it. Lanes that
    /// are not in `lanes` are unspecified.
    Vec3T<Floats> trace(std::size_t probe, const Vec3d& eye, const Vec3T<Floats>& p, const Vec3T<Floats>& w,
                        bool lights, const xsimd::batch_bool<float>& lanes) const;
    /// This is the same for lobes of GGX width alpha about w. The ray hits surfaces at the mean distance that the lobe
    /// sees, so that the outlines of near surfaces blur.
    Vec3T<Floats> trace_lobe(std::size_t probe, const Vec3d& eye, const Vec3T<Floats>& p, const Vec3T<Floats>& w,
                             const Floats& alpha, const xsimd::batch_bool<float>& lanes) const;
    const RadianceMap& map(std::size_t probe) const { return probes_[probe].map; }
    std::size_t memory_bytes() const;

    /// At most this many objects, the largest, have probes of their own.
    static constexpr int kMostProbes = 96;
    /// Returns the texels along a side of the sharp map of the i-th largest mirror, counted from 0. Few mirrors are so
    /// large in the image that single texels show.
    static constexpr int mirror_side(std::size_t i) { return i < 4 ? 512 : i < 16 ? 256 : 128; }
    static constexpr int kRoughSide = 128; ///< texels along a side for objects with faint or blurred reflections

private:
    struct Probe {
        Vec3d center;
        RadianceMap map;

        Vec3T<Floats> from_center(const Vec3d& eye, const Vec3T<Floats>& p) const {
            return p + broadcast<Floats>(Vec3(eye - center));
        }
    };
    std::vector<Probe> probes_;
    std::vector<std::size_t> of_object_;
};

/// Returns whether a material reflects more than a diffuse surface does.
bool reflects(const Material& material);

} // namespace duet::raster
