// This file defines images in memory. Rows are stored from the top, and pixels from the left.
#pragma once

#include "common/image/rgb.h"
#include "common/system/huge_pages.h"
#include "common/system/error.h"

#include <vector>

namespace duet {

/// A rendered image has at most this width and height, in pixels.
inline constexpr int kMaxRenderSide = 16384;

/// An image has width × height pixels of any type. Pixel (0, 0) is at the upper left. The access operators do not
/// check their arguments.
template <typename Pixel> class Image {
public:
    Image() = default;
    Image(int width, int height, const Pixel& fill = Pixel{})
        : width_(width), height_(height),
          pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {}

    int width() const { return width_; }
    int height() const { return height_; }
    bool empty() const { return pixels_.empty(); }
    std::size_t size() const { return pixels_.size(); }

    const Pixel& operator()(int x, int y) const { return pixels_[index(x, y)]; }
    Pixel& operator()(int x, int y) { return pixels_[index(x, y)]; }
    const Pixel& operator[](std::size_t i) const { return pixels_[i]; }
    Pixel& operator[](std::size_t i) { return pixels_[i]; }
    using Pixels = std::vector<Pixel, HugePageAllocator<Pixel>>;
    const Pixels& pixels() const { return pixels_; }
    Pixels& pixels() { return pixels_; }
    auto begin() const { return pixels_.begin(); }
    auto end() const { return pixels_.end(); }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    int width_ = 0, height_ = 0;
    Pixels pixels_;
};

/// Calls visit(i, j) for each of the up to eight neighbors of pixel (x, y) in an image of this size, row by row.
template <typename Visit> void for_each_neighbor(int width, int height, int x, int y, const Visit& visit) {
    for (int j = max(y - 1, 0); j <= min(y + 1, height - 1); ++j)
        for (int i = max(x - 1, 0); i <= min(x + 1, width - 1); ++i)
            if (i != x || j != y) visit(i, j);
}

using ImageRgb = Image<Rgb>;
using ImageFloat = Image<float>;

} // namespace duet
