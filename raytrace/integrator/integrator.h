// The integrators: how much light arrives along a camera ray. Each is a function of the same form, in a file of its
// own.
#pragma once

#include "common/sampling/sampler.h"
#include "raytrace/integrator/light_parts.h"
#include "raytrace/plan.h"

#include <span>

namespace duet::raytrace {

/// Rays sent, and not sent, for the statistics.
struct RayCounts {
    std::int64_t camera = 0, indirect = 0, shadow = 0;
    std::int64_t ended = 0; ///< paths, by roulette

    RayCounts& operator+=(const RayCounts& other) {
        camera += other.camera;
        indirect += other.indirect;
        shadow += other.shadow;
        ended += other.ended;
        return *this;
    }
};

// Dimensions of a sample: the camera's come first, then each vertex of the path has a block of its own. What is left
// out anywhere moves no number elsewhere.

/// The numbers in [0, 1) that a vertex uses.
struct VertexNumbers {
    Vec2 bsdf, light;
    float light_choice, lobe, roulette;
};
/// Those of the vertex after `depth` scatterings.
inline std::uint32_t vertex_dimension(int depth) {
    return static_cast<std::uint32_t>(Sampler::kBlock) * static_cast<std::uint32_t>(depth + 1);
}
inline void go_to_vertex(Sampler& sampler, int depth) { sampler.set_dimension(vertex_dimension(depth)); }
inline VertexNumbers vertex_numbers(const Sampler::Block& u) { return {{u[0], u[1]}, {u[2], u[3]}, u[4], u[5], u[6]}; }
inline VertexNumbers vertex_numbers(Sampler& sampler, int depth) {
    go_to_vertex(sampler, depth);
    return vertex_numbers(sampler.get_block());
}

/// An unbiased estimate of the radiance along a camera ray (its direction unit), whose first hit (or none) is given.
using RadianceFunction = Rgb (*)(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler,
                                 RayCounts& counts);

Rgb path_radiance(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);        ///< path.cpp
Rgb unshadowed_radiance(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);  ///< unshadowed.cpp
Rgb lights_radiance(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);      ///< single_part.cpp
Rgb environment_radiance(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&); ///< single_part.cpp
Rgb reflection_radiance(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);  ///< single_part.cpp
Rgb normal_color(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);         ///< surface_colors.cpp
Rgb albedo_color(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&);         ///< surface_colors.cpp

/// path_radiance of many camera rays, to the same bits: the paths advance side by side, vertex by vertex, so that the
/// machine works on several at once where each alone would wait for its own numbers. All spans are of one length; rays,
/// hits and samplers are used up.
void path_radiances(const RenderPlan&, std::span<Ray> rays, std::span<Hit> hits, std::span<Sampler> samplers,
                    std::span<Rgb> radiances, RayCounts&); ///< paths.cpp

/// path_radiance of the same numbers, split: the parts add up to it but for rounding.
LightParts path_parts(const RenderPlan&, const Ray&, const Hit&, Sampler&, RayCounts&); ///< path.cpp

/// The function of an integrator. Path, naive and direct are one: they differ in their plans.
RadianceFunction radiance_function(Integrator integrator);
/// It, of many rays: as path_radiances has it.
void radiances(Integrator integrator, const RenderPlan& plan, std::span<Ray> rays, std::span<Hit> hits,
               std::span<Sampler> samplers, std::span<Rgb> radiances, RayCounts& counts);

} // namespace duet::raytrace
