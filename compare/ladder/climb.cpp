#include "compare/ladder/climb.h"

#include "common/system/parallel.h"
#include "raster/split.h"
#include "raytrace/split.h"

#include <atomic>
#include <mutex>

namespace duet::compare {

namespace {

/// Contributions of one camera sample to I₁ … I₇.
using Steps = std::array<Rgbd, kRungCount>;

Steps steps(const PreparedPair& pair, const raster::Screen* screen, const raytrace::CameraSample& sample) {
    const raster::LightParts hit = raster::shade_hit(pair.raster, pair.raster_settings, sample.ray, sample.hit,
                                                     sample.footprint ? &*sample.footprint : nullptr, screen);
    const raster::LightParts surface =
        sample.surface ? raster::shade_surface(pair.raster, pair.raster_settings, sample.surface->point,
                                               sample.surface->bsdf, -sample.ray.direction, screen)
                       : hit;
    const raytrace::LightParts& light = sample.light;
    const Rgbd v(surface.environment), r(surface.reflection);
    const Rgbd emission(light.emission), shadowed_direct(light.direct), environment(light.environment);
    const Rgbd seen = emission + shadowed_direct;
    return {Rgbd(hit.sum()),
            Rgbd(surface.sum()),
            emission + Rgbd(light.unshadowed()) - Rgbd(surface.shadowed) + v + r,
            seen + v + r,
            seen + environment + r,
            seen + environment + Rgbd(light.reflection),
            seen + environment + Rgbd(light.reflection) + Rgbd(light.indirect)};
}

bool is_valid(const Steps& steps) {
    constexpr std::size_t kShadowsTaken = 2; // I₃ may be negative: a light sample minus the shadows of all lights
    for (std::size_t k = 0; k < kRungCount; ++k) {
        const Rgbd& c = steps[k];
        if (!is_finite(c) || (k != kShadowsTaken && (c.r < 0 || c.g < 0 || c.b < 0))) return false;
    }
    return true;
}

/// Sums over one half of a pixel's samples.
struct Sums {
    Steps steps{};
    int count = 0;

    bool add(const Steps& sample) {
        if (!is_valid(sample)) return false;
        for (std::size_t k = 0; k < kRungCount; ++k) steps[k] += sample[k];
        ++count;
        return true;
    }
    Rgb mean(std::size_t k) const { return count > 0 ? Rgb(steps[k] / static_cast<double>(count)) : Rgb(); }
};

/// Evaluates all ladder stages for one pixel. Returns the number of invalid samples.
int climb_pixel(const PreparedPair& pair, const raster::Screen* screen, const raytrace::SplitTracer& tracer, int x,
                int y, LadderPictures& pictures) {
    std::array<Sums, 2> sums;
    int invalid = 0;
    const auto samples = static_cast<std::uint32_t>(pair.raytrace_settings.samples_per_pixel);
    for (std::uint32_t i = 0; i < samples; ++i)
        if (!sums[i % 2].add(steps(pair, screen, tracer.sample(x, y, i)))) ++invalid;
    for (std::size_t half = 0; half < 2; ++half)
        for (std::size_t k = 0; k < kRungCount; ++k) pictures.halves[half][k](x, y) = sums[half].mean(k);
    return invalid;
}

} // namespace

ImageRgb LadderPictures::picture(std::size_t k) const {
    if (k == 0) return first;
    ImageRgb mean(first.width(), first.height());
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = (halves[0][k - 1][i] + halves[1][k - 1][i]) * 0.5f;
    return mean;
}

LadderPictures climb(ImageRgb first, const PreparedPair& pair, const View& view, Control& control) {
    LadderPictures pictures;
    pictures.first = std::move(first);
    for (auto& half : pictures.halves) half.fill(ImageRgb(view.width, view.height));
    const raytrace::SplitTracer tracer(pair.raytrace, view, pair.raytrace_settings);
    const std::shared_ptr<const raster::Screen> screen =
        raster::screen_of(pair.raster, view, pair.raster_settings);
    std::atomic<std::int64_t> invalid = 0;
    std::mutex mutex; // protects the progress
    int rows_done = 0;
    parallel_for(static_cast<std::size_t>(view.height), pair.raytrace_settings.threads, [&](std::size_t row) {
        for (int x = 0; x < view.width; ++x) {
            if (control.stopped()) return;
            invalid += climb_pixel(pair, screen.get(), tracer, x, static_cast<int>(row), pictures);
        }
        const std::lock_guard lock(mutex);
        control.report(static_cast<double>(++rows_done) / view.height);
    });
    pictures.invalid_samples = invalid;
    return pictures;
}

} // namespace duet::compare
