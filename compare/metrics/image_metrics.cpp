#include "compare/metrics/image_metrics.h"

#include "common/image/srgb.h"
#include "compare/metrics/ssim.h"

#include <algorithm>
#include <limits>

namespace duet::compare {

namespace {

/// Copies the metrics that need linear values from those of the decoded images.
void copy_linear_metrics(ErrorMetrics& metrics, const ErrorMetrics& linear) {
    metrics.relmse = linear.relmse;
    metrics.relmse_trimmed = linear.relmse_trimmed;
    metrics.smape = linear.smape;
    metrics.mean_signed_error = linear.mean_signed_error;
}

double largest_magnitude(Rgbd c) {
    if (std::isnan(c.r)) return c.r;
    return std::max({std::abs(c.r), std::abs(c.g), std::abs(c.b)});
}

void add_errors(std::vector<MetricValue>& list, const ErrorMetrics& m) {
    list.insert(
        list.end(),
        {{"mse", m.mse, "mean of (a - b)^2"},
         {"rmse", m.rmse, "its square root"},
         {"mae", m.mae, "mean of |a - b|"},
         {"psnr", m.psnr, "10 log10(1 / mse) in dB, the peak is 1; less is worse", true},
         {"relmse", m.relmse, "mean of (a - b)^2 / (b^2 + 0.01)"},
         {"relmse_trimmed", m.relmse_trimmed, "the same without the worst 0.1 % of the pixels"},
         {"smape", m.smape, "mean of |a - b| / (|a| + |b| + 0.01)"},
         {"mean_signed_error", largest_magnitude(m.mean_signed_error), "largest |mean of a - b| of the channels"},
         {"worst", m.worst, "largest |a - b| of a channel"},
         {"nan", static_cast<double>(m.nan_a + m.nan_b), "pixels with NaN, in A and B together"},
         {"infinite", static_cast<double>(m.infinite_a + m.infinite_b), "pixels with infinity, together"}});
}

void add_flip(std::vector<MetricValue>& list, const HdrFlip& f) {
    list.insert(list.end(), {{"flip", f.mean, "mean of the FLIP map (HDR-FLIP of linear images), 0 to 1"},
                             {"flip_weighted_median", f.weighted_median, "half of all FLIP error lies below it"},
                             {"flip_first_quartile", f.first_quartile, "a quarter"},
                             {"flip_third_quartile", f.third_quartile, "three quarters"},
                             {"flip_min", f.min, "the smallest error"},
                             {"flip_max", f.max, "the largest"}});
}

void add_z_test(std::vector<MetricValue>& list, const std::optional<ZTest>& z) {
    const auto value = [&](double ZTest::*member) {
        return z ? (*z).*member : std::numeric_limits<double>::quiet_NaN();
    };
    list.insert(
        list.end(),
        {{"z_over_2", value(&ZTest::over_2), "share of the values with |z| > 2 (of normal noise 0.0455)"},
         {"z_over_3", value(&ZTest::over_3), "share with |z| > 3 (of normal noise 0.0027)"},
         {"z_mean_square", value(&ZTest::mean_square), "mean of z^2 (of normal noise 1.04)"},
         {"z_largest", value(&ZTest::largest), "largest |z|"},
         {"z_p", value(&ZTest::p), "odds that noise alone makes such a difference of means; less is worse", true}});
}

} // namespace

ImageRgb encoded_values(const Image<Rgba8>& image) {
    ImageRgb result(image.width(), image.height());
    const auto value = [](std::uint8_t code) { return static_cast<float>(code) / 255; };
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = {value(image[i].r), value(image[i].g), value(image[i].b)};
    return result;
}

ImageRgb decoded(const ImageRgb& image) {
    ImageRgb linear = image;
    for (Rgb& pixel : linear.pixels()) pixel = {srgb_decode(pixel.r), srgb_decode(pixel.g), srgb_decode(pixel.b)};
    return linear;
}

ImageMetrics image_metrics(const ImageRgb& a, const ImageRgb& reference, Encoding encoding, int threads) {
    ImageMetrics metrics;
    metrics.errors = error_metrics(a, reference);
    metrics.ssim = ssim(a, reference, threads);
    if (encoding == Encoding::kLinear) {
        metrics.flip = hdr_flip(a, reference, kFlipPixelsPerDegree, threads);
    } else {
        static_cast<Flip&>(metrics.flip) = flip(a, reference, kFlipPixelsPerDegree, threads);
        copy_linear_metrics(metrics.errors, error_metrics(decoded(a), decoded(reference)));
    }
    return metrics;
}

std::vector<MetricValue> metric_values(const ImageMetrics& metrics) {
    std::vector<MetricValue> list;
    add_errors(list, metrics.errors);
    list.push_back({"ssim", metrics.ssim, "structural similarity, 1 for equal images; less is worse", true});
    add_flip(list, metrics.flip);
    add_z_test(list, metrics.z);
    return list;
}

} // namespace duet::compare
