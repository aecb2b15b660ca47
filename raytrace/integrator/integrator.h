// Declares the integrators, which estimate the radiance along a camera ray. All are functions of the same type, each in
// a file of its own.
#pragma once

#include "raytrace/integrator/light_components.h"
#include "raytrace/render_plan.h"
#include "raytrace/sampling/sampler.h"

#include <span>

namespace duet::raytrace {

/// Counts traced rays, and paths that Russian roulette ended, for the statistics.
struct RayCounts {
    std::int64_t camera = 0, indirect = 0, shadow = 0;
    std::int64_t ended = 0; ///< paths that Russian roulette ended

    RayCounts& operator+=(const RayCounts& other) {
        camera += other.camera;
        indirect += other.indirect;
        shadow += other.shadow;
        ended += other.ended;
        return *this;
    }
};

// The first dimensions of a sample belong to the camera. Each vertex of the path has a block of dimensions of its own,
// so a dimension that one vertex does not use does not shift the dimensions of others.

/// Holds the random samples in [0, 1) that a vertex uses. T is float, or a batch of floats for one vertex per lane.
template <typename T> struct VertexRandomSamplesT {
    Vec2T<T> bsdf, light;
    T light_choice, lobe, roulette;
    T distance = T(0.0f); ///< decides the distance at which media scatter the path; unused in batches
};
using VertexRandomSamples = VertexRandomSamplesT<float>;
/// Returns the first sample dimension of the vertex after `depth` scatterings.
inline std::uint32_t vertex_dimension(int depth) {
    return static_cast<std::uint32_t>(Sampler::kBlock) * static_cast<std::uint32_t>(depth + 1);
}
/// Returns the random samples of the vertex after `depth` scatterings. S is Sampler or PrimarySample.
template <typename S> VertexRandomSamples vertex_random_samples(S& sampler, int depth) {
    sampler.set_dimension(vertex_dimension(depth));
    const Sampler::Block u = sampler.get_block();
    return {{u[0], u[1]}, {u[2], u[3]}, u[4], u[5], u[6], u[7]};
}

/// Returns an unbiased estimate of the radiance along a camera ray of unit direction. `hit` is the ray's first hit, and
/// may be invalid.
using RadianceFunction = Rgb (*)(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler,
                                 RayCounts& counts);

Rgb path_radiance(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);        ///< path.cpp
Rgb whitted_radiance(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);     ///< whitted.cpp
Rgb unshadowed_radiance(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);  ///< unshadowed.cpp
Rgb lights_radiance(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);      ///< single_component.cpp
Rgb environment_radiance(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&); ///< single_component.cpp
Rgb reflection_radiance(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);  ///< single_component.cpp
Rgb normal_color(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);         ///< surface_colors.cpp
Rgb albedo_color(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);         ///< surface_colors.cpp

/// Computes path_radiance of many camera rays, bit-equal. The paths advance together, vertex by vertex (wavefront), so
/// that the CPU overlaps the work of several paths instead of waiting for the results of one. All spans must have the
/// same length. The rays, hits and samplers are modified.
void path_radiances(const RenderPlan&, std::span<Ray> rays, std::span<Hit> hits, std::span<Sampler> samplers,
                    std::span<Rgb> radiances, RayCounts&); ///< wavefront/wavefront.cpp

/// Computes path_radiance from the same random samples, split into components. Their sum equals path_radiance except
/// for rounding.
LightComponents path_components(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&); ///< path.cpp

/// Returns the function of an integrator. Path, naive and direct share one function, because they differ only in
/// their plans.
RadianceFunction radiance_function(Integrator integrator);
/// Applies the function of an integrator to many rays. The arguments are those of path_radiances.
void radiances(Integrator integrator, const RenderPlan& plan, std::span<Ray> rays, std::span<Hit> hits,
               std::span<Sampler> samplers, std::span<Rgb> radiances, RayCounts& counts);

} // namespace duet::raytrace
