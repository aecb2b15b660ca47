// Random numbers, and pixels that are the average of many samples.
#pragma once

#include "common/image/image.h"

#include <cstdint>

namespace duet::lesson {

/// A stream of random numbers: PCG32 (O'Neill 2014). The same seed gives the same numbers.
class Random {
    std::uint64_t state_;

public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) { next(), next(); }

    /// The next number, uniform in [0, 1).
    float next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005u + 1442695040888963407u;
        const auto mixed = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
        const auto turn = static_cast<std::uint32_t>(old >> 59);
        const std::uint32_t bits = (mixed >> turn) | (mixed << ((32 - turn) & 31));
        return static_cast<float>(bits >> 8) * 0x1p-24f;
    }
};

/// Where in its pixel the sample number i of `samples` lies: anywhere in the square from (0, 0) to (1, 1).
inline Vec2 random_offset(int /*i*/, int /*samples*/, Random& random) { return {random.next(), random.next()}; }
using Offset = Vec2 (*)(int i, int samples, Random& random);

/// A picture whose pixel (column, row) is the mean of color(x, y, random) over points (x, y), in pixels, that `offset`
/// spreads over the pixel's square. Row 0 is the top row. (Ray Tracing in One Weekend, §8)
template <typename Color>
ImageRgb average_samples(int width, int height, int samples, const Color& color, Offset offset = random_offset) {
    ImageRgb image(width, height);
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            Random random(static_cast<std::uint64_t>(row * width + column));
            Rgb sum;
            for (int i = 0; i < samples; ++i) {
                const Vec2 p = Vec2(static_cast<float>(column), static_cast<float>(row)) + offset(i, samples, random);
                sum += color(p.x, p.y, random);
            }
            image(column, row) = sum / static_cast<float>(samples);
        }
    return image;
}

} // namespace duet::lesson
