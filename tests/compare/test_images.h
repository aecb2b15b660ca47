// This header generates pairs of images in integer arithmetic, so that other programs can reproduce them
// (tests/golden/README.md).
#pragma once

#include "common/image/image.h"

#include <cstdint>

namespace duet::compare {

struct TestPair {
    ImageRgb test, reference;
};

/// Returns an even number from 0 to 2^24 − 1.
inline std::uint32_t pixel_noise(std::uint32_t x, std::uint32_t y, std::uint32_t c) {
    std::uint32_t h = (x * 73856093u) ^ (y * 19349663u) ^ (c * 83492791u);
    h = h * 1664525u + 1013904223u;
    h ^= h >> 15;
    h *= 2246822519u;
    h ^= h >> 13;
    return h >> 8;
}

/// Returns a checkerboard of gradients in different colors, 0 to 255.
inline int pattern(int x, int y, int c) {
    return ((x / 12 + y / 9) % 2 * 110 + x * (1 + c) / 2 + y * (3 - c) / 2) % 256;
}

/// Fills both images: set(x, y, value of the pattern, noise, test, reference) sets the two values of a channel.
template <typename Set> TestPair make_pair_of(int width, int height, const Set& set) {
    TestPair pair{ImageRgb(width, height), ImageRgb(width, height)};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
                const auto u = [](int v) { return static_cast<std::uint32_t>(v); };
                set(x, y, pattern(x, y, c), pixel_noise(u(x), u(y), u(c)), pair.test(x, y)[u(c)],
                    pair.reference(x, y)[u(c)]);
            }
    return pair;
}

/// Returns 8-bit values / 255. The test image has additional noise of up to ±24.
inline TestPair encoded_pair(int width = 96, int height = 70) {
    return make_pair_of(width, height, [](int, int, int value, std::uint32_t noise, float& test, float& reference) {
        reference = static_cast<float>(value) / 255.0f;
        test = static_cast<float>(clamp(value + static_cast<int>(noise * std::uint64_t{49} >> 24) - 24, 0, 255)) /
               255.0f;
    });
}

/// Returns linear values up to 4 and a light of 30. The test image is scaled by factors of 0.5 to 1.5.
inline TestPair linear_pair(int width = 96, int height = 70) {
    return make_pair_of(width, height, [](int x, int y, int value, std::uint32_t noise, float& test, float& reference) {
        const bool area_light = x / 8 == 5 && y / 8 == 3;
        reference = area_light ? 30.0f : static_cast<float>(value * value) / 16384.0f; // exact
        test = reference * (0.5f + static_cast<float>(noise) / 16777216.0f);           // rounded to float
    });
}

} // namespace duet::compare
