#include "compare/bench/render_reference.h"

#include "common/sampling/hash.h"
#include "common/scene/scene_hash.h"
#include "compare/report/output.h"
#include "raytrace/render.h"

#include <algorithm>
#include <utility>

namespace duet::compare {

namespace {

/// Returns a seed per estimator, far from the trials' seeds, which count up from small numbers.
std::uint64_t reference_seed(const std::string& estimator) {
    std::uint64_t seed = 0x7265666572656e63u; // "referenc"
    for (const char c : estimator) seed = hash_combine(seed, static_cast<unsigned char>(c));
    return seed;
}

/// Accumulates images and their squares in double precision.
class ImageAccumulator {
public:
    ImageAccumulator(int width, int height) : sums_(width, height), squares_(width, height) {}

    void add(const ImageRgb& image) {
        DUET_CHECK_EQ(image.size(), sums_.size());
        ++count_;
        for (std::size_t i = 0; i < image.size(); ++i) {
            const Rgbd value(image[i]);
            sums_[i] += value;
            squares_[i] += value * value;
        }
    }
    /// Returns the mean and the variance of the mean.
    Reference reference() const {
        Reference r{ImageRgb(sums_.width(), sums_.height()), ImageRgb(sums_.width(), sums_.height())};
        const double n = count_;
        for (std::size_t i = 0; i < sums_.size(); ++i) {
            const Rgbd mean = sums_[i] / n;
            r.mean[i] = Rgb(mean);
            for (std::size_t c = 0; c < 3; ++c)
                r.variance[i][c] =
                    static_cast<float>(std::max(0.0, squares_[i][c] / n - sqr(mean[c])) / std::max(1.0, n - 1));
        }
        return r;
    }

private:
    Image<Rgbd> sums_, squares_;
    int count_ = 0;
};

CachedReference load_or_render(const EstimatorId& estimator, const Scene& scene, const View& view,
                               const ReferenceSettings& settings,
                               const std::function<Reference(const std::filesystem::path& unfinished)>& render,
                               const Control& control) {
    const ReferenceKey key{hash_scene_files(scene), estimator.name, estimator.version, view.width, view.height,
                           settings.depth,          settings.spp,   estimator.program};
    const std::string name = scene.path.stem().string();
    const ReferenceCache cache(settings.folder);
    CachedReference cached{{}, estimator.name, cache.path(name, key), false};
    if (std::optional<Reference> found = cache.find(name, key)) {
        cached.reference = std::move(*found);
    } else {
        std::filesystem::path unfinished = cached.file;
        unfinished.replace_extension(".film.exr");
        make_folder(settings.folder);
        Reference rendered = render(unfinished);
        if (control.stopped()) return cached;
        cached.reference = std::move(rendered);
        cached.rendered = true;
        cache.store(name, key, cached.reference);
        std::error_code ignored;
        std::filesystem::remove(unfinished, ignored);
    }
    return cached;
}

} // namespace

std::string naive_limitation(const Scene& scene) {
    return scene.needs.delta_lights ? "naive cannot find point, spot and sun lights" : "";
}

CachedReference reference_by(const std::string& estimator, const Scene& scene, const View& view,
                             const ReferenceSettings& settings, Control& control) {
    const auto render = [&](const std::filesystem::path& unfinished) {
        raytrace::PathTracerSettings s;
        s.film = unfinished;
        s.integrator = raytrace::integrator(estimator);
        s.samples_per_pixel = settings.spp;
        s.max_depth = settings.depth;
        s.threads = settings.threads;
        s.seed = reference_seed(estimator);
        s.aovs.variance = true;
        Rendering rendering = raytrace::render(raytrace::prepare(scene, s), view, s, control);
        return Reference{std::move(rendering.radiance), std::move(rendering.variance)};
    };
    return load_or_render({estimator, raytrace::kEstimatorVersion, ""}, scene, view, settings, render, control);
}

CachedReference reference_by_seeds(const EstimatorId& estimator, const Scene& scene, const View& view,
                                   const ReferenceSettings& settings,
                                   const std::function<ImageRgb(int spp, std::uint64_t seed)>& render,
                                   Control& control) {
    const auto render_all = [&](const std::filesystem::path&) {
        ImageAccumulator mean(view.width, view.height);
        const int spp = std::max(2, settings.spp / kReferenceSeeds);
        for (int i = 0; i < kReferenceSeeds && !control.stopped(); ++i) {
            const ImageRgb image = render(spp, reference_seed(estimator.name) + static_cast<std::uint64_t>(i));
            if (!control.stopped()) mean.add(image);
            control.report(static_cast<double>(i + 1) / kReferenceSeeds);
        }
        return mean.reference();
    };
    return load_or_render(estimator, scene, view, settings, render_all, control);
}

} // namespace duet::compare
