// This header declares the amphora's texture.
#pragma once

#include "models/image.h"

namespace duet::models {

/// Below this v the texture covers the vase's outside, from foot to lip. Above it, the texture is plain black glaze
/// for the inside and the handles.
inline constexpr double kAmphoraPaintedV = 0.86;

/// Paints bands of ornament and a frieze of dolphins, in black on clay.
Image<Rgb8> paint_amphora();

} // namespace duet::models
