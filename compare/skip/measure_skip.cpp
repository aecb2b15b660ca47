#include "compare/skip/measure_skip.h"

#include "common/image/bitwise_equal.h"
#include "compare/timing.h"

#include <algorithm>

namespace duet::compare {

namespace {

std::int64_t pixels_that_differ(const ImageRgb& a, const ImageRgb& b) {
    DUET_CHECK_EQ(a.size(), b.size());
    std::int64_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += !bitwise_equal(a[i], b[i]);
    return count;
}

Rgbd mean_color(const ImageRgb& image) {
    Rgbd sum;
    for (const Rgb& pixel : image) sum += Rgbd(pixel);
    return sum / static_cast<double>(image.size());
}

SkipMeasurement::Seconds summary(const std::vector<double>& seconds) {
    return {median(seconds), *std::min_element(seconds.begin(), seconds.end())};
}

std::int64_t rays(const Rendering& rendering) {
    return rendering.statistics.indirect_rays + rendering.statistics.shadow_rays;
}

std::string reason_of(const SkipCase& skip, const Rendering& rendering) {
    for (const SkippedWork& s : rendering.statistics.skipped)
        if (s.what == skip.statistic) return s.count < 0 ? s.why : message(s.count, ": ", s.why);
    return skip.statistic.empty() ? "" : "this scene has none to leave out";
}

/// Renders the repeats, each with and without the skip. The order alternates, so that neither of the two always
/// benefits from warm caches.
void render_repeats(SkipMeasurement& result, const SkipCase& skip, const View& view, const SkipMeasureSettings& options,
                    Control& control) {
    std::vector<double> seconds[2];
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
        Rendering images[2];
        for (const int turn : {0, 1}) {
            const int with = (turn + repeat) % 2;
            const Stopwatch watch;
            Control inner{control.stop, {}};
            images[with] = skip.render(view, options.seed + static_cast<std::uint64_t>(repeat), with == 1, inner);
            seconds[with].push_back(watch.seconds());
        }
        if (control.stopped()) return;
        ++result.image_pairs;
        result.pixels_differ += pixels_that_differ(images[0].radiance, images[1].radiance);
        result.rays_saved += rays(images[0]) - rays(images[1]);
        result.reason = reason_of(skip, images[1]);
        control.report(0.2 * (repeat + 1) / options.repeats);
    }
    result.without = summary(seconds[0]);
    result.with = summary(seconds[1]);
}

/// Renders pairs until the bias would be detected or the time limit is reached. The number of pairs depends on
/// the spread of the differences and not on their mean, so that stopping favors neither verdict.
BiasTest find_bias(const SkipCase& skip, const View& view, const SkipMeasureSettings& options, Control& control) {
    constexpr int kBatch = 32;
    BiasTest test;
    const Stopwatch watch;
    const std::uint64_t first_seed = options.seed + static_cast<std::uint64_t>(options.repeats);
    Control inner{control.stop, {}};
    while (!control.stopped() && watch.seconds() < options.budget) {
        for (int i = 0; i < kBatch && !control.stopped(); ++i) {
            const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(test.pairs());
            const ImageRgb with = skip.render(view, seed, true, inner).radiance;
            const ImageRgb without = skip.render(view, seed, false, inner).radiance;
            if (control.stopped()) break;
            test.add(mean_color(with), mean_color(without));
            const double done =
                std::max(test.pairs() / test.pairs_needed(options.bias), watch.seconds() / options.budget);
            control.report(0.2 + 0.8 * std::min(done, 1.0));
        }
        if (test.detectable() <= options.bias) break;
    }
    return test;
}

} // namespace

SkipMeasurement measure_skip(const SkipCase& skip, const View& view, const SkipMeasureSettings& options,
                             Control& control) {
    SkipMeasurement result;
    render_repeats(result, skip, view, options, control);
    if (control.stopped()) return result;
    result.proved = result.pixels_differ == 0;
    if (!result.proved && skip.proof == SkipProof::kNoBias) {
        result.bias = find_bias(skip, view, options, control);
        result.proved = result.bias->detectable() <= options.bias && result.bias->p() >= kFalseAlarmProbability;
    }
    return result;
}

} // namespace duet::compare
