// This file computes false colors for signed differences.
#pragma once

#include "common/image/image.h"

namespace duet::compare {

/// Returns the color (sRGB-encoded components in [0, 1]) of a signed value, clamped to [−1, 1]: blue for negative
/// values, near white for 0, and orange for positive values. Blue and orange can be distinguished with every common
/// kind of color vision. Lightness decreases evenly toward both ends.
Rgb diverging_color(double value);

/// Returns A − B in luminance, mapped by diverging_color over [−range, range], as linear values for
/// write_image. Pixels that are not finite are magenta.
ImageRgb difference_image(const ImageRgb& a, const ImageRgb& b, double range);

/// Returns a round number (1, 2 or 5 times a power of ten) just above the 99th percentile of |A − B| in
/// luminance; at least 0.001.
double difference_range(const ImageRgb& a, const ImageRgb& b);

} // namespace duet::compare
