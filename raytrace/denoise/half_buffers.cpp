#include "raytrace/denoise/half_buffers.h"

#include "common/system/parallel.h"
#include "raytrace/denoise/box_filter.h"

namespace duet::raytrace {

namespace {

constexpr int kVarianceRadius = 2;
constexpr float kFireflyRatio = 2;
// Brighter pixels are not denoised, because their squares would overflow a float.
constexpr double kMaxMean = 1e15;

Rgbd mean(const Film::Pixel& pixel, std::size_t half) {
    return pixel.sum[half] / static_cast<double>(pixel.count[half]);
}

bool is_known(const Film::Pixel& pixel) {
    for (std::size_t half = 0; half < 2; ++half)
        if (pixel.count[half] == 0 || !(max_component(mean(pixel, half)) <= kMaxMean)) return false;
    return true;
}

// Returns the variance of one sample for each known pixel.
Planes sample_variance(const Film& film, const Planes& known) {
    Planes variance(film.width(), film.height(), 3);
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            if (*known.at(0, x, y) == 0) continue;
            const Film::Pixel& pixel = film.pixels()(x, y);
            const Rgbd of_sample = pixel.variance() * static_cast<double>(pixel.samples());
            for (std::size_t c = 0; c < 3; ++c) *variance.at(c, x, y) = static_cast<float>(of_sample[c]);
        }
    return variance;
}

// Returns the reliability of a known pixel of one half. See half_buffers.
float reliability(const std::array<Planes, 2>& mean, std::size_t half, int x, int y) {
    const auto brightness = [&](std::size_t h, int i, int j) {
        return *mean[h].at(0, i, j) + *mean[h].at(1, i, j) + *mean[h].at(2, i, j);
    };
    float limit = brightness(1 - half, x, y);
    for_each_neighbor(mean[0].width(), mean[0].height(), x, y, [&](int i, int j) {
        limit = std::max({limit, brightness(0, i, j), brightness(1, i, j)});
    });
    limit *= kFireflyRatio;
    const float own = brightness(half, x, y);
    return own > limit ? limit / own : 1;
}

} // namespace

HalfBuffers half_buffers(const Film& film, int threads) {
    const int width = film.width(), height = film.height();
    HalfBuffers halves(width, height);
    const auto for_pixels = [&](const auto& visit) {
        parallel_for(static_cast<std::size_t>(height), threads, [&](std::size_t y) {
            for (int x = 0; x < width; ++x) visit(x, static_cast<int>(y), film.pixels()(x, static_cast<int>(y)));
        });
    };
    for_pixels([&](int x, int y, const Film::Pixel& pixel) {
        if (!is_known(pixel)) return;
        *halves.known.at(0, x, y) = 1;
        for (std::size_t half = 0; half < 2; ++half)
            for (std::size_t c = 0; c < 3; ++c)
                *halves.mean[half].at(c, x, y) = static_cast<float>(mean(pixel, half)[c]);
    });
    const Planes variance = box_filter(sample_variance(film, halves.known), kVarianceRadius, threads);
    const Planes known_fraction = box_filter(halves.known, kVarianceRadius, threads);
    for_pixels([&](int x, int y, const Film::Pixel& pixel) {
        if (*halves.known.at(0, x, y) == 0) return;
        for (std::size_t half = 0; half < 2; ++half) {
            const float samples = static_cast<float>(pixel.count[half]) * *known_fraction.at(0, x, y);
            for (std::size_t c = 0; c < 3; ++c) *halves.variance[half].at(c, x, y) = *variance.at(c, x, y) / samples;
            *halves.reliability[half].at(0, x, y) = reliability(halves.mean, half, x, y);
        }
    });
    for (std::size_t half = 0; half < 2; ++half) {
        halves.mean[half].extend_to_border();
        halves.variance[half].extend_to_border();
    }
    return halves;
}

} // namespace duet::raytrace
