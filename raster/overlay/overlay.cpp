#include "raster/overlay/overlay.h"

#include "common/system/parallel.h"
#include "raster/overlay/lines.h"

namespace duet::raster {

bool draws_edges(const RasterSettings& settings) { return settings.edges || settings.shading == Shading::kEdges; }

void Overlay::add_lines(const PassView& view) {
    for (const SampleOffset offset : view.samples) {
        Image<std::uint8_t> marks(sums_.width(), sums_.height(), 0);
        draw_lines(data_, view, offset, settings_.threads, marks);
        for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += marks[i];
        ++samples_;
    }
}

void Overlay::add_edges(const EdgeBuffer& edge_buffer) {
    parallel_for(static_cast<std::size_t>(sums_.height()), settings_.threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < sums_.width(); ++x) sums_(x, y) += edge_strength(edge_buffer, x, y);
    });
    ++samples_;
}

void Overlay::composite(ImageRgb& image) const {
    if (samples_ == 0) return;
    for (std::size_t i = 0; i < image.size(); ++i) {
        const float covered = sums_[i] / static_cast<float>(samples_);
        image[i] = settings_.shading == Shading::kLines   ? Rgb(covered)
                   : settings_.shading == Shading::kEdges ? Rgb(1 - covered)
                                                          : image[i] * (1 - covered);
    }
}

} // namespace duet::raster
