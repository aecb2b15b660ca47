#include "raster/output/framebuffer.h"

#include "common/system/parallel.h"

namespace duet::raster {
namespace {

bool needs_hit_counts(const AovSet& aovs) { return aovs.depth || aovs.normal || aovs.albedo; }

} // namespace

Framebuffer::Framebuffer(const View& view, const RasterSettings& settings, bool multiple_samples)
    : settings_(settings) {
    const int w = view.width, h = view.height;
    const AovSet& aovs = settings.aovs;
    rendering_.radiance = ImageRgb(w, h);
    if (multiple_samples) sums_ = Image<Rgbd>(w, h);
    sample_counts_ = Image<std::uint32_t>(w, h, 0);
    valid_counts_ = Image<std::uint32_t>(w, h, 0);
    if (needs_hit_counts(aovs)) {
        hit_counts_ = Image<std::uint32_t>(w, h, 0);
        aov_sums_ = Image<AovSums>(w, h);
    }
    if (aovs.depth) rendering_.depth = ImageFloat(w, h, kInfinity);
    if (aovs.normal) rendering_.normal = Image<Vec3>(w, h);
    if (aovs.albedo) rendering_.albedo = ImageRgb(w, h);
    if (aovs.hit) rendering_.hit = Image<Hit>(w, h);
}

void Framebuffer::add(int x, int y, Rgb radiance, int count) {
    const auto samples = static_cast<std::uint32_t>(count);
    sample_counts_(x, y) += samples;
    if (!is_valid_radiance(radiance)) {
        invalid_.fetch_add(count, std::memory_order_relaxed);
        return;
    }
    valid_counts_(x, y) += samples;
    if (sums_.empty())
        rendering_.radiance(x, y) = radiance;
    else
        sums_(x, y) += Rgbd(radiance) * static_cast<double>(count);
}

void Framebuffer::add_aovs(const HitTile& tile, int x, int y, const ShadedSample& shaded) {
    const AovSet& aovs = settings_.aovs;
    const Hit& hit = tile.hit(x, y);
    if (aovs.hit && sample_counts_(x, y) == 0) rendering_.hit(x, y) = hit;
    if (!hit.valid()) return;
    if (hit_counts_.empty()) return;
    ++hit_counts_(x, y);
    AovSums& sums = aov_sums_(x, y);
    sums.depth += static_cast<double>(tile.depth(x, y));
    sums.normal += Vec3d(shaded.normal);
    sums.albedo += Rgbd(shaded.albedo);
}

void Framebuffer::finish_pixel(int x, int y) {
    const AovSet& aovs = settings_.aovs;
    if (!sums_.empty() && valid_counts_(x, y) > 0)
        rendering_.radiance(x, y) = Rgb(sums_(x, y) * (1.0 / static_cast<double>(valid_counts_(x, y))));
    if (hit_counts_.empty() || hit_counts_(x, y) == 0) return;
    const double hits = hit_counts_(x, y);
    const AovSums& sums = aov_sums_(x, y);
    if (aovs.depth) rendering_.depth(x, y) = static_cast<float>(sums.depth / hits);
    if (aovs.normal) rendering_.normal(x, y) = Vec3(sums.normal / hits);
    if (aovs.albedo) rendering_.albedo(x, y) = Rgb(sums.albedo / hits);
}

Rendering Framebuffer::finish(int threads) {
    if (!sums_.empty() || !hit_counts_.empty())
        parallel_for(static_cast<std::size_t>(rendering_.radiance.height()), threads, [&](std::size_t row) {
            for (int x = 0; x < rendering_.radiance.width(); ++x) finish_pixel(x, static_cast<int>(row));
        });
    rendering_.statistics.invalid_samples = invalid_;
    if (settings_.aovs.samples) rendering_.samples = std::move(sample_counts_);
    return std::move(rendering_);
}

std::size_t Framebuffer::memory_bytes() const {
    const auto bytes = [](const auto& image) { return image.size() * sizeof(image[0]); };
    return bytes(rendering_.radiance) + bytes(rendering_.depth) + bytes(rendering_.normal) + bytes(rendering_.albedo) +
           bytes(rendering_.hit) + bytes(sums_) + bytes(sample_counts_) + bytes(valid_counts_) + bytes(hit_counts_) +
           bytes(aov_sums_);
}

} // namespace duet::raster
