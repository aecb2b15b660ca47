// PathTracerSceneData is what prepare() makes of a scene, once for any number of views.
#pragma once

#include "common/scene/scene.h"
#include "raytrace/acceleration/accelerator.h"
#include "raytrace/sampling/light_sampler.h"

#include <optional>
#include <vector>

namespace duet::raytrace {

/// Holds what prepare() makes of a scene. It refers to the scene, which must outlive it.
struct PathTracerSceneData {
    /// `threads` is the number of build threads (0 = all).
    PathTracerSceneData(const Scene& scene_, int threads);

    const Scene& scene;
    Accelerator accelerator;
    LightSampler lights;                     ///< the scene's lights, and its environment if that is sampled
    LightSampler finite_lights;              ///< without the environment, for settings that leave it out
    LightSampler environment_light;          ///< the environment alone
    std::vector<std::optional<Bsdf>> bsdfs;  ///< by material; empty where a texture varies it
    bool emitters = false;                   ///< whether some object emits, so that hits can find light
    bool environment = false;                ///< whether it is not black, so that rays that escape can find light
    bool scatters_diffusely = false;         ///< whether some material or medium can scatter light samples
};

} // namespace duet::raytrace
