// This file checks that two images have the same size, for metrics that compare them pixel by pixel.
#pragma once

#include "common/image/image.h"

namespace duet::compare {

/// Throws Error, with both sizes, if the images differ in size.
template <typename PixelA, typename PixelB> void check_same_size(const Image<PixelA>& a, const Image<PixelB>& b) {
    if (a.width() != b.width() || a.height() != b.height())
        throw Error(
            message("the images differ in size: ", a.width(), "x", a.height(), " and ", b.width(), "x", b.height()));
}

} // namespace duet::compare
