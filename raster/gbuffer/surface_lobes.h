// Reduces every opaque material to the lobes that the G-buffer stores.
#pragma once

#include "common/material/material.h"

namespace duet::raster {

/// Holds the G-buffer's material attributes of one pixel (raster/gbuffer/gbuffer.h).
struct SurfaceLobes {
    Rgb diffuse, specular;
    float alpha = 1, coat = 0, coat_alpha = 1;
};

/// Returns the lobes of a BSDF towards a viewer at this cosine from the normal, in (0, 1]. Glass keeps only its outer
/// reflection; its transmission is a stage of its own.
SurfaceLobes surface_lobes(const Bsdf& bsdf, float cosine);

} // namespace duet::raster
