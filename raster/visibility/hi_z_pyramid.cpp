#include "raster/visibility/hi_z_pyramid.h"

#include <algorithm>
#include <bit>

namespace duet::raster {

HiZPyramid::HiZPyramid(ImageFloat image) {
    levels_.push_back(std::move(image));
    while (levels_.back().size() > 1) {
        const ImageFloat& fine = levels_.back();
        ImageFloat coarse((fine.width() + 1) / 2, (fine.height() + 1) / 2);
        for (int y = 0; y < coarse.height(); ++y) {
            const int top = 2 * y, bottom = std::min(top + 1, fine.height() - 1);
            for (int x = 0; x < coarse.width(); ++x) {
                const int left = 2 * x, right = std::min(left + 1, fine.width() - 1);
                coarse(x, y) = std::max(std::max(fine(left, top), fine(right, top)),
                                        std::max(fine(left, bottom), fine(right, bottom)));
            }
        }
        levels_.push_back(std::move(coarse));
    }
}

float HiZPyramid::max_over(int x0, int y0, int x1, int y1) const {
    const int extent = std::max(x1 - x0, y1 - y0);
    // Use blocks at least as large as the region, so that it overlaps at most two along each side.
    const auto bits = static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(extent)));
    const auto level = std::min(bits, levels_.size() - 1);
    const ImageFloat& blocks = levels_[level];
    const int shift = static_cast<int>(level);
    x0 >>= shift, x1 >>= shift, y0 >>= shift, y1 >>= shift;
    return std::max(std::max(blocks(x0, y0), blocks(x1, y0)), std::max(blocks(x0, y1), blocks(x1, y1)));
}

std::int64_t HiZPyramid::memory_bytes() const {
    std::size_t count = 0;
    for (const ImageFloat& level : levels_) count += level.size();
    return static_cast<std::int64_t>(count * sizeof(float));
}

} // namespace duet::raster
