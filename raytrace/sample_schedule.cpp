#include "raytrace/sample_schedule.h"

#include <algorithm>
#include <cmath>

namespace duet::raytrace {

namespace {

std::int64_t pixel_count(const Film& film) { return std::int64_t{film.width()} * film.height(); }

void add_to_all_targets(Film& film, std::uint32_t samples) {
    for (Film::Pixel& pixel : film.pixels().pixels()) pixel.target = pixel.samples_taken() + samples;
}

// Holds the mean over the channels of the variance of one sample, and of that variance divided by (mean² + 0.01). Both
// are negative if they are not known.
struct SampleVariance {
    double absolute = -1, relative = -1;
};
SampleVariance sample_variance(const Film::Pixel& pixel) {
    const Rgbd variance = pixel.variance(), mean = pixel.mean();
    if (!is_finite(variance)) return {};
    SampleVariance sum{0, 0};
    for (std::size_t c = 0; c < 3; ++c) {
        sum.absolute += variance[c];
        sum.relative += variance[c] / (sqr(mean[c]) + 0.01);
    }
    const double samples = pixel.samples();
    return {sum.absolute / 3 * samples, sum.relative / 3 * samples};
}

// Returns for each pixel the mean of its neighbors' known (nonnegative) values, or 0 if none is known.
Image<double> mean_of_neighbors(const Image<double>& own) {
    Image<double> result(own.width(), own.height());
    for (int y = 0; y < own.height(); ++y)
        for (int x = 0; x < own.width(); ++x) {
            double sum = 0;
            int known = 0;
            for_each_neighbor(own.width(), own.height(), x, y, [&](int i, int j) {
                if (own(i, j) < 0) return;
                sum += own(i, j);
                ++known;
            });
            result(x, y) = known > 0 ? sum / known : 0;
        }
    return result;
}

// Divides all values by their mean, if the mean is positive.
void normalize(Image<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v;
    const double mean = sum / static_cast<double>(values.size());
    if (mean > 0)
        for (std::size_t i = 0; i < values.size(); ++i) values[i] /= mean;
}

// Returns s for each pixel; see allocate_samples.
Image<double> smoothed_variance(const Film& film) {
    Image<double> absolute(film.width(), film.height()), relative(film.width(), film.height());
    for (std::size_t i = 0; i < absolute.size(); ++i) {
        const SampleVariance own = sample_variance(film.pixels()[i]);
        absolute[i] = own.absolute;
        relative[i] = own.relative;
    }
    Image<double> s = mean_of_neighbors(relative), other = mean_of_neighbors(absolute);
    normalize(s);
    normalize(other);
    for (std::size_t i = 0; i < s.size(); ++i) s[i] = (s[i] + other[i]) / 2;
    return s;
}

// Holds √s of a pixel, and the number of samples that it has.
struct PixelShare {
    double deviation, taken;
    double additional(double scale) const { return std::clamp(scale * deviation - taken, 0.0, taken); }
};

constexpr double kMinVariance = 0.01; // lower bound of a pixel's variance, relative to the image's mean

double total_additional(const std::vector<PixelShare>& shares, double scale) {
    double sum = 0;
    for (const PixelShare& share : shares) sum += share.additional(scale);
    return sum;
}

/// Returns the samples per pixel of the next pass toward an error limit. `ratio` > 1 is the current error over the
/// limit. The error falls at least as fast as 1/n with n samples per pixel, and adaptively distributed samples lower
/// it much faster (in open-sky.json it halves from 16 to 20 samples). A pass therefore covers half of the way to the
/// limit. If little is left, an adaptive pass takes at least a 32nd of the samples so far.
double samples_toward_error_limit(double ratio, double done, bool adaptive) {
    const double half_way = done * (ratio - 1) / 2;
    return adaptive ? std::max(half_way, done / 32) : std::max(2 * std::ceil(half_way / 2), 2.0);
}

} // namespace

void allocate_samples(Film& film, std::int64_t samples) {
    const Image<double> variance = smoothed_variance(film);
    std::vector<PixelShare> shares;
    shares.reserve(variance.size());
    double high = 0;
    for (std::size_t i = 0; i < variance.size(); ++i) {
        const PixelShare share{std::sqrt(std::max(variance[i], kMinVariance)),
                               static_cast<double>(film.pixels()[i].samples_taken())};
        high = std::max(high, 2 * share.taken / share.deviation);
        shares.push_back(share);
    }
    const auto wanted = static_cast<double>(samples);
    double low = 0;
    for (int i = 0; i < 24; ++i) { // bisection for the scale that uses up the samples
        const double middle = (low + high) / 2;
        (total_additional(shares, middle) < wanted ? low : high) = middle;
    }
    // The numbers of new samples are even, so that both replicates grow equally. The rounding error of a pixel is
    // carried over to the next.
    double carried = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        carried += shares[i].additional(high) / 2;
        const double pairs = std::floor(carried);
        carried -= pairs;
        film.pixels()[i].target = static_cast<std::uint32_t>(shares[i].taken) + 2 * static_cast<std::uint32_t>(pairs);
    }
}

bool plan_pass(const PathTracerSettings& settings, const SpentBudget& spent, Film& film) {
    const auto pixels = static_cast<double>(pixel_count(film));
    const double done = static_cast<double>(film.total_samples_taken()) / pixels;
    const double remaining = settings.samples_per_pixel - done;
    if (remaining < 0.5) return false;
    const bool limited = settings.time_limit > 0 || settings.error_limit > 0;
    double count = kMinSamplesForError;
    if ((limited || settings.adaptive) && done >= kMinSamplesForError)
        count = std::clamp(std::floor(done / 8) * 2, 2.0, 32.0);
    if (settings.time_limit > 0 && done < kMinSamplesForError) count = std::max(done, 2.0);
    count = std::min(count, std::ceil(remaining));
    if (settings.error_limit > 0 && done >= kMinSamplesForError) {
        const double error = film.estimated_relmse();
        if (error >= 0 && error < settings.error_limit) return false;
        if (error >= 0)
            count = std::min(count, samples_toward_error_limit(error / settings.error_limit, done, settings.adaptive));
    }
    if (spent.samples > 0 && settings.time_limit > 0) {
        const double seconds_per_sample = spent.seconds / static_cast<double>(spent.samples) * pixels;
        const double affordable = 2 * std::round((settings.time_limit - spent.seconds) / seconds_per_sample / 2);
        if (affordable < 1) return false;
        count = std::min(count, affordable);
    }
    if (settings.adaptive && done >= kMinSamplesForError) {
        allocate_samples(film, static_cast<std::int64_t>(count * pixels));
        if (!film.complete()) return true;
    }
    // Adaptive sampling may have added no sample, if the image has few pixels and the pass has less than one sample per
    // pixel.
    add_to_all_targets(film, static_cast<std::uint32_t>(std::max(count, 1.0)));
    return true;
}

} // namespace duet::raytrace
