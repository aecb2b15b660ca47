#include "raytrace/pass.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <atomic>
#include <mutex>

namespace duet::raytrace {

std::optional<SampleRange> next_pass(const Settings& settings, std::uint32_t done, double seconds, const Film& film) {
    const auto asked = static_cast<std::uint32_t>(settings.samples_per_pixel);
    if (done >= asked) return std::nullopt;
    const bool limited = settings.time_limit > 0 || settings.error_limit > 0;
    if (!limited) return SampleRange{done, std::min(done + 16, asked)};
    // Even counts: both replicates grow alike.
    const std::uint32_t count = std::min(std::clamp(done / 4 & ~1u, 2u, 32u), asked - done);
    if (done > 0 && settings.time_limit > 0) {
        const double expected = seconds / done * count;
        if (seconds + expected / 2 > settings.time_limit) return std::nullopt;
    }
    // A first few samples that all miss the lights look converged: the estimate is asked from kMinForError samples on.
    constexpr std::uint32_t kMinForError = 16;
    if (settings.error_limit > 0 && done >= kMinForError) {
        const double error = film.estimated_relmse();
        if (error >= 0 && error < settings.error_limit) return std::nullopt;
    }
    return SampleRange{done, done + count};
}

Ray camera_ray(const RenderPlan& plan, const CameraModel& camera, int x, int y, Sampler& sampler) {
    sampler.set_dimension(kPixelDimension);
    const Vec2 in_pixel = sampler.get_centered_2d();
    Vec2d lens{0.5, 0.5};
    if (plan.lens) {
        sampler.set_dimension(kLensDimension);
        lens = Vec2d(sampler.get_centered_2d());
    }
    double time = 0;
    if (plan.motion) {
        sampler.set_dimension(kTimeDimension);
        time = static_cast<double>(sampler.get_time());
    }
    return camera.ray(Vec2d(x, y) + Vec2d(in_pixel), lens, time);
}

namespace {

constexpr int kTile = 16;

struct Tile {
    int x0, y0, x1, y1;
};

class Tiles {
public:
    explicit Tiles(const View& view) : view_(view), columns_((view.width + kTile - 1) / kTile) {}

    std::size_t count() const {
        return static_cast<std::size_t>(columns_) * static_cast<std::size_t>((view_.height + kTile - 1) / kTile);
    }
    Tile operator[](std::size_t i) const {
        const int x = static_cast<int>(i % static_cast<std::size_t>(columns_)) * kTile;
        const int y = static_cast<int>(i / static_cast<std::size_t>(columns_)) * kTile;
        return {x, y, std::min(x + kTile, view_.width), std::min(y + kTile, view_.height)};
    }

private:
    const View& view_;
    int columns_;
};

RayCounts render_tile(const PassTarget& target, const CameraModel& camera, const Tile& tile, SampleRange range) {
    const RadianceFunction radiance = radiance_function(target.settings.integrator);
    Sampler sampler(target.settings.sampler, target.settings.seed, target.settings.samples_per_pixel);
    RayCounts counts;
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x)
            for (std::uint32_t index = range.first; index < range.last; ++index) {
                sampler.start(x, y, index);
                const Ray ray = camera_ray(target.plan, camera, x, y, sampler);
                const Hit hit = target.plan.prepared.accelerator.closest(ray);
                ++counts.camera;
                target.film.add(x, y, index & 1u, radiance(target.plan, ray, hit, sampler, counts));
                if (target.aovs.any()) target.aovs.add(x, y, index, ray, hit);
            }
    return counts;
}

} // namespace

bool render_pass(const PassTarget& target, SampleRange range, double begin, double end) {
    const Tiles tiles(target.view);
    const CameraModel camera(target.view);
    std::atomic<bool> complete = true;
    std::mutex mutex; // of the counts and the progress
    std::size_t finished = 0;
    parallel_for(tiles.count(), target.settings.threads, [&](std::size_t i) {
        if (target.control.stopped()) {
            complete = false;
            return;
        }
        const RayCounts counts = render_tile(target, camera, tiles[i], range);
        const std::lock_guard lock(mutex);
        target.counts += counts;
        target.control.report(lerp(begin, end, static_cast<double>(++finished) / static_cast<double>(tiles.count())));
    });
    return complete;
}

} // namespace duet::raytrace
