#include "raytrace/film/film.h"

#include "common/rendering.h"

#include <algorithm>
#include <cmath>

namespace duet {

Film::Film(int width, int height) : pixels_(width, height) {}

bool Film::add(int x, int y, std::size_t replicate, Rgb sample) {
    Pixel& pixel = pixels_(x, y);
    if (!is_valid_radiance(sample)) {
        ++pixel.invalid;
        return false;
    }
    pixel.sum[replicate] += Rgbd(sample);
    ++pixel.count[replicate];
    return true;
}

Rgbd Film::mean(int x, int y) const {
    const Pixel& pixel = pixels_(x, y);
    const double n = static_cast<double>(pixel.count[0]) + static_cast<double>(pixel.count[1]);
    return n > 0 ? (pixel.sum[0] + pixel.sum[1]) / n : Rgbd();
}

// Let the replicates have n₀ and n₁ samples, each of variance s. Then E (m₀ − m₁)² = s (1/n₀ + 1/n₁).
// The mean of all samples has the variance s / (n₀ + n₁), which is E (m₀ − m₁)² times n₀·n₁ / (n₀ +
// n₁)². For replicates of equal size, this factor is 1/4.
Rgbd Film::variance(int x, int y) const {
    const Pixel& pixel = pixels_(x, y);
    if (pixel.count[0] == 0 || pixel.count[1] == 0) return Rgbd(std::numeric_limits<double>::infinity());
    const double n0 = pixel.count[0], n1 = pixel.count[1];
    const Rgbd difference = pixel.sum[0] / n0 - pixel.sum[1] / n1;
    return difference * difference * (n0 * n1 / sqr(n0 + n1));
}

std::uint32_t Film::samples(int x, int y) const { return pixels_(x, y).count[0] + pixels_(x, y).count[1]; }

std::uint32_t Film::samples_taken(int x, int y) const { return samples(x, y) + invalid(x, y); }

std::uint32_t Film::min_samples_taken() const {
    std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
    for (int y = 0; y < height(); ++y)
        for (int x = 0; x < width(); ++x) least = min(least, samples_taken(x, y));
    return least;
}

std::int64_t Film::total_samples_taken() const {
    std::int64_t sum = 0;
    for (int y = 0; y < height(); ++y)
        for (int x = 0; x < width(); ++x) sum += samples_taken(x, y);
    return sum;
}

bool Film::complete() const {
    for (int y = 0; y < height(); ++y)
        for (int x = 0; x < width(); ++x)
            if (samples_taken(x, y) < pixels_(x, y).target) return false;
    return true;
}

ImageRgb Film::image() const {
    ImageRgb image(width(), height());
    for (int y = 0; y < height(); ++y)
        for (int x = 0; x < width(); ++x) image(x, y) = Rgb(mean(x, y));
    return image;
}

ImageRgb Film::variance_image() const {
    ImageRgb image(width(), height());
    for (int y = 0; y < height(); ++y)
        for (int x = 0; x < width(); ++x) {
            Rgbd all = variance(x, y);
            if (is_finite(all)) // a very bright mean may overflow a float
                for (std::size_t c = 0; c < 3; ++c) all[c] = min(all[c], double{std::numeric_limits<float>::max()});
            image(x, y) = Rgb(all);
        }
    return image;
}

Image<std::uint32_t> Film::samples_image() const {
    Image<std::uint32_t> image(width(), height());
    for (int y = 0; y < height(); ++y)
        for (int x = 0; x < width(); ++x) image(x, y) = samples(x, y);
    return image;
}

std::int64_t Film::invalid_samples() const {
    std::int64_t count = 0;
    for (const Pixel& pixel : pixels_) count += pixel.invalid;
    return count;
}

namespace {

// Returns the maximum of each channel over the up to eight neighbors of a pixel.
Rgbd brightest_neighbor(const Image<Rgbd>& means, int x, int y) {
    Rgbd brightest;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, means.height() - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, means.width() - 1); ++i)
            if (i != x || j != y)
                for (std::size_t c = 0; c < 3; ++c) brightest[c] = std::max(brightest[c], means(i, j)[c]);
    return brightest;
}

} // namespace

double Film::estimated_relmse() const {
    Image<Rgbd> means(width(), height());
    for (int y = 0; y < height(); ++y)
        for (int x = 0; x < width(); ++x) means(x, y) = mean(x, y);
    double sum = 0;
    std::size_t known = 0;
    for (int y = 0; y < height(); ++y)
        for (int x = 0; x < width(); ++x) {
            const Rgbd m = means(x, y), v = variance(x, y);
            if (!is_finite(v)) continue;
            ++known;
            const Rgbd neighbor_max = brightest_neighbor(means, x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                const double lower = std::max(m[c] - std::sqrt(v[c]), 0.0);
                sum += v[c] / (sqr(std::min(m[c], std::max(neighbor_max[c], lower))) + 0.01);
            }
        }
    return 2 * known >= pixels_.size() ? sum / (3.0 * static_cast<double>(known)) : -1;
}

} // namespace duet
