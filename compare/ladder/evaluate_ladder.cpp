#include "compare/ladder/evaluate_ladder.h"

#include "common/system/parallel.h"
#include "raster/shading/light_components.h"
#include "raytrace/component_tracer.h"

#include <atomic>
#include <mutex>

namespace duet::compare {

namespace {

/// Contributions of one camera sample to I₁ … I₇.
using StageValues = std::array<Rgbd, kRungCount>;

StageValues stage_values(const PreparedPair& pair, const raster::ScreenGBuffer* gbuffer,
                         const raytrace::PixelSample& sample) {
    const raster::LightComponents hit = raster::shade_hit(pair.raster, pair.raster_settings, sample.ray, sample.hit,
                                                          sample.footprint ? &*sample.footprint : nullptr, gbuffer);
    const raster::LightComponents surface =
        sample.surface ? raster::shade_surface(pair.raster, pair.raster_settings, sample.surface->point,
                                               sample.surface->bsdf, -sample.ray.direction, gbuffer)
                       : hit;
    const raytrace::LightComponents& light = sample.light;
    const Rgbd v(surface.environment), r(surface.reflection);
    const Rgbd emission(light.emission), shadowed_direct(light.direct), environment(light.environment);
    const Rgbd emitted_and_direct = emission + shadowed_direct;
    return {Rgbd(hit.sum()),
            Rgbd(surface.sum()),
            emission + Rgbd(light.unshadowed()) - Rgbd(surface.shadowed) + v + r,
            emitted_and_direct + v + r,
            emitted_and_direct + environment + r,
            emitted_and_direct + environment + Rgbd(light.reflection),
            emitted_and_direct + environment + Rgbd(light.reflection) + Rgbd(light.indirect)};
}

bool is_valid(const StageValues& steps) {
    constexpr std::size_t kShadowsRemoved = 2; // I₃ may be negative: a light sample minus the shadows of all lights
    for (std::size_t k = 0; k < kRungCount; ++k) {
        const Rgbd& c = steps[k];
        if (!is_finite(c) || (k != kShadowsRemoved && (c.r < 0 || c.g < 0 || c.b < 0))) return false;
    }
    return true;
}

/// Sums over one half of a pixel's samples.
struct Sums {
    StageValues steps{};
    int count = 0;

    bool add(const StageValues& sample) {
        if (!is_valid(sample)) return false;
        for (std::size_t k = 0; k < kRungCount; ++k) steps[k] += sample[k];
        ++count;
        return true;
    }
    Rgb mean(std::size_t k) const { return count > 0 ? Rgb(steps[k] / static_cast<double>(count)) : Rgb(); }
};

/// Evaluates all ladder stages for one pixel. Returns the number of invalid samples.
int evaluate_pixel(const PreparedPair& pair, const raster::ScreenGBuffer* gbuffer,
                   const raytrace::ComponentTracer& tracer, int x, int y, LadderImages& images) {
    std::array<Sums, 2> sums;
    int invalid = 0;
    const auto samples = static_cast<std::uint32_t>(pair.raytrace_settings.samples_per_pixel);
    for (std::uint32_t i = 0; i < samples; ++i)
        if (!sums[i % 2].add(stage_values(pair, gbuffer, tracer.sample(x, y, i)))) ++invalid;
    for (std::size_t half = 0; half < 2; ++half)
        for (std::size_t k = 0; k < kRungCount; ++k) images.halves[half][k](x, y) = sums[half].mean(k);
    return invalid;
}

} // namespace

ImageRgb LadderImages::image(std::size_t k) const {
    if (k == 0) return first;
    ImageRgb mean(first.width(), first.height());
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = (halves[0][k - 1][i] + halves[1][k - 1][i]) * 0.5f;
    return mean;
}

LadderImages evaluate_ladder(ImageRgb first, const PreparedPair& pair, const View& view, Control& control) {
    LadderImages images;
    images.first = std::move(first);
    for (auto& half : images.halves) half.fill(ImageRgb(view.width, view.height));
    const raytrace::ComponentTracer tracer(pair.raytrace, view, pair.raytrace_settings);
    const std::shared_ptr<const raster::ScreenGBuffer> gbuffer =
        raster::make_screen_gbuffer(pair.raster, view, pair.raster_settings);
    std::atomic<std::int64_t> invalid = 0;
    std::mutex mutex; // protects the progress
    int rows_done = 0;
    parallel_for(static_cast<std::size_t>(view.height), pair.raytrace_settings.threads, [&](std::size_t row) {
        for (int x = 0; x < view.width; ++x) {
            if (control.stopped()) return;
            invalid += evaluate_pixel(pair, gbuffer.get(), tracer, x, static_cast<int>(row), images);
        }
        const std::lock_guard lock(mutex);
        control.report(static_cast<double>(++rows_done) / view.height);
    });
    images.invalid_samples = invalid;
    return images;
}

} // namespace duet::compare
