// Declares RenderPlan, the decisions that a render takes once before its loop: which steps of path tracing this scene,
// view and settings need.
#pragma once

#include "common/camera/pixel_footprint.h"
#include "common/rendering.h"
#include "raytrace/batched_surfaces.h"
#include "raytrace/path_tracer_scene.h"
#include "raytrace/settings.h"

namespace duet::raytrace {

/// Holds the decisions of one render. It refers to the prepared scene, which must outlive it.
struct RenderPlan {
    RenderPlan(const PathTracerSceneData& prepared_, const View& view, const PathTracerSettings& settings);
    RenderPlan(const RenderPlan&) = delete; // bsdfs may point into the plan
    RenderPlan& operator=(const RenderPlan&) = delete;

    const PathTracerSceneData& prepared;
    const Scene& scene;
    const PixelFilter filter;
    const LightSampler* lights = nullptr;                    ///< null if no light is sampled
    const Environment* environment = nullptr;                ///< null if rays that escape find no light
    const std::vector<std::optional<Bsdf>>* bsdfs = nullptr; ///< by material; empty where a texture varies it
    std::vector<SurfaceDetail> details;                      ///< by material: details that its surface points need
    bool emission = false;                                   ///< whether surfaces that are hit may emit
    bool hits_find_light = false; ///< whether rays may find an emitter, the environment, or a medium that emits
    bool specular_light_samples =
        false; ///< whether lights are sampled at mirrors and glass, too, which cannot reflect them
    bool subsurface = false; ///< whether paths enter solids with subsurface scattering; else solids are diffuse
    /// This is true if media, solids, or dielectrics that absorb or have a priority lie between surfaces. Then paths
    /// have a medium stack.
    bool needs_medium_stack = false;
    bool random_distances = false; ///< whether paths are scattered between surfaces, at random distances
    std::size_t delta_lights = 0; ///< number of lights sampled along rays in media, first in Scene::lights
    bool black_shadow_rays = false; ///< trace shadow rays even if the surface reflects none of the light
    BatchedSurfaces batched;        ///< surfaces at which paths are scattered in batches (wavefront/batch.h)
    int max_depth = 0;
    bool russian_roulette = false; ///< whether roulette may end paths after more than one scattering
    std::optional<PixelFootprint>
        pixel_footprint; ///< footprint of a ray that covers a whole pixel; empty if no texture is filtered
    Sampler::CameraNeeds camera_needs; ///< whether rays start at points sampled on the lens, and at sampled times

private:
    std::vector<std::optional<Bsdf>> no_bsdfs_; ///< `bsdfs` points to it if every BSDF is computed at the hit
};

/// Sets `point` to the camera sample of pixel (x, y) with the random samples u. Each component is written directly to
/// its destination. If a whole point were copied right after its components were written, the load would stall on store
/// forwarding.
inline void set_camera_point(CameraModel::Sample& point, const RenderPlan& plan, int x, int y,
                             const CameraRaySample& u) {
    const Vec2d offset = plan.filter.sample(u.pixel);
    point.pixel.x = x + 0.5 + offset.x;
    point.pixel.y = y + 0.5 + offset.y;
    point.lens = u.lens;
    point.time = u.time;
}

/// Returns the steps that the plan leaves out, with the reasons.
std::vector<SkippedWork> skipped(const RenderPlan& plan, const PathTracerSettings& settings);
/// Returns one sentence for each feature of the scene that the integrator leaves out.
std::vector<std::string> approximations(const RenderPlan& plan, const PathTracerSettings& settings);

} // namespace duet::raytrace
