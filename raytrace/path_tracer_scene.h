// Declares PathTracerSceneData, the result of prepare(), which is computed once per scene for any number of views.
#pragma once

#include "common/scene/scene.h"
#include "raytrace/acceleration/accelerator.h"
#include "raytrace/sampling/light_sampler.h"

#include <optional>
#include <vector>

namespace duet::raytrace {

/// Holds the result of prepare(). It refers to the scene, which must outlive it.
struct PathTracerSceneData {
    /// `threads` is the number of build threads (0 = all).
    PathTracerSceneData(const Scene& scene_, int threads) : PathTracerSceneData(scene_, Accelerator(scene_, threads)) {}
    /// Takes the hierarchies of meshes that `before` has as well from there (see Accelerator).
    PathTracerSceneData(const Scene& scene_, int threads, const PathTracerSceneData& before)
        : PathTracerSceneData(scene_, Accelerator(scene_, threads, before.accelerator)) {}

    const Scene& scene;
    Accelerator accelerator;
    LightSampler lights;                     ///< the scene's lights, and its environment if it is sampled
    LightSampler finite_lights;              ///< lights without the environment, for settings that leave it out
    LightSampler environment_light;          ///< the environment alone
    std::vector<std::optional<Bsdf>> bsdfs;  ///< by material; empty where a texture varies it
    bool emitters = false;                   ///< whether some object emits, so that hits can find light
    bool environment = false;                ///< whether rays that escape can find light of the environment
    bool scatters_diffusely = false;         ///< whether some material or medium scatters light from light samples

private:
    PathTracerSceneData(const Scene& scene_, Accelerator built);
};

} // namespace duet::raytrace
