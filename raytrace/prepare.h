// What prepare() makes of a scene, once for any number of views.
#pragma once

#include "common/light/light_choice.h"
#include "common/scene/scene.h"
#include "raytrace/acceleration/accelerator.h"

#include <optional>
#include <vector>

namespace duet::raytrace {

struct PreparedData {
    /// threads: for building, 0 = all; quality: of the hierarchies.
    PreparedData(const Scene& scene_, int threads, BvhQuality quality);

    const Scene& scene;
    Accelerator accelerator;
    LightChooser lights;                    ///< the scene's lights, and its environment if it is uneven
    LightChooser finite_lights;             ///< without the environment, for settings that leave it out
    LightChooser environment_light;         ///< the environment alone
    std::vector<std::optional<Bsdf>> bsdfs; ///< by material: made once, where no texture varies it
    bool emitters = false;                  ///< some object emits: hits can find light
    bool environment = false;               ///< it is not black: rays that escape can find light
    bool scatters_diffusely = false;        ///< some object has a material that light samples can find
};

} // namespace duet::raytrace
