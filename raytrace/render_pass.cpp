#include "raytrace/render_pass.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <span>
#include <vector>

namespace duet::raytrace {

Ray camera_ray(const RenderPlan& plan, const CameraModel& camera, int x, int y, const Sampler& sampler) {
    CameraModel::Sample point;
    set_camera_point(point, plan, x, y, sampler.camera_ray_samples(plan.camera_needs));
    return camera.ray(point.pixel, Vec2d(point.lens), static_cast<double>(point.time));
}

namespace {

constexpr int kTile = 16;

struct Tile {
    int x0, y0, x1, y1;
};

class TileGrid {
public:
    explicit TileGrid(const View& view) : view_(view), columns_((view.width + kTile - 1) / kTile) {}

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

// Traces camera rays in batches, because the rays of neighboring pixels, and of one pixel's samples, are coherent.
class CameraBatch {
public:
    /// `max_samples` is the number of samples that will be added.
    CameraBatch(const PassContext& context, const CameraModel& camera, std::size_t max_samples)
        : context_(context), camera_(camera), size_(std::min(max_samples, kMaxSamples)),
          samplers_(size_, context.settings.make_sampler()), points_(size_), rays_(size_), hits_(size_),
          radiances_(size_) {
        samples_.reserve(size_);
    }

    // Adds samples [begin, end) of a pixel.
    void add(int x, int y, std::uint32_t begin, std::uint32_t end) {
        while (begin < end) {
            const std::size_t old = samples_.size();
            const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(end - begin, size_ - old));
            Sampler::start(std::span(samplers_).subspan(old, count), x, y, begin);
            for (const std::uint32_t last = begin + count; begin < last; ++begin) samples_.push_back({x, y, begin});
            if (samples_.size() == size_) finish();
        }
    }

    // Renders the samples that have been added but not yet rendered.
    void finish() {
        const std::size_t size = samples_.size();
        if (size == 0) return;
        const auto rays = std::span(rays_).first(size);
        const auto hits = std::span(hits_).first(size);
        start_rays(rays);
        context_.plan.prepared.accelerator.closest(rays, hits);
        if (context_.aovs.any())
            for (std::size_t i = 0; i < size; ++i)
                context_.aovs.add(samples_[i].x, samples_[i].y, samples_[i].index, rays[i], hits[i]);
        radiances(context_.settings.integrator, context_.plan, rays, hits, std::span(samplers_).first(size),
                  std::span(radiances_).first(size), counts_);
        for (std::size_t i = 0; i < size; ++i) {
            const auto [x, y, index] = samples_[i];
            if (!context_.checkpoint.film().add(x, y, samplers_[i].replicate(), radiances_[i]))
                first_invalid_ = earlier_sample(first_invalid_, InvalidSample{index, y, x});
        }
        counts_.camera += static_cast<std::int64_t>(size);
        samples_.clear();
    }

    const RayCounts& counts() const { return counts_; }
    const std::optional<InvalidSample>& first_invalid() const { return first_invalid_; }

private:
    // The batch is so large that few paths are alone at a rare class of surface, and so small that it fits into the
    // cache.
    static constexpr std::size_t kMaxSamples = 2048;
    struct Sample {
        int x, y;
        std::uint32_t index;
    };

    // Computes the camera rays of the batch, bit-equal to those of camera_ray.
    void start_rays(std::span<Ray> rays) {
        constexpr std::size_t kChunk = 256;
        std::array<CameraRaySample, kChunk> random_samples;
        for (std::size_t done = 0; done < rays.size(); done += kChunk) {
            const std::size_t size = std::min(rays.size() - done, kChunk);
            Sampler::camera_ray_samples(std::span(samplers_).subspan(done, size), context_.plan.camera_needs,
                                        std::span(random_samples).first(size));
            for (std::size_t i = 0; i < size; ++i) {
                const Sample& sample = samples_[done + i];
                set_camera_point(points_[done + i], context_.plan, sample.x, sample.y, random_samples[i]);
            }
        }
        camera_.rays(std::span(points_).first(rays.size()), rays);
    }

    const PassContext& context_;
    const CameraModel& camera_;
    RayCounts counts_;
    std::optional<InvalidSample> first_invalid_;
    const std::size_t size_; // number of samples in a batch
    std::vector<Sample> samples_; // as many elements of the following arrays are in use
    std::vector<Sampler> samplers_;
    std::vector<CameraModel::Sample> points_;
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

struct TileResult {
    RayCounts counts;
    std::optional<InvalidSample> first_invalid;
};

TileResult render_tile(const PassContext& context, const CameraModel& camera, const Tile& tile) {
    const Film& film = context.checkpoint.film();
    // Pixels are visited in Z-order, so that pixels close in order are close in the image.
    const auto for_pixels = [&](const auto& visit) {
        for (unsigned code = 0; code < kTile * kTile; ++code) {
            const int x = tile.x0 + even_bits(code), y = tile.y0 + even_bits(code >> 1);
            if (x < tile.x1 && y < tile.y1) visit(x, y, film.samples_taken(x, y), film.pixels()(x, y).target);
        }
    };
    std::size_t total = 0;
    for_pixels([&](int, int, std::uint32_t begin, std::uint32_t end) { total += end > begin ? end - begin : 0; });
    CameraBatch batch(context, camera, total);
    const std::uint32_t first = context.settings.first_sample;
    for_pixels(
        [&](int x, int y, std::uint32_t begin, std::uint32_t end) { batch.add(x, y, first + begin, first + end); });
    batch.finish();
    return {batch.counts(), batch.first_invalid()};
}

} // namespace

bool render_pass(const PassContext& context, double begin, double end) {
    const TileGrid tiles(context.view);
    const CameraModel camera(context.view);
    std::atomic<bool> complete = true;
    std::mutex mutex; // guards the counts and the progress
    std::size_t finished = 0;
    parallel_for(tiles.count(), context.settings.threads, [&](std::size_t i) {
        if (context.control.stopped()) {
            complete = false;
            return;
        }
        TileResult result;
        context.checkpoint.run([&] { result = render_tile(context, camera, tiles[i]); });
        const std::lock_guard lock(mutex);
        context.counts += result.counts;
        context.first_invalid = earlier_sample(context.first_invalid, result.first_invalid);
        context.control.report(lerp(begin, end, static_cast<double>(++finished) / static_cast<double>(tiles.count())));
    });
    return complete;
}

} // namespace duet::raytrace
