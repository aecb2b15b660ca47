#include "raytrace/bidirectional/bidirectional_pass.h"

#include "common/system/error.h"
#include "raytrace/bidirectional/bidirectional.h"
#include "raytrace/bidirectional/metropolis.h"
#include "raytrace/bidirectional/run_in_order.h"

#include <algorithm>
#include <cmath>

namespace duet::raytrace {

void check_bidirectional(const Scene& scene, const PathTracerSettings& settings) {
    if (settings.adaptive)
        throw Error(message("adaptive sampling gives pixels different numbers of samples, but the light paths of the "
                            "integrator ",
                            integrator_name(settings.integrator), " reach all pixels: expected --no-adaptive"));
    if (settings.filter != FilterKind::kBox)
        throw Error(message("the integrator ", integrator_name(settings.integrator),
                            " weighs no light by a filter: found ", filter_name(settings.filter), ", expected box"));
    if (settings.integrator == Integrator::kMetropolis && settings.sampler == SamplerKind::kCenter)
        throw Error("the chains of the integrator metropolis move over the whole image: found the sampler center, "
                    "expected another");
    if (scene.needs.interiors)
        throw Error(message("a dielectric of the scene absorbs or has a priority, which the integrator ",
                            integrator_name(settings.integrator), " does not support: expected another"));
    if (scene.needs.subsurface)
        throw Error(message("the scene has subsurface scattering, which the integrator ",
                            integrator_name(settings.integrator), " does not support: expected another"));
    if (scene.needs.media)
        throw Error(message("the scene has media, which the integrator ", integrator_name(settings.integrator),
                            " does not support: expected another"));
}

namespace {

constexpr std::size_t kRowsInGroup = 64; // splats and photons of this many rows are stored at a time

// The initial radius of merging is this number of pixel widths, measured at the median of the visible surfaces. Sample
// i merges over the initial radius times (i + 1)^(-1/8). The variance and the bias then both vanish with more samples
// (Knaus and Zwicker 2011, "Progressive Photon Mapping: A Probabilistic Approach", whose α is 3/4 here).
constexpr double kFirstRadius = 1.5;

// Returns the radius of merging for the first sample, in meters.
double first_radius(const RenderPlan& plan, const View& view) {
    constexpr int kGrid = 16; // rays per axis
    const CameraModel camera(view);
    const Pinhole pinhole = camera.pinhole();
    std::vector<double> pixels; // widths of pixels in meters
    const auto add_pixel_at = [&](Vec3d p) {
        if (const auto seen = seen_through(pinhole, p)) pixels.push_back(1 / std::sqrt(seen->pixel_density));
    };
    for (int i = 0; i < kGrid * kGrid; ++i) {
        const Vec2d at((i % kGrid + 0.5) / kGrid * view.width, (i / kGrid + 0.5) / kGrid * view.height);
        const Ray ray = camera.ray(at, {0.5, 0.5}, 0.5);
        if (const Hit hit = plan.prepared.accelerator.closest(ray); hit.valid())
            add_pixel_at(Vec3d(ray.origin) + Vec3d(ray.direction) * static_cast<double>(hit.t));
    }
    if (pixels.empty()) add_pixel_at(view.camera.look_at);
    if (pixels.empty()) return 0;
    const auto median = pixels.begin() + static_cast<std::ptrdiff_t>(pixels.size() / 2);
    std::nth_element(pixels.begin(), median, pixels.end());
    return kFirstRadius * *median;
}

class SampleOfAllPixels {
public:
    // `first_radius` is the radius of merging for the first sample; with 0, subpaths do not merge.
    SampleOfAllPixels(const PassContext& context, const LightEmission& emission, double first_radius,
                      std::uint32_t index)
        : context_(context), emission_(emission), index_(index),
          radius_(static_cast<float>(first_radius * std::pow(index + 1.0, -0.125))),
          sums_(context.view.width, context.view.height) {}

    // Returns the radiance of all pixels, or nothing if it was stopped. If subpaths merge, all light subpaths are
    // traced before the camera subpaths. To be connected, light subpaths are traced again together with their camera
    // subpaths, because storing their vertices would take gigabytes.
    std::optional<Image<Rgbd>> render() {
        bool complete = render_rows(true, radius_ == 0);
        if (complete && radius_ > 0) {
            photon_map_.emplace(std::move(photons_), radius_, context_.settings.threads);
            complete = render_rows(false, true);
        }
        return complete ? std::optional(std::move(sums_)) : std::nullopt;
    }

private:
    // Holds the results of the subpaths of a row.
    struct Row {
        std::vector<Splat> splats;
        std::vector<Photon> photons;
    };

    bool render_rows(bool light, bool camera) {
        return run_in_order<Row>(
            context_, static_cast<std::size_t>(context_.view.height), kRowsInGroup,
            [&](std::size_t y, Row& row, RayCounts& counts) {
                render_row(static_cast<int>(y), light, camera, row, counts);
            },
            [&](const Row& row) {
                for (const Splat& splat : row.splats) sums_[splat.pixel] += Rgbd(splat.light);
                photons_.insert(photons_.end(), row.photons.begin(), row.photons.end());
            });
    }

    // Returns the common time of all rays if subpaths merge, because a photon is valid only at its own time.
    float common_time() const {
        Sampler sampler = context_.settings.make_sampler();
        sampler.start(0, 0, index_);
        const CameraRaySample u = sampler.camera_ray_samples({false, context_.plan.camera_needs.time});
        return static_cast<float>(camera_.time(static_cast<double>(u.time)));
    }

    void render_row(int y, bool light, bool camera, Row& row, RayCounts& counts) {
        BidirectionalTracer tracer(context_.plan, emission_, context_.view, context_.settings.integrator, radius_,
                                   counts);
        const bool connected = connects(context_.settings.integrator);
        Sampler sampler = context_.settings.make_sampler();
        for (int x = 0; x < sums_.width(); ++x) {
            sampler.start(x, y, index_);
            Ray ray = camera_ray(context_.plan, camera_, x, y, sampler);
            if (radius_ > 0) ray.time = time_;
            const CameraRaySample u = sampler.camera_ray_samples(context_.plan.camera_needs);
            const Pinhole pinhole = camera_.pinhole(Vec2d(u.lens));
            if (light || connected) tracer.trace_light_subpath(ray.time, sampler);
            if (light) {
                if (connected) tracer.connect_to_camera(pinhole, row.splats);
                if (radius_ > 0) tracer.add_photons(row.photons);
            }
            if (!camera) continue;
            ++counts.camera;
            const Hit hit = context_.plan.prepared.accelerator.closest(ray);
            if (context_.aovs.any()) context_.aovs.add(x, y, index_, ray, hit);
            const PhotonMap* const photons = photon_map_ ? &*photon_map_ : nullptr;
            sums_(x, y) += Rgbd(tracer.trace_camera_subpath(ray, hit, pinhole, sampler, photons));
        }
    }

    const PassContext& context_;
    const LightEmission& emission_;
    const std::uint32_t index_; // index of the sample in each pixel
    const float radius_;        // radius of merging; 0: none
    const CameraModel camera_{context_.view};
    const float time_ = common_time();
    Image<Rgbd> sums_;
    std::vector<Photon> photons_;
    std::optional<PhotonMap> photon_map_;
};

void add_to_film(const PassContext& context, const Image<Rgbd>& sample, std::uint32_t index) {
    Sampler sampler = context.settings.make_sampler();
    sampler.start(0, 0, index);
    for (int y = 0; y < sample.height(); ++y)
        for (int x = 0; x < sample.width(); ++x)
            if (!context.checkpoint.film().add(x, y, sampler.replicate(), Rgb(sample(x, y))))
                context.first_invalid = earlier_sample(context.first_invalid, InvalidSample{index, y, x});
}

} // namespace

bool render_bidirectional_pass(const PassContext& context, double begin, double end) {
    const LightEmission emission(context.plan);
    const double radius = merges(context.settings.integrator) ? first_radius(context.plan, context.view) : 0;
    std::optional<Metropolis> metropolis;
    if (context.settings.integrator == Integrator::kMetropolis) metropolis.emplace(context, emission);
    const Film& film = context.checkpoint.film();
    const std::uint32_t from = film.min_samples_taken(), to = film.pixels()(0, 0).target;
    for (std::uint32_t i = from; i < to; ++i) {
        const std::uint32_t index = context.settings.first_sample + i;
        const std::optional<Image<Rgbd>> sample =
            metropolis ? metropolis->sample(index) : SampleOfAllPixels(context, emission, radius, index).render();
        if (!sample) return false;
        context.checkpoint.run([&] { add_to_film(context, *sample, index); });
        context.control.report(lerp(begin, end, static_cast<double>(i + 1 - from) / static_cast<double>(to - from)));
    }
    return true;
}

} // namespace duet::raytrace
