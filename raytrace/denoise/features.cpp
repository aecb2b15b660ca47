#include "raytrace/denoise/features.h"

#include "common/system/parallel.h"
#include "raytrace/integrator/vertex.h"

#include <array>
#include <cmath>
#include <span>

namespace duet::raytrace {

namespace {

constexpr std::size_t kInverseDepth = kFeatures - 1;
constexpr std::size_t kSamples = kFeatureSamples;

Sampler feature_sampler(const PathTracerSettings& settings) {
    const SamplerKind kind = settings.sampler == SamplerKind::kCenter ? SamplerKind::kCenter : SamplerKind::kSobol;
    return {kind, settings.seed, kFeatureSamples};
}

class RowTracer {
public:
    RowTracer(const RenderPlan& plan, const View& view, const PathTracerSettings& settings)
        : plan_(plan), camera_(view), forward_(camera_.pinhole().forward),
          samplers_(kSamples, feature_sampler(settings)), random_samples_(kSamples), points_(kSamples),
          rays_(kSamples * kPixels), hits_(kSamples * kPixels) {}

    // Traces a row of the image. The inverse depth is stored in 1/m.
    void trace(int y, Planes& features) {
        for (int x = 0; x < features.width(); x += kPixels) {
            const auto pixels = static_cast<std::size_t>(std::min(kPixels, features.width() - x));
            for (std::size_t i = 0; i < pixels; ++i) start_rays(x + static_cast<int>(i), y, i);
            const std::span<Ray> rays = std::span(rays_).first(pixels * kSamples);
            plan_.prepared.accelerator.closest(rays, std::span(hits_).first(rays.size()));
            for (std::size_t i = 0; i < pixels; ++i) {
                const std::array<double, kFeatures> means = mean_features(i);
                for (std::size_t f = 0; f < kFeatures; ++f)
                    *features.at(f, x + static_cast<int>(i), y) = static_cast<float>(means[f]);
            }
        }
    }

private:
    static constexpr int kPixels = 64; // pixels per batch of rays

    // Computes the rays of the batch's i-th pixel.
    void start_rays(int x, int y, std::size_t i) {
        Sampler::start(samplers_, x, y, 0);
        Sampler::camera_ray_samples(samplers_, plan_.camera_needs, random_samples_);
        for (std::size_t k = 0; k < kSamples; ++k) set_camera_point(points_[k], plan_, x, y, random_samples_[k]);
        camera_.rays(points_, std::span(rays_).subspan(i * kSamples, kSamples));
    }

    std::array<double, kFeatures> mean_features(std::size_t i) const {
        std::array<double, kFeatures> sums{};
        for (std::size_t k = 0; k < kSamples; ++k) {
            const Ray& ray = rays_[i * kSamples + k];
            const Hit& hit = hits_[i * kSamples + k];
            if (!hit.valid()) continue;
            const SurfacePoint point = camera_surface_point(plan_, ray, hit, static_cast<std::uint32_t>(k));
            const Rgb albedo = base_color(plan_.scene.materials[point.material], plan_.scene.textures, point);
            const Vec3 normal = dot(point.ng, ray.direction) > 0 ? -point.ns : point.ns;
            const double depth = static_cast<double>(hit.t) * dot(Vec3d(ray.direction), forward_);
            const std::array<float, kFeatures> features{
                albedo.r, albedo.g, albedo.b, normal.x, normal.y, normal.z, static_cast<float>(1 / depth)};
            for (std::size_t f = 0; f < kFeatures; ++f)
                if (std::isfinite(features[f])) sums[f] += static_cast<double>(features[f]);
        }
        for (double& sum : sums) sum /= kFeatureSamples;
        return sums;
    }

    const RenderPlan& plan_;
    const CameraModel camera_;
    const Vec3d forward_;
    std::vector<Sampler> samplers_; // the first three vectors describe one pixel
    std::vector<CameraRaySample> random_samples_;
    std::vector<CameraModel::Sample> points_;
    std::vector<Ray> rays_; // rays of the whole batch
    std::vector<Hit> hits_;
};

// Divides the inverse depths by their mean over the pixels where a surface is hit.
void normalize_inverse_depth(Planes& features) {
    constexpr double kMaxRatio = 10; // limits the effect of surfaces close to the camera
    double sum = 0, count = 0;
    for (int y = 0; y < features.height(); ++y)
        for (int x = 0; x < features.width(); ++x)
            if (const float inverse = *features.at(kInverseDepth, x, y); inverse > 0) {
                sum += static_cast<double>(inverse);
                ++count;
            }
    if (count == 0) return;
    for (int y = 0; y < features.height(); ++y)
        for (int x = 0; x < features.width(); ++x) {
            float& inverse = *features.at(kInverseDepth, x, y);
            inverse = static_cast<float>(std::min(static_cast<double>(inverse) * count / sum, kMaxRatio));
        }
}

} // namespace

Planes trace_features(const RenderPlan& plan, const View& view, const PathTracerSettings& settings) {
    Planes features(view.width, view.height, kFeatures);
    constexpr int kRows = 4; // rows per task
    parallel_for(static_cast<std::size_t>((view.height + kRows - 1) / kRows), settings.threads, [&](std::size_t task) {
        RowTracer tracer(plan, view, settings);
        const int first = static_cast<int>(task) * kRows;
        for (int y = first; y < std::min(first + kRows, view.height); ++y) tracer.trace(y, features);
    });
    normalize_inverse_depth(features);
    features.extend_to_border();
    return features;
}

} // namespace duet::raytrace
