// These functions test whether two values or two images are bitwise equal.
#pragma once

#include "common/image/image.h"

#include <algorithm>
#include <span>
#include <type_traits>

namespace duet {

/// Returns whether two values have the same bits. Unlike ==, this function distinguishes −0 from 0, and a NaN equals
/// itself. The type must have no padding.
template <typename Value> bool bitwise_equal(const Value& a, const Value& b) {
    static_assert(std::is_trivially_copyable_v<Value>);
    return std::ranges::equal(std::as_bytes(std::span(&a, 1)), std::as_bytes(std::span(&b, 1)));
}

/// Returns whether two images have the same size and bitwise equal pixels. Two empty images are equal.
template <typename Pixel> bool bitwise_equal(const Image<Pixel>& a, const Image<Pixel>& b) {
    static_assert(std::is_trivially_copyable_v<Pixel>);
    return a.width() == b.width() && a.height() == b.height() &&
           std::ranges::equal(std::as_bytes(std::span(a.pixels())), std::as_bytes(std::span(b.pixels())));
}

} // namespace duet
