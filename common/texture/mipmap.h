// This file builds mip pyramids, so that a texture lookup can average the part of an image that a pixel covers.
#pragma once

#include "common/image/image.h"

#include <vector>

namespace duet {

/// Returns the image at half its size, rounded down, but at least 1 pixel on each side. Each pixel is the exact mean
/// over its area for any size: where a side is odd, a pixel includes fractions of its neighbors (Guthe and Heckbert
/// 2005, "Non-Power-of-Two Mipmapping"). The mean of all pixels is preserved. Values are averaged in linear light, as
/// images store it.
ImageRgb downsample(const ImageRgb& image);

/// Returns the mip levels below the image, each half the size of the one above, down to a single pixel (Williams
/// 1983, "Pyramidal Parametrics"). The result is empty for an image of one pixel. Together the levels take a third of
/// the image's size.
std::vector<ImageRgb> make_mip_levels(const ImageRgb& image);

} // namespace duet
