// Whether two values or two pictures are the same to the bit.
#pragma once

#include "common/image/image.h"

#include <algorithm>
#include <span>
#include <type_traits>

namespace duet {

/// Unlike ==, −0 is not 0, and a NaN is itself. For types without padding.
template <typename Value> bool same_bits(const Value& a, const Value& b) {
    static_assert(std::is_trivially_copyable_v<Value>);
    return std::ranges::equal(std::as_bytes(std::span(&a, 1)), std::as_bytes(std::span(&b, 1)));
}

/// Pictures of one size, and each pixel the same; empty ones are.
template <typename Pixel> bool same_bits(const Image<Pixel>& a, const Image<Pixel>& b) {
    static_assert(std::is_trivially_copyable_v<Pixel>);
    return a.width() == b.width() && a.height() == b.height() &&
           std::ranges::equal(std::as_bytes(std::span(a.pixels())), std::as_bytes(std::span(b.pixels())));
}

} // namespace duet
