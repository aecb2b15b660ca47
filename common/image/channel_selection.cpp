#include "common/image/channel_selection.h"

namespace duet {

namespace {

/// Returns the index of a channel among the values of a pixel, or −1 for the alpha of a file without alpha.
int channel_index(ChannelSelection::Channel channel, int channels) {
    const bool has_alpha = channels == 2 || channels == 4, gray = channels < 3;
    switch (channel) {
    case ChannelSelection::Channel::kGreen:
        return gray ? 0 : 1;
    case ChannelSelection::Channel::kBlue:
        return gray ? 0 : 2;
    case ChannelSelection::Channel::kAlpha:
        return has_alpha ? channels - 1 : -1;
    case ChannelSelection::Channel::kOpacity:
        return has_alpha ? channels - 1 : 0;
    case ChannelSelection::Channel::kAll:
    case ChannelSelection::Channel::kRed:
        break;
    }
    return 0;
}

} // namespace

ImageRgb select_channels(StoredImage file, ChannelSelection selection) {
    using Channel = ChannelSelection::Channel;
    const bool has_alpha = file.channels == 2 || file.channels == 4;
    const bool is_alpha = selection.channel == Channel::kAlpha || (selection.channel == Channel::kOpacity && has_alpha);
    // Alpha is linear in every file format.
    if (selection.values == ChannelSelection::Values::kData || is_alpha) file.encoding = StoredImage::Encoding::kLinear;
    if (selection.channel == Channel::kAll) return to_linear(file);
    const int channel = channel_index(selection.channel, file.channels);
    const auto channels = static_cast<std::size_t>(file.channels);
    for (std::size_t pixel = 0; pixel < file.values.size(); pixel += channels) {
        const float value = channel < 0 ? 1.0f : file.values[pixel + static_cast<std::size_t>(channel)];
        for (std::size_t c = 0; c < channels; ++c) file.values[pixel + c] = value;
    }
    return to_linear(file);
}

} // namespace duet
