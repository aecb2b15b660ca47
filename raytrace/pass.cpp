#include "raytrace/pass.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <span>
#include <vector>

namespace duet::raytrace {

namespace {

Sampler::CameraNeeds camera_needs(const RenderPlan& plan) { return {plan.lens, plan.motion}; }

// This function writes each number directly to its destination. If a whole point were copied right after its
// components were written, that load would wait for their stores.
void set_point(CameraModel::Point& point, const RenderPlan& plan, int x, int y, const CameraNumbers& u) {
    const Vec2d offset = plan.filter.sample(u.pixel);
    point.pixel.x = x + 0.5 + offset.x;
    point.pixel.y = y + 0.5 + offset.y;
    point.lens = u.lens;
    point.time = u.time;
}

} // namespace

Ray camera_ray(const RenderPlan& plan, const CameraModel& camera, int x, int y, const Sampler& sampler) {
    CameraModel::Point point;
    set_point(point, plan, x, y, sampler.camera_numbers(camera_needs(plan)));
    return camera.ray(point.pixel, Vec2d(point.lens), static_cast<double>(point.time));
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

// Camera rays are traced in batches, because those of neighboring pixels, and of one pixel's samples, are coherent.
class CameraBatch {
public:
    /// `most` is the number of samples to come.
    CameraBatch(const PassTarget& target, const CameraModel& camera, std::size_t most)
        : target_(target), camera_(camera), size_(std::min(most, kMost)),
          samplers_(size_, target.settings.make_sampler()), points_(size_), rays_(size_), hits_(size_),
          radiances_(size_) {
        samples_.reserve(size_);
    }

    // Adds samples [begin, end) of a pixel.
    void add(int x, int y, std::uint32_t begin, std::uint32_t end) {
        while (begin < end) {
            const std::size_t old = samples_.size();
            const auto some = static_cast<std::uint32_t>(std::min<std::size_t>(end - begin, size_ - old));
            Sampler::start(std::span(samplers_).subspan(old, some), x, y, begin);
            for (const std::uint32_t last = begin + some; begin < last; ++begin) samples_.push_back({x, y, begin});
            if (samples_.size() == size_) finish();
        }
    }

    // Renders the samples that have been added but not been rendered yet.
    void finish() {
        const std::size_t size = samples_.size();
        if (size == 0) return;
        const auto rays = std::span(rays_).first(size);
        const auto hits = std::span(hits_).first(size);
        start_rays(rays);
        target_.plan.prepared.accelerator.closest(rays, hits);
        if (target_.aovs.any())
            for (std::size_t i = 0; i < size; ++i)
                target_.aovs.add(samples_[i].x, samples_[i].y, samples_[i].index, rays[i], hits[i]);
        radiances(target_.settings.integrator, target_.plan, rays, hits, std::span(samplers_).first(size),
                  std::span(radiances_).first(size), counts_);
        for (std::size_t i = 0; i < size; ++i) {
            const auto [x, y, index] = samples_[i];
            if (!target_.keeper.film().add(x, y, samplers_[i].replicate(), radiances_[i]))
                first_invalid_ = first_of(first_invalid_, InvalidSample{index, y, x});
        }
        counts_.camera += static_cast<std::int64_t>(size);
        samples_.clear();
    }

    const RayCounts& counts() const { return counts_; }
    const std::optional<InvalidSample>& first_invalid() const { return first_invalid_; }

private:
    // The batch is so large that few paths are alone at a rare class of surface, and so small that it stays in the
    // cache.
    static constexpr std::size_t kMost = 2048;
    struct Sample {
        int x, y;
        std::uint32_t index;
    };

    // Makes the camera rays of the batch, equal to those of camera_ray.
    void start_rays(std::span<Ray> rays) {
        constexpr std::size_t kSome = 256;
        std::array<CameraNumbers, kSome> numbers;
        for (std::size_t done = 0; done < rays.size(); done += kSome) {
            const std::size_t size = std::min(rays.size() - done, kSome);
            Sampler::camera_numbers(std::span(samplers_).subspan(done, size), camera_needs(target_.plan),
                                    std::span(numbers).first(size));
            for (std::size_t i = 0; i < size; ++i) {
                const Sample& sample = samples_[done + i];
                set_point(points_[done + i], target_.plan, sample.x, sample.y, numbers[i]);
            }
        }
        camera_.rays(std::span(points_).first(rays.size()), rays);
    }

    const PassTarget& target_;
    const CameraModel& camera_;
    RayCounts counts_;
    std::optional<InvalidSample> first_invalid_;
    const std::size_t size_; // samples in a batch
    std::vector<Sample> samples_; // samples_.size() elements of the arrays below are in use
    std::vector<Sampler> samplers_;
    std::vector<CameraModel::Point> points_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<Rgb> radiances_;
};

// Returns the even bits of a 16-bit number, packed together: x of a Morton code, or y after a shift.
int even_bits(unsigned code) {
    int bits = 0;
    for (int i = 0; i < 8; ++i) bits |= static_cast<int>(code >> (2 * i) & 1u) << i;
    return bits;
}

struct TileTally {
    RayCounts counts;
    std::optional<InvalidSample> first_invalid;
};

TileTally render_tile(const PassTarget& target, const CameraModel& camera, const Tile& tile) {
    const Film& film = target.keeper.film();
    // Pixels are visited in Z-order, so that pixels close in order are close in the image.
    const auto for_pixels = [&](const auto& visit) {
        for (unsigned code = 0; code < kTile * kTile; ++code) {
            const int x = tile.x0 + even_bits(code), y = tile.y0 + even_bits(code >> 1);
            if (x < tile.x1 && y < tile.y1) visit(x, y, film.taken(x, y), film.pixels()(x, y).target);
        }
    };
    std::size_t all = 0;
    for_pixels([&](int, int, std::uint32_t begin, std::uint32_t end) { all += end > begin ? end - begin : 0; });
    CameraBatch batch(target, camera, all);
    const std::uint32_t first = target.settings.first_sample;
    for_pixels(
        [&](int x, int y, std::uint32_t begin, std::uint32_t end) { batch.add(x, y, first + begin, first + end); });
    batch.finish();
    return {batch.counts(), batch.first_invalid()};
}

} // namespace

bool render_pass(const PassTarget& target, double begin, double end) {
    const Tiles tiles(target.view);
    const CameraModel camera(target.view);
    std::atomic<bool> complete = true;
    std::mutex mutex; // guards the counts and the progress
    std::size_t finished = 0;
    parallel_for(tiles.count(), target.settings.threads, [&](std::size_t i) {
        if (target.control.stopped()) {
            complete = false;
            return;
        }
        TileTally tally;
        target.keeper.add([&] { tally = render_tile(target, camera, tiles[i]); });
        const std::lock_guard lock(mutex);
        target.counts += tally.counts;
        target.first_invalid = first_of(target.first_invalid, tally.first_invalid);
        target.control.report(lerp(begin, end, static_cast<double>(++finished) / static_cast<double>(tiles.count())));
    });
    return complete;
}

} // namespace duet::raytrace
