#include "raytrace/denoise/denoise.h"

#include "common/rendering.h"
#include "raytrace/denoise/filter_selection.h"

namespace duet::raytrace {

ImageRgb denoise(const Film& film, const Planes& features, int threads) {
    const HalfBuffers halves = half_buffers(film, threads);
    const Corrections corrections = cross_filter(halves, features, threads);
    const Planes fractions = select_filters(halves, corrections, threads);

    ImageRgb image = film.image();
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            if (*halves.known.at(0, x, y) == 0) continue;
            const Film::Pixel& pixel = film.pixels()(x, y);
            const auto n0 = static_cast<float>(pixel.count[0]), n1 = static_cast<float>(pixel.count[1]);
            Rgb filtered = image(x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                for (std::size_t k = 0; k < kFilters; ++k)
                    filtered[c] += *fractions.at(k, x, y) *
                                   (n0 * *corrections[0][k].at(c, x, y) + n1 * *corrections[1][k].at(c, x, y)) /
                                   (n0 + n1);
                filtered[c] = std::max(filtered[c], 0.0f);
            }
            if (is_valid_radiance(filtered)) image(x, y) = filtered;
        }
    return image;
}

} // namespace duet::raytrace
