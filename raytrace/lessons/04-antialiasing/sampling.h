// Random numbers, and pixels that are the average of many samples.
#pragma once

#include "common/image/image.h"

#include <cstdint>

namespace duet::lesson {

/// A stream of random numbers: PCG32 (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient ... Generators").
/// The same seed gives the same numbers, so a picture can be rendered twice and compared.
class Random {
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

private:
    std::uint64_t state_;
};

/// A picture whose pixel (column, row) is the mean of color(x, y, random) over points (x, y), in pixels, spread at
/// random over the pixel's square. Row 0 is the top row. (Ray Tracing in One Weekend, §8)
template <typename Color>
ImageRgb average_samples(int width, int height, int samples, const Color& color) {
    ImageRgb image(width, height);
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            Random random(static_cast<std::uint64_t>(row * width + column));
            Rgb sum;
            for (int i = 0; i < samples; ++i) {
                const float x = static_cast<float>(column) + random.next();
                const float y = static_cast<float>(row) + random.next();
                sum += color(x, y, random);
            }
            image(column, row) = sum / static_cast<float>(samples);
        }
    return image;
}

} // namespace duet::lesson
