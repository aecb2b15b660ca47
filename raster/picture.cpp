#include "raster/picture.h"

#include "common/system/parallel.h"

namespace duet::raster {
namespace {

bool is_valid(Rgb c) { return is_finite(c) && c.r >= 0 && c.g >= 0 && c.b >= 0; }

bool needs_hit_counts(const AovSet& aovs) { return aovs.depth || aovs.normal || aovs.albedo; }

} // namespace

Picture::Picture(const View& view, const Settings& settings, bool many) : settings_(settings) {
    const int w = view.width, h = view.height;
    const AovSet& aovs = settings.aovs;
    rendering_.radiance = ImageRgb(w, h);
    if (many) sums_ = Image<Rgbd>(w, h);
    added_ = Image<std::uint32_t>(w, h, 0);
    valid_ = Image<std::uint32_t>(w, h, 0);
    if (needs_hit_counts(aovs)) {
        hits_ = Image<std::uint32_t>(w, h, 0);
        auxiliary_ = Image<Auxiliary>(w, h);
    }
    if (aovs.depth) rendering_.depth = ImageFloat(w, h, kInfinity);
    if (aovs.normal) rendering_.normal = Image<Vec3>(w, h);
    if (aovs.albedo) rendering_.albedo = ImageRgb(w, h);
    if (aovs.hit) rendering_.hit = Image<Hit>(w, h);
}

void Picture::add(int x, int y, Rgb radiance, int count) {
    const auto samples = static_cast<std::uint32_t>(count);
    added_(x, y) += samples;
    if (!is_valid(radiance)) {
        invalid_.fetch_add(count, std::memory_order_relaxed);
        return;
    }
    valid_(x, y) += samples;
    if (sums_.empty())
        rendering_.radiance(x, y) = radiance;
    else
        sums_(x, y) += Rgbd(radiance) * static_cast<double>(count);
}

void Picture::add_auxiliary(const HitTile& tile, int x, int y, const Shaded& shaded) {
    const AovSet& aovs = settings_.aovs;
    const Hit& hit = tile.hit(x, y);
    if (aovs.hit && added_(x, y) == 0) rendering_.hit(x, y) = hit;
    if (!hit.valid()) return;
    if (hits_.empty()) return;
    ++hits_(x, y);
    Auxiliary& sums = auxiliary_(x, y);
    sums.depth += static_cast<double>(tile.depth(x, y));
    sums.normal += Vec3d(shaded.normal);
    sums.albedo += Rgbd(shaded.albedo);
}

void Picture::finish_pixel(int x, int y) {
    const AovSet& aovs = settings_.aovs;
    if (!sums_.empty() && valid_(x, y) > 0)
        rendering_.radiance(x, y) = Rgb(sums_(x, y) * (1.0 / static_cast<double>(valid_(x, y))));
    if (hits_.empty() || hits_(x, y) == 0) return;
    const double hits = hits_(x, y);
    const Auxiliary& sums = auxiliary_(x, y);
    if (aovs.depth) rendering_.depth(x, y) = static_cast<float>(sums.depth / hits);
    if (aovs.normal) rendering_.normal(x, y) = Vec3(sums.normal / hits);
    if (aovs.albedo) rendering_.albedo(x, y) = Rgb(sums.albedo / hits);
}

Rendering Picture::finish(int threads) {
    if (!sums_.empty() || !hits_.empty())
        parallel_for(static_cast<std::size_t>(rendering_.radiance.height()), threads, [&](std::size_t row) {
            for (int x = 0; x < rendering_.radiance.width(); ++x) finish_pixel(x, static_cast<int>(row));
        });
    rendering_.statistics.invalid_samples = invalid_;
    if (settings_.aovs.samples) rendering_.samples = std::move(added_);
    return std::move(rendering_);
}

std::size_t Picture::memory_bytes() const {
    const auto bytes = [](const auto& image) { return image.size() * sizeof(image[0]); };
    return bytes(rendering_.radiance) + bytes(rendering_.depth) + bytes(rendering_.normal) + bytes(rendering_.albedo) +
           bytes(rendering_.hit) + bytes(sums_) + bytes(added_) + bytes(valid_) + bytes(hits_) + bytes(auxiliary_);
}

} // namespace duet::raster
