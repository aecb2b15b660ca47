// Lesson raytrace-04: the lesson's random samples have the mean and the error that theory says, as those of the library
// have; and a picture of 1920 x 1080 pixels at 100 samples each, with its time.
#include "common/scene/scene.h"
#include "common/system/stopwatch.h"
#include "raytrace/lessons/04-antialiasing/sampling.h"
#include "raytrace/render.h"
#include "raytrace/sampling/sampler.h"

#include <doctest/doctest.h>

using namespace duet;

namespace {

constexpr int kSize = 64, kSamples = 16;
constexpr double kCovered = 0.3; // of each pixel, left of a straight edge
Rgb edge(float x) { return Rgb(x - std::floor(x) < static_cast<float>(kCovered) ? 1.0f : 0.0f); }

struct MeanAndError {
    double mean = 0, error = 0;
};
MeanAndError against_coverage(const ImageRgb& image) {
    MeanAndError result;
    for (const Rgb& pixel : image) {
        result.mean += double{pixel.g} / static_cast<double>(image.size());
        result.error += sqr(double{pixel.g} - kCovered) / static_cast<double>(image.size());
    }
    result.error = std::sqrt(result.error);
    return result;
}

ImageRgb sampled(SamplerKind kind) {
    ImageRgb image(kSize, kSize);
    Sampler sampler(kind, 1, kSamples);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            for (std::uint32_t i = 0; i < kSamples; ++i) {
                sampler.start(x, y, i);
                image(x, y) += edge(static_cast<float>(x) + sampler.get_2d().x) / static_cast<float>(kSamples);
            }
    return image;
}

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("raytrace-04: the error of random samples is that of theory, in the lesson and in the library") {
        // 4096 pixels: their mean deviates by √(0.21 / 16 / 4096) = 0.0018, and the measured error by 1.2 percent of
        // itself. The limits are five times as much or more: a false alarm has the odds of one in a million.
        const double expected = std::sqrt(kCovered * (1 - kCovered) / kSamples);
        const auto lesson = against_coverage(
            lesson::average_samples(kSize, kSize, kSamples, [](float x, float, lesson::Random&) { return edge(x); }));
        const auto library = against_coverage(sampled(SamplerKind::kIndependent));
        for (const MeanAndError& found : {lesson, library}) {
            CHECK(std::abs(found.mean - kCovered) < 0.01);
            CHECK(std::abs(found.error - expected) < 0.06 * expected);
        }
        // The library's cells are finer: one sample in each of 16 columns. The edge lies at 4.8 of them, so one sample
        // decides, with the chance 0.8: √(0.8·0.2) / 16 = 0.025.
        const auto cells = against_coverage(sampled(SamplerKind::kStratified));
        CHECK(std::abs(cells.mean - kCovered) < 0.01);
        CHECK(std::abs(cells.error - 0.025) < 0.1 * 0.025);
    }

    TEST_CASE("raytrace-04: 1920 x 1080 pixels at 100 samples each") {
#ifdef DUET_SANITIZED
        constexpr int kPerPixel = 2; // with sanitizers a hundred would take a quarter of an hour
#else
        constexpr int kPerPixel = 100;
#endif
        const Scene scene = load_scene(DUET_SOURCE_DIR "/models/spheres.json");
        raytrace::PathTracerSettings settings;
        settings.samples_per_pixel = kPerPixel;
        const raytrace::PathTracerScene prepared = raytrace::prepare(scene, settings);
        Control control;
        const auto mean_of = [](const ImageRgb& image) {
            Rgbd sum;
            for (const Rgb& pixel : image) sum += Rgbd(pixel);
            return sum / static_cast<double>(image.size());
        };
        const Stopwatch watch;
        const Rendering full = raytrace::render(prepared, {scene.camera, 1920, 1080}, settings, control);
        MESSAGE("1920 x 1080 pixels, ", kPerPixel, " samples per pixel: ", watch.seconds(), " s");
        REQUIRE(full.radiance.width() == 1920);
        REQUIRE(full.radiance.height() == 1080);
        CHECK(full.statistics.samples_per_pixel == kPerPixel);
        CHECK(full.statistics.camera_rays == std::int64_t{1920} * 1080 * kPerPixel);
        CHECK(full.statistics.indirect_rays > full.statistics.camera_rays / 2);
        CHECK(full.statistics.invalid_samples == 0);
        // A picture of a sixth of the width and height shows the same light. Its pixels are noisier, but the mean of
        // 57,600 of them is off by less than a thousandth.
        const Rendering small = raytrace::render(prepared, {scene.camera, 320, 180}, settings, control);
        const Rgbd a = mean_of(full.radiance), b = mean_of(small.radiance);
        for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(a[c] - b[c]) < 0.005 * a[c]);
    }
}
