#include "compare/ladder/evaluate_ladder.h"

#include "common/system/parallel.h"
#include "raster/shading/hit_shader.h"
#include "raytrace/component_tracer.h"

#include <algorithm>
#include <atomic>

namespace duet::compare {

namespace {

/// Holds the contributions of one camera sample to I₁ … I₇.
using StageValues = std::array<Rgbd, kRungCount>;

/// Holds the rasterizer's light toward the viewer in one pixel.
struct RasterLight {
    Rgbd emission, direct, environment, indirect, reflection, shadowed;

    RasterLight(const raster::LightComponentImages& images, int x, int y)
        : emission(at(images.emission, x, y)), direct(at(images.direct, x, y)),
          environment(at(images.environment, x, y)), indirect(at(images.indirect, x, y)),
          reflection(at(images.reflection, x, y)), shadowed(at(images.shadowed, x, y)) {}
    Rgbd sum() const { return emission + direct + environment + indirect + reflection; }

private:
    static Rgbd at(const raster::Planes3& image, int x, int y) {
        return image.empty() ? Rgbd() : Rgbd(image.color_at(x, y)); // empty if the scene has no such light
    }
};

StageValues stage_values(const RasterLight& hit, const RasterLight& surface, const raytrace::LightComponents& light) {
    const Rgbd &v = surface.environment, &g = surface.indirect, &r = surface.reflection;
    const Rgbd emission(light.emission), environment(light.environment), reflection(light.reflection);
    const Rgbd direct = emission + Rgbd(light.direct);
    return {hit.sum(),
            surface.sum(),
            emission + Rgbd(light.unshadowed()) - surface.shadowed + v + g + r,
            direct + v + g + r,
            direct + environment + g + r,
            direct + environment + g + reflection,
            direct + environment + Rgbd(light.indirect) + reflection};
}

/// Returns whether all stages are finite and the path tracer's image, the last one, is not negative. Other stages may
/// be negative, because they contain differences of noisy light.
bool is_valid(const StageValues& steps) {
    const Rgbd& last = steps.back();
    return std::all_of(steps.begin(), steps.end(), [](const Rgbd& c) { return is_finite(c); }) && last.r >= 0 &&
           last.g >= 0 && last.b >= 0;
}

/// Traces and shades one sample of each pixel, and adds it to the means.
class LadderEvaluation {
public:
    LadderEvaluation(const PreparedPair& pair, const View& view, LadderImages& images)
        : pair_(pair), view_(view), images_(images), tracer_(pair.raytrace, view, pair.raytrace_settings),
          hits_(pair.raster.data(), view, pair.raster_settings),
          surfaces_(pair.raster.data(), view, pair.raster_settings),
          light_(view.width, view.height) {
        counts_.fill(Image<int>(view.width, view.height, 0));
    }

    void add_sample(std::uint32_t index) {
        for_each_pixel([&](int x, int y) { trace(x, y, index); });
        const raster::LightComponentImages hit = hits_.shade(), surface = surfaces_.shade();
        for_each_pixel([&](int x, int y) {
            add(x, y, index % 2, stage_values(RasterLight(hit, x, y), RasterLight(surface, x, y), light_(x, y)));
        });
    }
    std::int64_t invalid() const { return invalid_; }

private:
    template <typename Visit> void for_each_pixel(const Visit& visit) const {
        parallel_for(static_cast<std::size_t>(view_.height), pair_.raytrace_settings.threads, [&](std::size_t row) {
            for (int x = 0; x < view_.width; ++x) visit(x, static_cast<int>(row));
        });
    }
    void trace(int x, int y, std::uint32_t index) {
        const raytrace::PixelSample sample = tracer_.sample(x, y, index);
        light_(x, y) = sample.light;
        hits_.set(x, y, sample.ray, sample.hit, sample.footprint ? &*sample.footprint : nullptr);
        if (sample.surface)
            surfaces_.set(x, y, sample.ray, sample.surface->point, sample.surface->bsdf);
        else
            surfaces_.set(x, y, sample.ray, Hit{}, nullptr);
    }
    void add(int x, int y, std::size_t half, const StageValues& steps) {
        if (!is_valid(steps)) {
            ++invalid_;
            return;
        }
        const double part = 1.0 / ++counts_[half](x, y);
        for (std::size_t k = 0; k < kRungCount; ++k) {
            Rgb& mean = images_.halves[half][k](x, y);
            mean = Rgb(Rgbd(mean) + (steps[k] - Rgbd(mean)) * part);
        }
    }

    const PreparedPair& pair_;
    const View& view_;
    LadderImages& images_;
    raytrace::ComponentTracer tracer_;
    raster::HitShader hits_, surfaces_;
    Image<raytrace::LightComponents> light_; ///< of the current sample
    std::array<Image<int>, 2> counts_;       ///< valid samples of each half
    std::atomic<std::int64_t> invalid_ = 0;
};

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
    LadderEvaluation evaluation(pair, view, images);
    const auto samples = static_cast<std::uint32_t>(pair.raytrace_settings.samples_per_pixel);
    for (std::uint32_t i = 0; i < samples && !control.stopped(); ++i) {
        evaluation.add_sample(i);
        control.report(static_cast<double>(i + 1) / samples);
    }
    images.invalid_samples = evaluation.invalid();
    return images;
}

} // namespace duet::compare
