#include "raytrace/schedule.h"

#include <algorithm>
#include <cmath>

namespace duet::raytrace {

namespace {

// A first few samples that all miss the lights look converged: what the film tells of errors is asked from so many on.
constexpr double kMinForError = 16;

std::int64_t pixel_count(const Film& film) { return std::int64_t{film.width()} * film.height(); }

void raise_all(Film& film, std::uint32_t samples) {
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) film.pixels()(x, y).target = film.taken(x, y) + samples;
}

// Of one sample, over (mean² + 0.01), mean of the channels; negative where it is not known.
double relative_variance(const Film& film, int x, int y) {
    const Rgbd variance = film.variance(x, y), mean = film.mean(x, y);
    if (!is_finite(variance)) return -1;
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += variance[c] / (sqr(mean[c]) + 0.01);
    return sum / 3 * film.samples(x, y);
}

// What each pixel's neighbours have, in the mean; 0 where none knows.
Image<double> of_neighbours(const Image<double>& own) {
    Image<double> result(own.width(), own.height());
    for (int y = 0; y < own.height(); ++y)
        for (int x = 0; x < own.width(); ++x) {
            double sum = 0;
            int known = 0;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, own.height() - 1); ++j)
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, own.width() - 1); ++i) {
                    if ((i == x && j == y) || own(i, j) < 0) continue;
                    sum += own(i, j);
                    ++known;
                }
            result(x, y) = known > 0 ? sum / known : 0;
        }
    return result;
}

// A pixel: √s, and the samples it has.
struct Need {
    double root, taken;
    double more(double scale) const { return std::clamp(scale * root - taken, 0.0, taken); }
};

double all_more(const std::vector<Need>& needs, double scale) {
    double sum = 0;
    for (const Need& need : needs) sum += need.more(scale);
    return sum;
}

} // namespace

void spread_samples(Film& film, std::int64_t samples) {
    Image<double> own(film.width(), film.height());
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) own(x, y) = relative_variance(film, x, y);
    const Image<double> variance = of_neighbours(own);
    double mean = 0;
    for (const double v : variance) mean += v / static_cast<double>(pixel_count(film));
    std::vector<Need> needs;
    needs.reserve(variance.size());
    double high = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const Need need{std::sqrt(std::max(variance(x, y), mean / 100)), static_cast<double>(film.taken(x, y))};
            if (need.root > 0) high = std::max(high, 2 * need.taken / need.root);
            needs.push_back(need);
        }
    const auto wanted = static_cast<double>(samples);
    double low = 0;
    for (int i = 0; i < 50; ++i) { // the scale at which the samples are just used up: halved until nothing changes
        const double middle = (low + high) / 2;
        (all_more(needs, middle) < wanted ? low : high) = middle;
    }
    // Even numbers, so that replicates grow alike; what one pixel's rounding takes, the next one's gets.
    double carried = 0;
    for (std::size_t i = 0; i < needs.size(); ++i) {
        carried += needs[i].more(high) / 2;
        const double pairs = std::floor(carried);
        carried -= pairs;
        film.pixels()[i].target = static_cast<std::uint32_t>(needs[i].taken) + 2 * static_cast<std::uint32_t>(pairs);
    }
}

bool plan_pass(const Settings& settings, const Spent& spent, Film& film) {
    const auto pixels = static_cast<double>(pixel_count(film));
    const double done = static_cast<double>(film.all_taken()) / pixels;
    const double left = settings.samples_per_pixel - done;
    if (left < 0.5) return false;
    const bool limited = settings.time_limit > 0 || settings.error_limit > 0;
    double count = limited || settings.adaptive ? std::clamp(std::floor(done / 8) * 2, 2.0, 32.0) : 16.0;
    count = std::min(count, std::ceil(left));
    if (settings.error_limit > 0 && done >= kMinForError) {
        const double error = film.estimated_relmse();
        if (error >= 0 && error < settings.error_limit) return false;
        // Errors fall with the number of samples or sooner: no more than that.
        if (error >= 0) count = std::min(count, std::max(2 * std::ceil(done * (error / settings.error_limit - 1) / 2), 2.0));
    }
    if (spent.samples > 0 && settings.time_limit > 0) {
        const double expected = spent.seconds / static_cast<double>(spent.samples) * count * pixels;
        if (spent.seconds + expected / 2 > settings.time_limit) return false;
    }
    if (settings.adaptive && done >= kMinForError) {
        spread_samples(film, static_cast<std::int64_t>(count * pixels));
        if (!film.complete()) return true;
    }
    raise_all(film, static_cast<std::uint32_t>(count));
    return true;
}

} // namespace duet::raytrace
