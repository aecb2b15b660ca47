// This file paints the amphora: bands of ornament in black-figure style.
#include "models/amphora.h"

#include "models/distance_field.h"

#include <algorithm>
#include <array>

namespace duet::models {
namespace {

/// Returns the fraction of black at a point of a band; x and y are in [0, 1] over one repeat of its pattern.
using Pattern = double (*)(double x, double y);

double black(double, double) { return 1; }
double bare(double, double) { return 0; }
double rays(double x, double y) { return std::abs(x - 0.5) < 0.40 * (1 - y); }
double two_lines(double, double y) { return (y > 0.1 && y < 0.4) || (y > 0.6 && y < 0.9); }

/// Paints hanging tongues, each outlined with a paler core.
double tongues(double x, double y) {
    constexpr double kBottom = 0.34;
    const double dx = std::abs(x - 0.5);
    const double from_axis = y > kBottom ? dx : std::sqrt(sqr(dx) + sqr(y - kBottom));
    return from_axis > 0.40 ? 0 : from_axis > 0.25 ? 1 : 0.45;
}

/// Paints a Greek key on a grid of squares; the last row is empty.
double meander(double x, double y) {
    static constexpr const char* kKey[] = {"########", "#.......", "#.#####.", "#.#...#.",
                                           "#.#.#.#.", "#...#.#.", "#####.##"};
    const auto column = static_cast<std::size_t>(clamp(x * 8, 0.0, 7.0));
    const auto row = static_cast<std::size_t>(clamp((1 - y) * 7, 0.0, 6.0));
    return kKey[row][column] == '#';
}

/// Paints a running dog pattern: waves that curl over.
double wave(double x, double y) {
    const auto crest = [&](double center) {
        const double dx = x - center, dy = y - 0.52;
        const double r = std::sqrt(dx * dx + dy * dy), angle = std::atan2(dy, -dx); // angle 0 is to the left
        const double turn =
            (angle < -0.6 ? angle + 2 * kPiDouble : angle) + 0.6; // angle clockwise from below the back of the crest
        const double arm = 0.36 - 0.045 * turn;
        return std::abs(r - arm) < 0.085 - 0.006 * turn;
    };
    return crest(0.45) || crest(1.45) || crest(-0.55) || y < 0.14;
}

/// Paints rosettes of eight petals.
double rosettes(double x, double y) {
    const double dx = x - 0.5, dy = y - 0.5, r = std::sqrt(dx * dx + dy * dy);
    const double petal = 0.31 + 0.12 * std::cos(8 * std::atan2(dy, dx));
    return (r < petal && r > 0.15) || r < 0.09;
}

/// Paints a dolphin leaping to the right. It follows an arc: t is 0 at the tail and 1 at the brow; h is the height
/// above the arc.
double dolphin(double x, double y) {
    constexpr double kAspect = 1.5, kRadius = 0.74;
    const double dx = (x - 0.5) * kAspect, dy = y + 0.22;
    const double t = (2.55 - std::atan2(dy, dx)) / 2.0, h = std::sqrt(dx * dx + dy * dy) - kRadius;
    const double girth = 0.03 + 0.125 * std::sin(kPiDouble * std::pow(clamp(t, 0.0, 1.0), 0.75));
    const bool body = t > 0.02 && t < 1 && std::abs(h) < girth;
    const bool beak = t >= 0.97 && t < 1.09 && std::abs(h + 0.02) < 0.024;
    const bool fin = t > 0.42 && t < 0.62 && h > 0 && h < girth + 0.16 * (0.62 - t) / 0.2 * smooth_step(0.42, 0.47, t);
    const bool flipper =
        t > 0.56 && t < 0.74 && h < 0 && h > -girth - 0.12 * (0.74 - t) / 0.18 * smooth_step(0.56, 0.6, t);
    const double back = 0.07 - t; // the fluke extends backward, with a notch
    const bool fluke = back > 0 && back < 0.14 && std::abs(h) < 0.03 + 1.3 * back && std::abs(h) > 3 * (back - 0.09);
    const bool eye = sqr((t - 0.9) * 1.48) + sqr(h - 0.015) < sqr(0.022);
    const bool stripe = t > 0.12 && t < 0.84 && std::abs(h + 0.35 * girth) < 0.008;
    return (body || beak || fin || flipper || fluke) && !eye && !stripe;
}

struct Band {
    double top; ///< v at the upper edge, as a fraction of the painted range
    int repeats;
    Pattern pattern;
};

// The bands are listed from the foot upward.
constexpr Band kBands[] = {
    {0.205, 1, black},     {0.22, 1, bare},       {0.32, 28, rays},      {0.332, 1, black},   {0.36, 1, two_lines},
    {0.41, 36, wave},      {0.43, 1, two_lines},  {0.44, 1, bare},       {0.582, 6, dolphin}, {0.592, 1, bare},
    {0.612, 1, two_lines}, {0.665, 30, meander},  {0.685, 1, two_lines}, {0.76, 36, tongues}, {0.78, 1, two_lines},
    {0.845, 14, rosettes}, {0.865, 1, two_lines}, {1.0, 1, black},
};

/// Returns the fraction of black at (u, v); v is a fraction of the painted range.
double paint(double u, double v) {
    double bottom = 0;
    for (const Band& band : kBands) {
        if (v < band.top) {
            const double x = u * band.repeats;
            return band.pattern(x - std::floor(x), (v - bottom) / (band.top - bottom));
        }
        bottom = band.top;
    }
    return 1;
}

std::uint8_t byte(double x) { return static_cast<std::uint8_t>(std::lround(clamp(x, 0.0, 255.0))); }

} // namespace

Image<Rgb8> paint_amphora() {
    constexpr int kSize = 1024, kSubsamples = 4;
    Image<Rgb8> image(kSize, kSize);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            double coverage = 0;
            for (int i = 0; i < kSubsamples * kSubsamples; ++i) {
                const double u = (x + (i % kSubsamples + 0.5) / kSubsamples) / kSize;
                const double v = 1 - (y + (i / kSubsamples + 0.5) / kSubsamples) / kSize;
                coverage += v > kAmphoraPaintedV ? 1 : paint(u, v / kAmphoraPaintedV);
            }
            coverage /= kSubsamples * kSubsamples;
            // The clay color varies slightly and is periodic around the vase.
            const double angle = 2 * kPiDouble * x / kSize;
            const double fired =
                std::round(4 * gradient_noise({2 * std::cos(angle), 6.0 * y / kSize, 2 * std::sin(angle)})) * 3;
            const double clay[3] = {206 + fired, 118 + fired, 68 + fired / 2}, glaze[3] = {30, 25, 23};
            image(x, y) = {byte(lerp(clay[0], glaze[0], coverage)), byte(lerp(clay[1], glaze[1], coverage)),
                           byte(lerp(clay[2], glaze[2], coverage))};
        }
    }
    return image;
}

} // namespace duet::models
