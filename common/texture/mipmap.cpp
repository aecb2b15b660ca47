#include "common/texture/mipmap.h"

#include <algorithm>

namespace duet {

namespace {

/// FilterTaps lists the 1 to 3 pixels in a row of `from` pixels that the i-th pixel of a row of `to` covers, with the
/// weight of each.
struct FilterTaps {
    int first = 0, count = 0;
    float weight[3] = {};

    FilterTaps(int i, int from, int to) {
        const double scale = static_cast<double>(from) / to;
        const double low = i * scale, high = i + 1 == to ? from : (i + 1) * scale;
        first = static_cast<int>(low);
        for (int x = first; x < from && x < high && count < 3; ++x)
            weight[count++] = static_cast<float>((std::min(x + 1.0, high) - std::max<double>(x, low)) / scale);
    }
};

} // namespace

ImageRgb downsample(const ImageRgb& image) {
    const int width = std::max(image.width() / 2, 1), height = std::max(image.height() / 2, 1);
    ImageRgb rows(image.width(), height), result(width, height);
    for (int y = 0; y < height; ++y) {
        const FilterTaps taps(y, image.height(), height);
        for (int x = 0; x < image.width(); ++x)
            for (int k = 0; k < taps.count; ++k) rows(x, y) += image(x, taps.first + k) * taps.weight[k];
    }
    for (int x = 0; x < width; ++x) {
        const FilterTaps taps(x, image.width(), width);
        for (int y = 0; y < height; ++y)
            for (int k = 0; k < taps.count; ++k) result(x, y) += rows(taps.first + k, y) * taps.weight[k];
    }
    return result;
}

std::vector<ImageRgb> make_mip_levels(const ImageRgb& image) {
    std::vector<ImageRgb> levels;
    const ImageRgb* last = &image;
    while (last->size() > 1) {
        levels.push_back(downsample(*last));
        last = &levels.back();
    }
    return levels;
}

} // namespace duet
