// What a render decides once, before its loop: which parts of path tracing this scene, view and settings need.
#pragma once

#include "common/camera/pixel_footprint.h"
#include "common/film/rendering.h"
#include "raytrace/plain_surfaces.h"
#include "raytrace/prepare.h"
#include "raytrace/render.h"
#include "raytrace/roulette.h"

namespace duet::raytrace {

struct RenderPlan {
    /// known_worth: what `worth` is; empty: it is learned.
    RenderPlan(const PreparedData& prepared_, const View& view, const Settings& settings, std::optional<float> known_worth = {});
    RenderPlan(const RenderPlan&) = delete; // bsdfs may point into it
    RenderPlan& operator=(const RenderPlan&) = delete;

    const PreparedData& prepared;
    const Scene& scene;
    const PixelFilter filter;
    const LightChooser* lights = nullptr;                    ///< null: no light is sampled
    const Environment* environment = nullptr;                ///< null: rays that escape find nothing
    const std::vector<std::optional<Bsdf>>* bsdfs = nullptr; ///< by material: made once, where no texture varies it
    std::vector<SurfaceDetail> details; ///< by material: what its surface points need
    bool emission = false;                                   ///< surfaces that are hit may emit
    bool hits_find_light = false;   ///< a ray may find light by itself: an emitter, or the environment
    bool mirror_light = false;      ///< light is sampled at mirrors and glass, too, which cannot reflect it
    bool insides = false;           ///< some dielectric absorbs, or knows of others that it may stand in
    bool black_shadow_rays = false; ///< shadow rays are sent to light that the surface would not reflect, too
    PlainSurfaces plain;            ///< those at which paths may scatter side by side (plain_vertices.h)
    int max_depth = 0;
    bool russian_roulette = false;  ///< paths of more than one scattering may be ended
    float worth = kPlainWorth;      ///< of throughput, to roulette: see learned_worth
    std::optional<PixelFootprint> pixel; ///< of a camera ray that stands for all of one; empty where no texture is filtered
    bool lens = false;   ///< rays start all over the lens
    bool motion = false; ///< rays have times of their own

private:
    std::vector<std::optional<Bsdf>> none_; ///< what bsdfs is where each is to be made at the hit
};

/// What the plan leaves out, and why.
std::vector<Skipped> skipped(const RenderPlan& plan, const Settings& settings);
/// What the integrator leaves out though the scene has it.
std::vector<std::string> approximations(const RenderPlan& plan, const Settings& settings);

} // namespace duet::raytrace
