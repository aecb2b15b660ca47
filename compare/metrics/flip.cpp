#include "compare/metrics/flip.h"

#include "common/image/srgb.h"
#include "common/system/parallel.h"
#include "compare/metrics/flip_filters.h"
#include "compare/metrics/same_size.h"

#include <algorithm>
#include <limits>

namespace duet::compare {

namespace {

using Filters = std::array<SeparableFilter, kFlipFilters>;

// Color --------------------------------------------------------------------------------------------------------------

/// A ColorMatrix is a 3 × 3 matrix for colors, by rows.
struct ColorMatrix {
    Vec3 x, y, z;
    Vec3 operator*(Vec3 c) const { return {dot(x, c), dot(y, c), dot(z, c)}; }
};

/// These matrices convert linear sRGB to CIE XYZ and back. Each row of the first is scaled to the sum 1: XYZ is
/// relative to the white point, which becomes (1, 1, 1).
constexpr ColorMatrix kToXyz{{0.4338953888f, 0.3762423726f, 0.1898622385f},
                             {0.2126368217f, 0.7151829818f, 0.0721801965f},
                             {0.0177524232f, 0.1094656287f, 0.8727819482f}};
constexpr ColorMatrix kFromXyz{{3.0803419883f, -1.5373989695f, -0.5429430188f},
                               {-0.9211783962f, 1.8759299837f, 0.0452484125f},
                               {0.0528812929f, -0.2040112061f, 1.1511299132f}};

Vec3 as_vector(Rgb c) { return {c.r, c.g, c.b}; }

/// Converts to YCxCz, a linear opponent color space with the scale of L*a*b*.
Vec3 opponent(Rgb linear) {
    const Vec3 xyz = kToXyz * as_vector(linear);
    return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

/// Converts YCxCz to linear RGB, clamped to the range of a display.
Vec3 from_opponent(Vec3 c) {
    const float y = (c.x + 16) / 116;
    const Vec3 rgb = kFromXyz * Vec3(y + c.y / 500, y, y - c.z / 200);
    return {clamp(rgb.x, 0.0f, 1.0f), clamp(rgb.y, 0.0f, 1.0f), clamp(rgb.z, 0.0f, 1.0f)};
}

/// Converts to CIE L*a*b* with a* and b* scaled by L*/100: color differences are less visible in the dark (Hunt
/// effect).
Vec3 hunt_lab(Vec3 linear) {
    constexpr float kDelta = 6.0f / 29;
    const auto f = [](float t) {
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29;
    };
    const Vec3 xyz = kToXyz * linear;
    const float x = f(xyz.x), y = f(xyz.y), z = f(xyz.z), lightness = 116 * y - 16;
    return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

/// Returns the HyAB distance of two colors to the power q_c = 0.7.
float color_distance(Vec3 a, Vec3 b) {
    const Vec3 d = a - b;
    return std::pow(std::abs(d.x) + std::sqrt(sqr(d.y) + sqr(d.z)), 0.7f);
}

/// Maps the distance to [0, 1]. The lower 0.4 of the possible distances get most of the range, up to 0.95 (§4.1.3).
float color_error(Vec3 a, Vec3 b) {
    static const float largest = color_distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1}));
    constexpr float kPt = 0.95f;
    const float knee = 0.4f * largest, distance = color_distance(a, b);
    return distance < knee ? kPt / knee * distance : kPt + (distance - knee) / (largest - knee) * (1 - kPt);
}

// Filtering ----------------------------------------------------------------------------------------------------------

/// This is the number of image rows per band. A band is small enough for the cache, and large enough to amortize the
/// additional rows that the filters read.
constexpr int kBandRows = 64;

struct Rows {
    int first, width;
    std::vector<float> values;
    Rows(int first_row, int end_row, int width_)
        : first(first_row), width(width_),
          values(static_cast<std::size_t>(end_row - first_row) * static_cast<std::size_t>(width_)) {}
    float* row(int y) { return values.data() + static_cast<std::ptrdiff_t>(y - first) * width; }
};

int radius(const Kernel& kernel) { return static_cast<int>(kernel.size() / 2); }

void add_scaled(float* sum, const float* values, float factor, int count) {
    for (int x = 0; x < count; ++x) sum[x] += factor * values[x];
}

/// Filters one row. Beyond its borders, the image is extended with its border values.
void filter_row(const float* values, int width, const Kernel& kernel, std::vector<float>& padded, float* result) {
    const int r = radius(kernel);
    padded.assign(static_cast<std::size_t>(width + 2 * r), values[0]);
    std::copy(values, values + width, padded.begin() + r);
    std::fill(padded.end() - r, padded.end(), values[width - 1]);
    std::fill(result, result + width, 0.0f);
    for (int k = -r; k <= r; ++k)
        add_scaled(result, padded.data() + r + k, kernel[static_cast<std::size_t>(r + k)], width);
}

/// Filters one channel in rows y0 to y1 − 1 of an image of `height` rows. `channel` must contain all rows
/// within reach.
Rows apply(const SeparableFilter& filter, Rows& channel, int y0, int y1, int height) {
    const int r = radius(filter.vertical), width = channel.width;
    Rows across(std::max(y0 - r, 0), std::min(y1 + r, height), width), result(y0, y1, width);
    std::vector<float> padded;
    for (int y = std::max(y0 - r, 0); y < std::min(y1 + r, height); ++y)
        filter_row(channel.row(y), width, filter.horizontal, padded, across.row(y));
    for (int y = y0; y < y1; ++y)
        for (int k = -r; k <= r; ++k)
            add_scaled(result.row(y), across.row(clamp(y + k, 0, height - 1)),
                       filter.vertical[static_cast<std::size_t>(r + k)], width);
    return result;
}

// The metric ---------------------------------------------------------------------------------------------------------

/// Holds what an observer perceives of a band of rows: filtered colors and the strength of edges and points.
struct PerceivedBand {
    std::vector<Vec3> color;
    std::vector<float> edge, point;
};

/// Computes the perception of a band. `linear(pixel)` returns the displayed color as linear RGB in [0, 1].
template <typename ToLinear>
PerceivedBand perceive(const ImageRgb& image, const ToLinear& linear, const Filters& filters, int y0, int y1) {
    int reach = 0;
    for (const SeparableFilter& f : filters) reach = std::max(reach, radius(f.vertical));
    const int first = std::max(y0 - reach, 0), end = std::min(y1 + reach, image.height()), width = image.width();
    std::array<Rows, 3> channels{Rows(first, end, width), Rows(first, end, width), Rows(first, end, width)};
    for (int y = first; y < end; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec3 c = opponent(linear(image(x, y)));
            for (std::size_t i = 0; i < 3; ++i) channels[i].row(y)[x] = c[i];
        }
    std::array<std::vector<float>, kFlipFilters> f;
    for (std::size_t i = 0; i < kFlipFilters; ++i)
        f[i] = apply(filters[i], channels[filters[i].channel], y0, y1, image.height()).values;
    const std::size_t count = f[0].size();
    PerceivedBand perceived{std::vector<Vec3>(count), std::vector<float>(count), std::vector<float>(count)};
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 color{f[kAchromatic][i], f[kRedGreen][i], f[kBlueYellowNarrow][i] + f[kBlueYellowWide][i]};
        perceived.color[i] = hunt_lab(from_opponent(color));
        // Features are detected in Y with range 0 to 1. It equals Y of YCxCz up to a factor and an offset,
        // which the derivative filters ignore.
        perceived.edge[i] = std::sqrt(sqr(f[kEdgeX][i]) + sqr(f[kEdgeY][i])) / 116;
        perceived.point[i] = std::sqrt(sqr(f[kPointX][i]) + sqr(f[kPointY][i])) / 116;
    }
    return perceived;
}

/// Raises the map's rows from y0 on to the errors between the perceptions of two images, where these are larger (§4.3).
void accumulate_errors(ImageFloat& map, int y0, const PerceivedBand& test, const PerceivedBand& reference) {
    float* errors = &map(0, y0);
    for (std::size_t i = 0; i < test.color.size(); ++i) {
        const float feature =
            std::max(std::abs(test.edge[i] - reference.edge[i]), std::abs(test.point[i] - reference.point[i]));
        const float feature_error = std::sqrt(feature / std::sqrt(2.0f));
        const float error = std::pow(color_error(test.color[i], reference.color[i]), 1 - feature_error);
        errors[i] = std::max(errors[i], error);
    }
}

/// Computes the maximum error over all exposures. perceive_band(image, y0, y1, k) returns the perception at
/// exposure k.
template <typename PerceiveBand>
ImageFloat error_map(const ImageRgb& test, const ImageRgb& reference, int exposures, int threads,
                     const PerceiveBand& perceive_band) {
    ImageFloat map(reference.width(), reference.height(), 0.0f);
    parallel_for(static_cast<std::size_t>((map.height() + kBandRows - 1) / kBandRows), threads, [&](std::size_t band) {
        const int y0 = static_cast<int>(band) * kBandRows, y1 = std::min(y0 + kBandRows, map.height());
        for (int k = 0; k < exposures; ++k)
            accumulate_errors(map, y0, perceive_band(test, y0, y1, k), perceive_band(reference, y0, y1, k));
    });
    return map;
}

/// Holds both images, with pixels that are not finite in one of them set to black in both.
struct FinitePair {
    ImageRgb test, reference;
    std::vector<std::size_t> bad;
};

FinitePair finite_pair(const ImageRgb& test, const ImageRgb& reference) {
    check_same_size(test, reference);
    FinitePair pair{test, reference, {}};
    for (std::size_t i = 0; i < test.size(); ++i)
        if (!is_finite(test[i]) || !is_finite(reference[i])) {
            pair.bad.push_back(i);
            pair.test[i] = pair.reference[i] = Rgb();
        }
    return pair;
}

/// Returns the smallest error such that all errors up to it add up to more than the fraction `share` of the sum.
double weighted_percentile(const std::vector<float>& sorted, double sum, double share) {
    double running = 0;
    for (const float error : sorted)
        if ((running += static_cast<double>(error)) > share * sum) return static_cast<double>(error);
    return sorted.empty() ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(sorted.back());
}

void pool_errors(Flip& flip, const std::vector<std::size_t>& bad) {
    for (const std::size_t i : bad) flip.map[i] = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> sorted;
    for (const float error : flip.map)
        if (!std::isnan(error)) sorted.push_back(error);
    std::sort(sorted.begin(), sorted.end());
    double sum = 0;
    for (const float error : sorted) sum += static_cast<double>(error);
    flip.mean = sum / static_cast<double>(sorted.size());
    flip.weighted_median = weighted_percentile(sorted, sum, 0.5);
    flip.first_quartile = weighted_percentile(sorted, sum, 0.25);
    flip.third_quartile = weighted_percentile(sorted, sum, 0.75);
    flip.min = sorted.empty() ? flip.mean : static_cast<double>(sorted.front());
    flip.max = sorted.empty() ? flip.mean : static_cast<double>(sorted.back());
}

// Exposures ----------------------------------------------------------------------------------------------------------

/// The curve is Narkowicz's fit of the ACES film curve, without its built-in exposure of 0.6: (a x² + b x) / (c x² + d
/// x + e).
constexpr double kA = 0.36 * 2.51, kB = 0.6 * 0.03, kC = 0.36 * 2.43, kD = 0.6 * 0.59, kE = 0.14;

/// Evaluates the curve, clamped to [0, 1]. Beyond the clamped argument it is 1 in any case.
float aces(float x) {
    constexpr auto a = float(kA), b = float(kB), c = float(kC), d = float(kD), e = float(kE);
    x = clamp(x, 0.0f, 1e4f);
    return std::min((a * x * x + b * x) / (c * x * x + d * x + e), 1.0f);
}

/// Returns the x at which the curve is t: the positive root of (a − c t) x² + (b − d t) x − e t.
double aces_inverse(double t) {
    const double p = (kB - kD * t) / (kA - kC * t) / 2, q = -kE * t / (kA - kC * t);
    return -p + std::sqrt(p * p - q);
}

/// Sets start, stop and number of exposures. A black reference gets a single exposure, 0.
void choose_exposures(HdrFlip& flip, const ImageRgb& reference, const std::vector<std::size_t>& bad) {
    std::vector<double> luminances;
    std::size_t next_bad = 0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        if (next_bad < bad.size() && bad[next_bad] == i)
            ++next_bad;
        else
            luminances.push_back(std::max(luminance(Rgbd(reference[i])), 0.0));
    }
    std::sort(luminances.begin(), luminances.end());
    flip.exposures = 1;
    if (luminances.empty() || luminances.back() == 0) return;
    if (luminances[(luminances.size() - 1) / 2] == 0)
        luminances.erase(luminances.begin(), std::upper_bound(luminances.begin(), luminances.end(), 0.0));
    const double x = aces_inverse(0.85),
                 median = (luminances[(luminances.size() - 1) / 2] + luminances[luminances.size() / 2]) / 2;
    flip.start_exposure = std::log2(x / luminances.back());
    flip.stop_exposure = std::log2(x / median);
    flip.exposures = std::max(2, static_cast<int>(std::ceil(flip.stop_exposure - flip.start_exposure)));
}

} // namespace

Flip flip(const ImageRgb& test, const ImageRgb& reference, double pixels_per_degree, int threads) {
    const FinitePair pair = finite_pair(test, reference);
    const Filters filters = flip_filters(pixels_per_degree);
    const auto decode = [](float v) { return srgb_decode(clamp(v, 0.0f, 1.0f)); };
    const auto linear = [&](Rgb c) { return Rgb(decode(c.r), decode(c.g), decode(c.b)); };
    Flip result;
    result.map = error_map(pair.test, pair.reference, 1, threads, [&](const ImageRgb& image, int y0, int y1, int) {
        return perceive(image, linear, filters, y0, y1);
    });
    pool_errors(result, pair.bad);
    return result;
}

// The paper encodes each exposure to sRGB and decodes it again. This is omitted here.
HdrFlip hdr_flip(const ImageRgb& test, const ImageRgb& reference, double pixels_per_degree, int threads) {
    const FinitePair pair = finite_pair(test, reference);
    const Filters filters = flip_filters(pixels_per_degree);
    HdrFlip result;
    choose_exposures(result, pair.reference, pair.bad);
    const double step = (result.stop_exposure - result.start_exposure) / std::max(result.exposures - 1, 1);
    result.map = error_map(
        pair.test, pair.reference, result.exposures, threads, [&](const ImageRgb& image, int y0, int y1, int k) {
            const float gain = static_cast<float>(std::exp2(std::min(result.start_exposure + k * step, 126.0)));
            const auto shown = [gain](Rgb c) { return Rgb(aces(gain * c.r), aces(gain * c.g), aces(gain * c.b)); };
            return perceive(image, shown, filters, y0, y1);
        });
    pool_errors(result, pair.bad);
    return result;
}

} // namespace duet::compare
