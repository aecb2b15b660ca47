// The light of a camera sample, split by what the path does at its first hit.
#pragma once

#include "common/image/rgb.h"

namespace duet::raytrace {

/// Radiance along one camera ray. The parts other than `shadowed` add up to the path tracer's sample. A first hit on
/// metal or glass, smooth or rough, counts as a reflection; any other as diffuse.
struct LightParts {
    Rgb emission;    ///< seen directly: emissive surfaces, and the environment behind all
    Rgb direct;      ///< in one scattering from Scene::lights, but not from smooth metal or glass, which mirror them
    Rgb environment; ///< in one scattering from the environment, by a diffuse surface; what hides it is left out
    Rgb reflection;  ///< all else by way of metal or glass at the first hit
    Rgb indirect;    ///< all else by way of a diffuse surface: from other surfaces, and from moving emitters, which are
                     ///< no Scene::lights
    Rgb shadowed;    ///< no part of the sum: what `direct` lacks because something stands before the lights

    Rgb sum() const { return emission + direct + environment + reflection + indirect; }
    /// Direct light as if nothing cast a shadow.
    Rgb unshadowed() const { return direct + shadowed; }
};

/// Where a path found light.
enum class LightSource {
    kLight,       ///< one of Scene::lights
    kEnvironment, ///< the environment
    kOther,       ///< an emissive surface that is no light: it moves, or is a stretched sphere
};

} // namespace duet::raytrace
