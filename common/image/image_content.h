// What of a picture file makes an image.
#pragma once

#include "common/image/image_file.h"

namespace duet {

/// Values are colours, decoded from sRGB where the file's kind is encoded so, or data, as they are stored. Channel: all
/// three, or one of them or of alpha (1 where the file has none) as a grey; kOpacity is alpha, or red where there is none.
struct ImageContent {
    enum class Values { kColors, kData };
    enum class Channel { kAll, kRed, kGreen, kBlue, kAlpha, kOpacity };
    Values values = Values::kColors;
    Channel channel = Channel::kAll;
};

/// In linear RGB.
ImageRgb image_of(PixelFile file, ImageContent content);

} // namespace duet
