// This file selects which values of an image file form an image.
#pragma once

#include "common/image/image_file.h"

namespace duet {

/// Colors (kColors) are decoded from sRGB if the file format is sRGB-encoded; data (kData) are used as stored. The
/// channel is either all three colors or one channel, which is then copied to R, G and B. Alpha is 1 if the file has
/// none. kOpacity selects alpha, or red if the file has no alpha.
struct ChannelSelection {
    enum class Values { kColors, kData };
    enum class Channel { kAll, kRed, kGreen, kBlue, kAlpha, kOpacity };
    Values values = Values::kColors;
    Channel channel = Channel::kAll;
};

/// Returns the selected channels of a file as linear RGB.
ImageRgb select_channels(StoredImage file, ChannelSelection selection);

} // namespace duet
