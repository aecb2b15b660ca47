// Pictures that are compared pixel by pixel have one size.
#pragma once

#include "common/image/image.h"

namespace duet::compare {

/// Throws Error, which names both sizes, where the pictures differ in size.
template <typename PixelA, typename PixelB> void check_same_size(const Image<PixelA>& a, const Image<PixelB>& b) {
    if (a.width() != b.width() || a.height() != b.height())
        throw Error(
            message("the pictures differ in size: ", a.width(), "x", a.height(), " and ", b.width(), "x", b.height()));
}

} // namespace duet::compare
