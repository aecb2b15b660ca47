// Declares LightComponents, the light of a camera sample, split by what happens at the first hit of the path.
#pragma once

#include "common/image/rgb.h"

namespace duet::raytrace {

/// Splits the radiance along one camera ray. The components other than `shadowed` add up to the path tracer's
/// sample. A first hit on metal or glass, smooth or rough, counts as a reflection. Any other first hit counts as
/// diffuse.
struct LightComponents {
    Rgb emission;    ///< directly visible emissive surfaces and environment
    Rgb direct;      ///< light of Scene::lights after one scattering, except at smooth metal or glass
    Rgb environment; ///< the environment's light after one scattering at a diffuse surface, with occlusion
    Rgb reflection;  ///< all other light through metal or glass at the first hit
    Rgb indirect;    ///< all other light through a diffuse first hit, including that of moving emitters
    Rgb shadowed;    ///< not in the sum: direct light that is lost by occlusion

    Rgb sum() const { return emission + direct + environment + reflection + indirect; }
    /// Returns direct light without occlusion.
    Rgb unshadowed() const { return direct + shadowed; }
};

/// Names the kind of source of the light that a path found.
enum class LightSource {
    kLight,       ///< one of Scene::lights
    kEnvironment, ///< the environment
    kOther,       ///< an emissive surface that is no light: it moves, or is a non-uniformly scaled sphere
};

} // namespace duet::raytrace
