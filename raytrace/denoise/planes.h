// Declares Planes, the image layout of the denoiser's SIMD loops: one plane of floats per channel, with a border.
#pragma once

#include "common/system/huge_pages.h"
#include "common/vec/simd.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace duet::raytrace {

/// Holds horizontally neighboring pixels, one per lane.
using PixelBatch = FloatBatch<kMaxSimdLanes>;
/// This is the number of pixels of a batch, in the type of coordinates.
inline constexpr int kBatchWidth = static_cast<int>(kMaxSimdLanes);

/// Stores `count` floats per pixel, initially 0. Each plane has a border around the image. A window around any pixel,
/// and a batch that begins inside the image, can thus be read without a test.
class Planes {
public:
    /// This is the width of the border in pixels. It has room for a tile, a window's radius, a patch's radius, and the
    /// rest of a batch.
    static constexpr int kBorder = 64;

    Planes(int width, int height, std::size_t count)
        : width_(width), height_(height), count_(count), stride_(static_cast<std::size_t>(width + 2 * kBorder)),
          values_(stride_ * static_cast<std::size_t>(height + 2 * kBorder) * count) {
        std::fill(values_.begin(), values_.end(), 0.0f); // the allocator leaves them uninitialized
    }

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t count() const { return count_; }

    /// Returns the address of a pixel's value in a plane. x and y may be outside of the image by up to kBorder.
    float* at(std::size_t plane, int x, int y) { return values_.data() + index(plane, x, y); }
    const float* at(std::size_t plane, int x, int y) const { return values_.data() + index(plane, x, y); }
    /// Loads a batch of pixels from (x, y) to the right.
    PixelBatch load(std::size_t plane, int x, int y) const { return PixelBatch::load_unaligned(at(plane, x, y)); }
    /// Stores a batch of pixels from (x, y) to the right.
    void store(std::size_t plane, int x, int y, PixelBatch batch) { batch.store_unaligned(at(plane, x, y)); }

    /// Fills the border of all planes with the values of the nearest pixels.
    void extend_to_border() {
        for (std::size_t plane = 0; plane < count_; ++plane)
            for (int y = -kBorder; y < height_ + kBorder; ++y) {
                float* const row = at(plane, 0, y);
                const float* const nearest = at(plane, 0, std::clamp(y, 0, height_ - 1));
                if (nearest != row) std::copy(nearest, nearest + width_, row);
                std::fill(row - kBorder, row, row[0]);
                std::fill(row + width_, row + width_ + kBorder, row[width_ - 1]);
            }
    }

private:
    std::size_t index(std::size_t plane, int x, int y) const {
        const auto row =
            static_cast<std::size_t>(y + kBorder) + plane * static_cast<std::size_t>(height_ + 2 * kBorder);
        return row * stride_ + static_cast<std::size_t>(x + kBorder);
    }
    int width_, height_;
    std::size_t count_, stride_;
    std::vector<float, HugePageAllocator<float>> values_;
};

} // namespace duet::raytrace
