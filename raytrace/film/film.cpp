#include "raytrace/film/film.h"

#include "common/rendering.h"

#include <algorithm>
#include <cmath>
#include <functional>

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

Rgbd Film::Pixel::mean() const {
    const double n = static_cast<double>(count[0]) + static_cast<double>(count[1]);
    return n > 0 ? (sum[0] + sum[1]) / n : Rgbd();
}

// Let the replicates have n₀ and n₁ samples, each of variance s. Then E (m₀ − m₁)² = s (1/n₀ + 1/n₁).
// The mean of all samples has the variance s / (n₀ + n₁), which is E (m₀ − m₁)² times n₀·n₁ / (n₀ +
// n₁)². For replicates of equal size, this factor is 1/4.
Rgbd Film::Pixel::variance() const {
    if (count[0] == 0 || count[1] == 0) return Rgbd(std::numeric_limits<double>::infinity());
    const double n0 = count[0], n1 = count[1];
    const Rgbd difference = sum[0] / n0 - sum[1] / n1;
    return difference * difference * (n0 * n1 / sqr(n0 + n1));
}

std::uint32_t Film::min_samples_taken() const {
    std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
    for (const Pixel& pixel : pixels_) least = min(least, pixel.samples_taken());
    return least;
}

std::uint32_t Film::max_samples_taken() const {
    std::uint32_t most = 0;
    for (const Pixel& pixel : pixels_) most = max(most, pixel.samples_taken());
    return most;
}

std::int64_t Film::total_samples_taken() const {
    std::int64_t sum = 0;
    for (const Pixel& pixel : pixels_) sum += pixel.samples_taken();
    return sum;
}

bool Film::complete() const {
    return std::ranges::all_of(pixels_, [](const Pixel& pixel) { return pixel.samples_taken() >= pixel.target; });
}

namespace {

// Returns the image of the values of get(pixel).
template <typename Get> auto image_of(const Image<Film::Pixel>& pixels, const Get& get) {
    Image<decltype(get(pixels[0]))> image(pixels.width(), pixels.height());
    for (std::size_t i = 0; i < pixels.size(); ++i) image[i] = get(pixels[i]);
    return image;
}

} // namespace

ImageRgb Film::image() const {
    return image_of(pixels_, [](const Pixel& pixel) { return Rgb(pixel.mean()); });
}

ImageRgb Film::variance_image() const {
    return image_of(pixels_, [](const Pixel& pixel) {
        Rgbd all = pixel.variance();
        if (is_finite(all)) // a very bright mean may overflow a float
            for (std::size_t c = 0; c < 3; ++c) all[c] = min(all[c], double{std::numeric_limits<float>::max()});
        return Rgb(all);
    });
}

Image<std::uint32_t> Film::samples_image() const { return image_of(pixels_, std::mem_fn(&Pixel::samples)); }

std::int64_t Film::invalid_samples() const {
    std::int64_t count = 0;
    for (const Pixel& pixel : pixels_) count += pixel.invalid;
    return count;
}

double Film::estimated_relmse() const {
    const Image<Rgbd> means = image_of(pixels_, std::mem_fn(&Pixel::mean));
    double sum = 0;
    std::size_t known = 0;
    for (int y = 0; y < height(); ++y)
        for (int x = 0; x < width(); ++x) {
            const Rgbd m = means(x, y), v = variance(x, y);
            if (!is_finite(v)) continue;
            ++known;
            Rgbd neighbor_max;
            for_each_neighbor(width(), height(), x, y, [&](int i, int j) {
                for (std::size_t c = 0; c < 3; ++c) neighbor_max[c] = std::max(neighbor_max[c], means(i, j)[c]);
            });
            for (std::size_t c = 0; c < 3; ++c) {
                const double lower = std::max(m[c] - std::sqrt(v[c]), 0.0);
                sum += v[c] / (sqr(std::min(m[c], std::max(neighbor_max[c], lower))) + 0.01);
            }
        }
    return 2 * known >= pixels_.size() ? sum / (3.0 * static_cast<double>(known)) : -1;
}

} // namespace duet
