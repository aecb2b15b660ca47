#include "compare/skip/bias_test.h"

#include "compare/metrics/normal_distribution.h"

#include <algorithm>
#include <limits>

// How a bias is found
//
// The R differences of a channel have the mean m, the standard deviation s and the skewness γ. Student's T = √R
// m / s is skewed if the differences are. They are: Russian roulette removes a little from most images and adds
// much to a few. Hall's transformation removes the skewness ("On the Removal of Skewness by Transformation",
// 1992, §2):
//
//     g = T + γ T² / (3 √R) + γ² T³ / (27 R) + γ / (6 √R)
//
// is normal to the next order in 1/√R and increases with T. Its tails are heavier because s is estimated. The
// test therefore uses S = g / √(1 + g²/R), which for γ = 0 is the sum of the differences over the root of the
// sum of their squares. Beyond √3 its tails are lighter than the normal distribution's (S²/R has the Beta
// distribution with parameters ½ and (R − 1)/2), so that false alarms are rarer than kFalseAlarmProbability.
//
// A bias is found if |S| exceeds z, the quantile of kFalseAlarmProbability for three channels. This happens if T is
// beyond some T₀, taken for the sign for which the skewness makes it larger. A bias μ shifts T by √R μ / s. T deviates
// from that by more than the quantile of kMissProbability with probability kMissProbability. So μ = (T₀ +
// z(kMissProbability)) s / √R is found with probability 1 − kMissProbability. Since s is only estimated, the upper end
// of its band is used; its relative error is 1/√(2(R − 1)).

namespace duet::compare {

namespace {

constexpr double kChannels = 3;

double threshold() { return upper_quantile(sidak_level(kFalseAlarmProbability, kChannels) / 2); } // 2.93

/// Returns S of the formula above as a function of Student's T: without skewness, and nearly normal.
double without_skewness(double t, double skewness, double count) {
    const double a = skewness / std::sqrt(count);
    const double g = t + a * t * t / 3 + a * a * t * t * t / 27 + a / 6;
    return g / std::sqrt(1 + g * g / count);
}

/// Returns T₀, the least |T| at which a bias of either sign is found, or infinity if there is none.
double smallest_detected_t(double skewness, double count) {
    double low = 0, high = 1e3;
    for (int i = 0; i < 60; ++i) {
        const double t = (low + high) / 2;
        const bool found =
            std::min(without_skewness(t, skewness, count), -without_skewness(-t, skewness, count)) > threshold();
        (found ? high : low) = t;
    }
    return high < 1e3 ? high : std::numeric_limits<double>::infinity();
}

} // namespace

void BiasTest::add(Rgbd with, Rgbd without) {
    differences_.push_back(with - without);
    without_ += without;
}

BiasTest::Moments BiasTest::moments(std::size_t c) const {
    const double count = pairs();
    double sum = 0, squares = 0, cubes = 0;
    for (const Rgbd& d : differences_) sum += d[c];
    for (const Rgbd& d : differences_) {
        const double deviation = d[c] - sum / count;
        squares += sqr(deviation);
        cubes += deviation * sqr(deviation);
    }
    const double deviation = std::sqrt(squares / (count - 1));
    return {sum / count, deviation, deviation > 0 ? cubes / count / (deviation * sqr(deviation)) : 0};
}

Rgbd BiasTest::bias() const {
    Rgbd sum;
    for (const Rgbd& d : differences_) sum += d;
    for (std::size_t c = 0; c < 3; ++c) sum[c] = without_[c] > 0 ? sum[c] / without_[c] : 0;
    return sum;
}

double BiasTest::detectable() const {
    if (pairs() < kMinPairs) return std::numeric_limits<double>::infinity();
    const double count = pairs(), upper = 1 + upper_quantile(kMissProbability) / std::sqrt(2 * (count - 1));
    double largest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const Moments m = moments(c);
        if (!(without_[c] > 0) || m.deviation == 0) continue; // any bias shows without noise
        const double t = smallest_detected_t(m.skewness, count) + upper_quantile(kMissProbability);
        largest = std::max(largest, t * m.deviation * upper / std::sqrt(count) / (without_[c] / count));
    }
    return largest;
}

double BiasTest::p() const {
    double smallest = 1;
    for (std::size_t c = 0; c < 3 && pairs() > 1; ++c) {
        const Moments m = moments(c);
        if (m.mean == 0) continue;
        const double count = pairs(), t = std::sqrt(count) * m.mean / m.deviation;
        const double s = m.deviation > 0 ? without_skewness(t, m.skewness, count) : std::sqrt(count);
        smallest = std::min(smallest, two_sided_p(s));
    }
    return sidak(smallest, kChannels);
}

double BiasTest::pairs_needed(double bias) const {
    const double now = detectable();
    return std::isfinite(now) ? std::max<double>(kMinPairs, pairs() * sqr(now / bias)) : kMinPairs;
}

} // namespace duet::compare
