#include "compare/metrics/z_test.h"

#include "compare/metrics/normal_distribution.h"
#include "compare/metrics/same_size.h"

#include <algorithm>
#include <array>
#include <cmath>

// How a difference is judged by variances from few replicates
//
// A variance from two replicates (raytrace/film/film.h) has one degree of freedom. It is correct on average but
// useless for a single pixel: a difference divided by its square root has Student's t distribution with one
// degree of freedom, which is Cauchy's and has infinite variance. Two remedies are used.
//
// To describe single pixels, the variance is averaged over 5 × 5 pixels. The squared differences of the other
// pixels are also estimates of it and are included, because at the edge of a light a well-stratified sampler's
// replicates often agree to the last bit. With about ν = 50 degrees of freedom, E z² = ν / (ν − 2) = 1.04.
//
// To decide, the differences dᵢ are added over many pixels. Pixels are independent, so the variance of the sum
// is the sum of the variances σᵢ², however much they differ. The expected value of the estimate sᵢ² is σᵢ²,
// and so is that of dᵢ² if the images agree. Therefore
//
//     T = Σ dᵢ / √V,   V = ½ Σ (sᵢ² + dᵢ²)
//
// is standard normal for many pixels. With V = Σ sᵢ² alone, a block with one noisy pixel whose replicates
// happen to agree would be reported as different. Its probability is that of Cauchy's tail, a few percent. With
// dᵢ² in V, a single pixel cannot raise |T| above √2, nor k pixels above √(2k). The tails of T are also lighter
// than the normal distribution's: for normal differences of equal variance, T²/(2k) has the Beta distribution
// with parameters ½ and k − ½. For any differences that are symmetric about 0, P(|T′| > x) ≤ 2 exp(−x²/2),
// where V = Σ dᵢ² (Hoeffding 1963, Theorem 2, given the |dᵢ|). The amount that a difference of the means adds
// to V costs no power at 1024 pixels.
//
// The blocks are that large because Monte Carlo noise is skewed. If the differences have skewness γ, the odds
// of T beyond x are off by a factor of about exp(γ x³ / (6 √k)). For γ = 1, k = 1024 and x = 4 (a few hundred
// blocks) this is 1.4; for blocks of 8 × 8 pixels it would be 4 or more. The smallest of all p-values is
// corrected by Šidák's formula. For correlated normal variables (the whole image and its blocks) the formula is
// conservative (Šidák 1967).

namespace duet::compare {

namespace {

constexpr int kBlock = 32, kPoolRadius = 2;

/// Two programs that compute the same number in single precision differ by up to about this fraction of it.
/// This error does not average out over a block as noise does. All differences are therefore reduced by it.
constexpr double kRounding = 1e-5;

/// This is the significance level of the decision. The detectable difference is found with one minus this probability.
constexpr double kLevel = 0.01;

struct Value {
    double difference = 0, variance = 0;
    bool tested = false;
};
using Values = Image<std::array<Value, 3>>;

void check_sizes(const NoisyImage& a, const NoisyImage& b) {
    check_same_size(a.values, b.values);
    for (const ImageRgb* const variance : {&a.variance, &b.variance})
        if (!variance->empty()) check_same_size(a.values, *variance);
    if (a.variance.empty() && b.variance.empty()) throw Error("neither image has variances");
}

double variance_at(const NoisyImage& image, std::size_t i, std::size_t c) {
    return image.variance.empty() ? 0.0 : static_cast<double>(image.variance[i][c]);
}

Values differences(const NoisyImage& a, const NoisyImage& b) {
    Values values(a.values.width(), a.values.height());
    for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const double va = static_cast<double>(a.values[i][c]), vb = static_cast<double>(b.values[i][c]);
            const double variance = variance_at(a, i, c) + variance_at(b, i, c);
            const double excess = std::abs(va - vb) - kRounding * std::max(std::abs(va), std::abs(vb));
            const double difference = std::copysign(std::max(excess, 0.0), va - vb);
            const bool finite = std::isfinite(va - vb) && std::isfinite(variance);
            values[i][c] = {difference, variance, finite && (variance > 0 || excess > 0)};
        }
    return values;
}

/// Holds the sums over a group of pixels on which the decision is based.
struct Sums {
    double difference = 0, variance = 0;
    std::int64_t count = 0;

    void add(const Value& v) {
        if (!v.tested) return;
        difference += v.difference;
        variance += (v.variance + sqr(v.difference)) / 2;
        ++count;
    }
    void add(const Sums& s) {
        difference += s.difference;
        variance += s.variance;
        count += s.count;
    }
    double z() const { return count > 0 ? difference / std::sqrt(variance) : 0; }
};

/// Estimates the variance of a pixel's difference from the pixels around it: half from all the variances, half
/// from the squared differences of the other pixels. The pixel's own squared difference is excluded, because it
/// would hide the difference.
double pooled_variance(const Values& values, int x, int y, std::size_t c) {
    double variances = 0, squares = -sqr(values(x, y)[c].difference);
    int count = 0;
    for (int v = std::max(y - kPoolRadius, 0); v <= std::min(y + kPoolRadius, values.height() - 1); ++v)
        for (int u = std::max(x - kPoolRadius, 0); u <= std::min(x + kPoolRadius, values.width() - 1); ++u)
            if (values(u, v)[c].tested) {
                variances += values(u, v)[c].variance;
                squares += sqr(values(u, v)[c].difference);
                ++count;
            }
    return count > 1 ? (variances / count + std::max(squares, 0.0) / (count - 1)) / 2 : variances;
}

void describe_pixels(ZTest& test, const Values& values) {
    std::int64_t count = 0, over_2 = 0, over_3 = 0;
    double squares = 0;
    for (int y = 0; y < values.height(); ++y)
        for (int x = 0; x < values.width(); ++x) {
            bool any = false;
            for (std::size_t c = 0; c < 3; ++c) {
                const Value& value = values(x, y)[c];
                if (!value.tested) continue;
                any = true;
                const double z = std::abs(value.difference) / std::sqrt(pooled_variance(values, x, y, c));
                ++count;
                over_2 += z > 2;
                over_3 += z > 3;
                squares += z * z;
                if (z > test.largest) {
                    test.largest = z;
                    test.largest_x = x;
                    test.largest_y = y;
                }
            }
            test.pixels += any;
        }
    if (count == 0) return;
    test.over_2 = static_cast<double>(over_2) / static_cast<double>(count);
    test.over_3 = static_cast<double>(over_3) / static_cast<double>(count);
    test.mean_square = squares / static_cast<double>(count);
}

struct Region {
    int x, y, width, height;
    std::array<Sums, 3> sums;
};

/// Returns the blocks, followed by the whole image. Blocks at the right and lower borders include the remaining
/// pixels, so that no block is smaller than 32 × 32, unless the image is.
std::vector<Region> regions(const Values& values) {
    std::vector<Region> list;
    Region whole{0, 0, values.width(), values.height(), {}};
    const int columns = std::max(values.width() / kBlock, 1), rows = std::max(values.height() / kBlock, 1);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const int x0 = column * kBlock, x1 = column + 1 < columns ? x0 + kBlock : values.width();
            const int y0 = row * kBlock, y1 = row + 1 < rows ? y0 + kBlock : values.height();
            Region block{x0, y0, x1 - x0, y1 - y0, {}};
            for (int y = y0; y < y1; ++y)
                for (int x = x0; x < x1; ++x)
                    for (std::size_t c = 0; c < 3; ++c) block.sums[c].add(values(x, y)[c]);
            for (std::size_t c = 0; c < 3; ++c) whole.sums[c].add(block.sums[c]);
            list.push_back(block);
        }
    list.push_back(whole);
    return list;
}

/// Returns the mean difference that equals `threshold` standard errors. V includes the differences themselves:
/// as a difference δ grows, T = kδ / √(V + k·δ²/2) approaches √(2k). Returns infinity if that is below the
/// threshold, because there are too few pixels.
double detectable(const Sums& whole, double threshold) {
    const double k = static_cast<double>(whole.count), room = k - sqr(threshold) / 2;
    return room > 0 ? threshold * std::sqrt(whole.variance) / std::sqrt(k * room) : static_cast<double>(kInfinity);
}

void decide(ZTest& test, const std::vector<Region>& list) {
    double smallest = 2;
    for (const Region& region : list)
        for (std::size_t c = 0; c < 3; ++c) {
            if (region.sums[c].count == 0) continue;
            ++test.tests;
            const double p = two_sided_p(region.sums[c].z());
            if (p >= smallest) continue;
            smallest = p;
            test.x = region.x;
            test.y = region.y;
            test.width = region.width;
            test.height = region.height;
            test.channel = static_cast<int>(c);
        }
    if (test.tests == 0) return;
    const double tests = static_cast<double>(test.tests);
    test.p = sidak(smallest, tests);
    const double threshold = upper_quantile(sidak_level(kLevel, tests) / 2) + upper_quantile(kLevel);
    for (std::size_t c = 0; c < 3; ++c) {
        const Sums& whole = list.back().sums[c];
        test.mean_z[c] = whole.z();
        if (whole.count > 0) test.detectable[c] = detectable(whole, threshold);
    }
}

} // namespace

ZTest z_test(const NoisyImage& a, const NoisyImage& b) {
    check_sizes(a, b);
    const Values values = differences(a, b);
    ZTest test;
    describe_pixels(test, values);
    decide(test, regions(values));
    return test;
}

} // namespace duet::compare
