// Declares the pixel reconstruction filters.
#pragma once

#include "common/vec/vec.h"

#include <string_view>
#include <vector>

namespace duet {

enum class FilterKind {
    kBox,            ///< 1 inside the pixel, 0 outside; pixels share no samples, so comparisons of the pipelines use it
    kBlackmanHarris, ///< smooth window over 3 × 3 pixels: edges stay sharp, and are stable in motion
};
/// Returns the filter named "box" or "blackman-harris". Throws an Error for another name.
FilterKind filter_kind(std::string_view name);
/// Returns the name that filter_kind() accepts for a filter.
std::string_view filter_name(FilterKind kind);

/// Distributes sample positions in proportion to the filter, which must not be negative. All samples then have the same
/// weight, and each pixel uses only its own samples (Ernst, Stamminger and Greiner 2006, "Filter Importance Sampling").
class PixelFilter {
public:
    explicit PixelFilter(FilterKind kind);

    /// Maps a uniform sample u in [0, 1)² to a position relative to the pixel center, in pixels. (½, ½) maps to the
    /// center.
    Vec2d sample(Vec2 u) const {
        const Vec2d exact(u);
        if (quantiles_.empty()) return {exact.x - 0.5, exact.y - 0.5};
        return {sample_axis(exact.x), sample_axis(exact.y)};
    }

private:
    double sample_axis(double u) const;

    std::vector<double> quantiles_; ///< quantiles of one axis at equal steps of probability; empty for the box
};

} // namespace duet
