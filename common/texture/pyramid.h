// An image in ever smaller sizes, so that a look-up may average as much of it as a pixel sees.
#pragma once

#include "common/image/image.h"

#include <vector>

namespace duet {

/// The image at half its size, rounded down, but at least 1 pixel a side: each pixel is the mean over its area, exact for
/// any size (where a side is odd a pixel takes in parts of its neighbours': Guthe and Heckbert 2005, «Non-Power-of-Two
/// Mipmapping»). The mean of all pixels stays. In linear light, as images are.
ImageRgb halved(const ImageRgb& image);

/// The image halved, halved again and so on, to a single pixel (Williams 1983, «Pyramidal Parametrics»); none of an image
/// that is one already. Together a third of the image's size.
std::vector<ImageRgb> smaller_versions(const ImageRgb& image);

} // namespace duet
