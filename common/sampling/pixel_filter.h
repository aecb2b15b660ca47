// How a pixel weighs the light around its centre.
#pragma once

#include "common/vec/vec.h"

#include <string_view>
#include <vector>

namespace duet {

enum class FilterKind {
    kBox,            ///< 1 within the pixel: neighbours share no light, which is what comparisons of pipelines want
    kBlackmanHarris, ///< a smooth bell over three pixels by three: edges are as sharp, and do not crawl in motion
};
/// "box", "blackman-harris"; throws Error for another name.
FilterKind filter_kind(std::string_view name);
std::string_view filter_name(FilterKind kind);

/// A filter that is nowhere negative, as a density of samples: all weigh the same, and pixels need nothing of each
/// other's samples (Ernst, Stamminger and Greiner 2006, «Filter Importance Sampling»).
class PixelFilter {
public:
    explicit PixelFilter(FilterKind kind);

    /// Where a sample lies, relative to the pixel's centre, in pixels; u in [0, 1)². (½, ½) is the centre.
    Vec2d sample(Vec2 u) const {
        const Vec2d exact(u);
        if (quantiles_.empty()) return {exact.x - 0.5, exact.y - 0.5};
        return {sample_axis(exact.x), sample_axis(exact.y)};
    }

private:
    double sample_axis(double u) const;

    std::vector<double> quantiles_; ///< of one axis, at even steps of the probability; empty: a box
};

} // namespace duet
