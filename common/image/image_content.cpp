#include "common/image/image_content.h"

namespace duet {

namespace {

/// Returns the index of a channel among the values of a pixel, or −1 for the alpha of a file without alpha.
int index_of(ImageContent::Channel channel, int channels) {
    const bool has_alpha = channels == 2 || channels == 4, grey = channels < 3;
    switch (channel) {
    case ImageContent::Channel::kGreen:
        return grey ? 0 : 1;
    case ImageContent::Channel::kBlue:
        return grey ? 0 : 2;
    case ImageContent::Channel::kAlpha:
        return has_alpha ? channels - 1 : -1;
    case ImageContent::Channel::kOpacity:
        return has_alpha ? channels - 1 : 0;
    case ImageContent::Channel::kAll:
    case ImageContent::Channel::kRed:
        break;
    }
    return 0;
}

} // namespace

ImageRgb image_of(PixelFile file, ImageContent content) {
    using Channel = ImageContent::Channel;
    const bool has_alpha = file.channels == 2 || file.channels == 4;
    const bool is_alpha = content.channel == Channel::kAlpha || (content.channel == Channel::kOpacity && has_alpha);
    // Alpha is linear in every file format.
    if (content.values == ImageContent::Values::kData || is_alpha) file.encoding = PixelFile::Encoding::kLinear;
    if (content.channel == Channel::kAll) return to_linear(file);
    const int which = index_of(content.channel, file.channels);
    const auto channels = static_cast<std::size_t>(file.channels);
    for (std::size_t pixel = 0; pixel < file.values.size(); pixel += channels) {
        const float value = which < 0 ? 1.0f : file.values[pixel + static_cast<std::size_t>(which)];
        for (std::size_t c = 0; c < channels; ++c) file.values[pixel + c] = value;
    }
    return to_linear(file);
}

} // namespace duet
