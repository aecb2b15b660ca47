#include "raytrace/bidirectional/bidirectional_pass.h"

#include "common/system/error.h"
#include "common/system/parallel.h"
#include "raytrace/bidirectional/bidirectional.h"

#include <algorithm>
#include <mutex>

namespace duet::raytrace {

void check_bidirectional(const Scene& scene, const PathTracerSettings& settings) {
    if (settings.adaptive)
        throw Error("adaptive sampling gives pixels different numbers of samples, but the light paths of the "
                    "bidirectional integrator reach all pixels: expected --no-adaptive");
    if (settings.filter != FilterKind::kBox)
        throw Error(message("the bidirectional integrator weighs no light by a filter: found ",
                            filter_name(settings.filter), ", expected box"));
    if (scene.needs.media)
        throw Error("a dielectric of the scene absorbs or has a priority, which the bidirectional integrator does not "
                    "support: expected another integrator");
}

namespace {

// Rows are rendered in groups. The splats of a group are added row by row, so that the sums do not depend on threads;
// meanwhile they take memory.
constexpr int kRowsInGroup = 64;

class SampleOfAllPixels {
public:
    SampleOfAllPixels(const PassContext& context, const LightEmission& emission, std::uint32_t index)
        : context_(context), emission_(emission), index_(index), sums_(context.view.width, context.view.height) {}

    // Returns false if it was stopped.
    bool render() {
        for (int first = 0; first < context_.view.height; first += kRowsInGroup) {
            const int rows = std::min(kRowsInGroup, context_.view.height - first);
            std::vector<std::vector<Splat>> splats(static_cast<std::size_t>(rows));
            parallel_for(splats.size(), context_.settings.threads, [&](std::size_t i) {
                if (!context_.control.stopped()) render_row(first + static_cast<int>(i), splats[i]);
            });
            if (context_.control.stopped()) return false;
            for (const std::vector<Splat>& row : splats)
                for (const Splat& splat : row) sums_[splat.pixel] += Rgbd(splat.light);
        }
        return true;
    }

    void add_to_film() {
        Sampler sampler = context_.settings.make_sampler();
        sampler.start(0, 0, index_);
        for (int y = 0; y < sums_.height(); ++y)
            for (int x = 0; x < sums_.width(); ++x)
                if (!context_.checkpoint.film().add(x, y, sampler.replicate(), Rgb(sums_(x, y))))
                    context_.first_invalid = earlier_sample(context_.first_invalid, InvalidSample{index_, y, x});
    }

private:
    void render_row(int y, std::vector<Splat>& splats) {
        RayCounts counts;
        BidirectionalTracer tracer(context_.plan, emission_, context_.view, counts);
        Sampler sampler = context_.settings.make_sampler();
        for (int x = 0; x < sums_.width(); ++x) {
            sampler.start(x, y, index_);
            const Ray ray = camera_ray(context_.plan, camera_, x, y, sampler);
            const CameraRaySample u = sampler.camera_ray_samples({context_.plan.lens, context_.plan.motion});
            const Hit hit = context_.plan.prepared.accelerator.closest(ray);
            if (context_.aovs.any()) context_.aovs.add(x, y, index_, ray, hit);
            sums_(x, y) += Rgbd(tracer.trace(ray, hit, camera_.pinhole(Vec2d(u.lens)), sampler, splats));
        }
        counts.camera += sums_.width();
        const std::lock_guard lock(mutex_);
        context_.counts += counts;
    }

    const PassContext& context_;
    const LightEmission& emission_;
    const std::uint32_t index_; // of the sample, in each pixel
    const CameraModel camera_{context_.view};
    Image<Rgbd> sums_;
    std::mutex mutex_; // guards the counts
};

} // namespace

bool render_bidirectional_pass(const PassContext& context, double begin, double end) {
    const LightEmission emission(context.plan);
    const Film& film = context.checkpoint.film();
    const std::uint32_t from = film.min_samples_taken(), to = film.pixels()(0, 0).target;
    for (std::uint32_t i = from; i < to; ++i) {
        SampleOfAllPixels sample(context, emission, context.settings.first_sample + i);
        if (!sample.render()) return false;
        context.checkpoint.add([&] { sample.add_to_film(); });
        context.control.report(lerp(begin, end, static_cast<double>(i + 1 - from) / static_cast<double>(to - from)));
    }
    return true;
}

} // namespace duet::raytrace
