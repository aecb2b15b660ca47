// What a render decides once, before its loop: which parts of path tracing this scene, view and settings need.
#pragma once

#include "common/film/rendering.h"
#include "raytrace/prepare.h"
#include "raytrace/render.h"

namespace duet::raytrace {

struct RenderPlan {
    RenderPlan(const PreparedData& prepared_, const View& view, const Settings& settings);

    const PreparedData& prepared;
    const Scene& scene;
    const LightChooser* lights = nullptr;     ///< null: no light is sampled
    const Environment* environment = nullptr; ///< null: rays that escape find nothing
    bool hits_find_light = false;             ///< a ray may find light by itself: an emitter, or the environment
    int max_depth = 0;
    bool russian_roulette = false;
    bool lens = false;   ///< rays start all over the lens
    bool motion = false; ///< rays have times of their own
};

/// What the plan leaves out, and why.
std::vector<Skipped> skipped(const RenderPlan& plan, const Settings& settings);
/// What the integrator leaves out though the scene has it.
std::vector<std::string> approximations(const RenderPlan& plan, const Settings& settings);

} // namespace duet::raytrace
