// Smooth edges: draw a picture larger, then average blocks of its pixels.
#pragma once

#include "common/image/image.h"

namespace duet::lesson {

/// A picture of 1/n of the width and height: each of its pixels is the average of n × n pixels (of linear light).
inline ImageRgb shrink(const ImageRgb& large, int n) {
    ImageRgb small(large.width() / n, large.height() / n);
    for (int y = 0; y < small.height() * n; ++y)
        for (int x = 0; x < small.width() * n; ++x) small(x / n, y / n) += large(x, y) / static_cast<float>(n * n);
    return small;
}

} // namespace duet::lesson
