// Sorts the indices of rays or paths into a few classes, so that all elements of a class are processed together.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace duet::raytrace {

/// Writes `indices` to `sorted` class by class, in their order within each class, and returns where each class ends.
/// class_of(index) must be below kClasses, which is at most 256. `classes` is scratch memory; it and `sorted` must
/// be at least as long as `indices`.
///
/// It is a counting sort with separate counts for two halves, because an increment of a count that was just written
/// has to wait for that store.
template <std::size_t kClasses, typename ClassOf>
std::array<std::uint32_t, kClasses> sort_by_class(std::span<const std::uint32_t> indices, const ClassOf& class_of,
                                                  std::span<std::uint8_t> classes, std::span<std::uint32_t> sorted) {
    static_assert(kClasses <= 256);
    const std::size_t size = indices.size(), half = size / 2;
    std::array<std::uint32_t, kClasses> low{}, high{}, ends;
    const auto count = [&](std::size_t k, auto& counts) {
        ++counts[classes[k] = static_cast<std::uint8_t>(class_of(indices[k]))];
    };
    for (std::size_t k = 0; k < half; ++k) count(k, low), count(half + k, high);
    if (size % 2 != 0) count(size - 1, high);
    std::uint32_t begin = 0;
    for (std::size_t c = 0; c < kClasses; ++c) {
        const std::uint32_t in_low = low[c], in_high = high[c];
        low[c] = begin;
        high[c] = begin + in_low;
        ends[c] = begin += in_low + in_high;
    }
    const auto put = [&](std::size_t k, auto& next) { sorted[next[classes[k]]++] = indices[k]; };
    for (std::size_t k = 0; k < half; ++k) put(k, low), put(half + k, high);
    if (size % 2 != 0) put(size - 1, high);
    return ends;
}

} // namespace duet::raytrace
