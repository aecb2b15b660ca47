#include "common/image/view_transform.h"

#include "common/image/srgb.h"
#include "common/system/parallel.h"
#include "common/vec/matrix.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

constexpr ColorMatrix kIdentity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

Rgb operator*(const ColorMatrix& m, Rgb c) {
    const auto row = [&](std::size_t i) { return m[i][0] * c.r + m[i][1] * c.g + m[i][2] * c.b; };
    return {row(0), row(1), row(2)};
}

ColorMatrix inverse(const ColorMatrix& m) {
    Mat4 a;
    for (std::size_t i = 0; i < 3; ++i) std::copy(m[i].begin(), m[i].end(), a[i].begin());
    const Mat4 result = inverse_affine(a);
    ColorMatrix inverted{};
    for (std::size_t i = 0; i < 3; ++i) std::copy_n(result[i].begin(), 3, inverted[i].begin());
    return inverted;
}

// Scales each row to the sum 1, so that gray stays gray.
ColorMatrix gray_preserving(ColorMatrix m) {
    for (auto& row : m) {
        const float sum = row[0] + row[1] + row[2];
        for (float& entry : row) entry /= sum;
    }
    return m;
}

float clip_curve(float x) { return std::min(x, 1.0f); }

float filmic_curve(float x) {
    constexpr float kGrayScale = 0.7232f; // maps 0.18 to 0.18
    const float s = kGrayScale * std::min(x, 1e4f);
    return std::min(s * (2.51f * s + 0.03f) / (s * (2.43f * s + 0.59f) + 0.14f), 1.0f);
}

// Returns one side of AgX's sigmoid (AgX.py, equation_full_curve) at the distance x from its pivot. The slope is 2 at
// the pivot. The curve approaches the height `height` toward the distance `width`, and `power` sets the sharpness of
// the bend.
float sigmoid_side(float x, float width, float height, float power) {
    constexpr float kSlope = 2;
    const float scale = kSlope * width * std::pow(std::pow(kSlope * width / height, power) - 1, -1 / power);
    const float term = kSlope * x / scale;
    return scale * term / std::pow(1 + std::pow(term, power), 1 / power);
}

// AgX covers 16.5 stops, 10 of them below middle gray, which lies at half of the output.
float agx_curve(float x) {
    constexpr float kStopsBelow = 10, kStopsAbove = 6.5f, kPivot = kStopsBelow / (kStopsBelow + kStopsAbove);
    const float stops = std::clamp(std::log2(std::max(x, 1e-30f) / 0.18f), -kStopsBelow, kStopsAbove);
    const float at = stops / (kStopsBelow + kStopsAbove);
    const float encoded =
        at >= 0 ? 0.5f + sigmoid_side(at, 1 - kPivot, 0.5f, 3.25f) : 0.5f - sigmoid_side(-at, kPivot, 0.5f, 3.0f);
    return std::pow(encoded, 2.2f); // the curve ends in the code range of a display of gamma 2.2
}

const ColorMatrix kAgxInset = gray_preserving({{{0.842479062f, 0.0784336f, 0.0792237451f},
                                                {0.0423282423f, 0.878468636f, 0.0791661275f},
                                                {0.0423756549f, 0.0784336f, 0.879142974f}}});

// Returns noise in [0, 1) whose values in each small neighborhood are spread evenly (Jimenez 2014, "Next Generation
// Post Processing in Call of Duty: Advanced Warfare", interleaved gradient noise). Each channel uses the pattern at a
// different offset.
double dither_noise(std::size_t x, std::size_t y, std::size_t channel) {
    const auto fraction = [](double v) { return v - std::floor(v); };
    const double column = static_cast<double>(x) + 5.588238 * static_cast<double>(channel);
    return fraction(52.9829189 * fraction(0.06711056 * column + 0.00583715 * static_cast<double>(y)));
}

// Rounds up with a probability equal to the fraction, so that the mean is exact.
std::uint8_t dithered_code(float linear, double noise) {
    const double code = linear > 0 ? 255 * srgb_encode(std::min(static_cast<double>(linear), 1.0)) : 0;
    return static_cast<std::uint8_t>(std::min(std::floor(code + noise), 255.0));
}

} // namespace

Rgb ToneMapping::operator()(Rgb linear) const {
    const auto valid = [](float x) { return x > 0 ? std::min(x, 1e30f) : 0; }; // the comparison is false for NaN
    const Rgb mixed = inset * Rgb(valid(linear.r), valid(linear.g), valid(linear.b));
    return outset * Rgb(curve(mixed.r), curve(mixed.g), curve(mixed.b));
}

const ToneMapping& tone_mapping(Tone tone) {
    static const std::array<ToneMapping, kTones.entries.size()> mappings{{
        {kIdentity, clip_curve, kIdentity},
        {kIdentity, filmic_curve, kIdentity},
        {kAgxInset, agx_curve, inverse(kAgxInset)},
    }};
    return mappings[static_cast<std::size_t>(tone)];
}

Rgb displayed(Rgb radiance, const ViewTransform& view) {
    const Rgb exposed = radiance * std::exp2(view.exposure);
    return view.tone == Tone::kNone ? exposed : tone_mapping(view.tone)(exposed);
}

std::vector<std::uint8_t> display_bytes(const ImageRgb& image, const ViewTransform& view, int threads) {
    if (view == ViewTransform{}) return srgb_encode_8bit(image, threads);
    const SrgbEncoder& encode = srgb_encoder();
    std::vector<std::uint8_t> bytes(3 * image.size());
    const auto width = static_cast<std::size_t>(image.width());
    parallel_for(static_cast<std::size_t>(image.height()), threads, [&](std::size_t y) {
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t i = y * width + x;
            const Rgb color = displayed(image[i], view);
            for (std::size_t c = 0; c < 3; ++c)
                bytes[3 * i + c] = view.dither ? dithered_code(color[c], dither_noise(x, y, c)) : encode(color[c]);
        }
    });
    return bytes;
}

} // namespace duet
