// Signed differences as colours.
#pragma once

#include "common/image/image.h"

namespace duet::compare {

/// The colour (sRGB-encoded components in [0, 1]) of a signed value in [−1, 1], values beyond clamped: blue for
/// negative, near white for 0, orange for positive. Blue and orange are told apart by every common kind of colour
/// vision, lightness falls evenly to both sides.
Rgb diverging_color(double value);

/// A − B in luminance, by diverging_color over [−range, range]; linear, as write_image takes it. Pixels that are not
/// finite are magenta.
ImageRgb difference_picture(const ImageRgb& a, const ImageRgb& b, double range);

/// A round number (1, 2 or 5 times a power of ten) just above the 99th percentile of |A − B| in luminance; at least
/// 0.001.
double difference_range(const ImageRgb& a, const ImageRgb& b);

} // namespace duet::compare
