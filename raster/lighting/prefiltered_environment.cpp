#include "raster/lighting/prefiltered_environment.h"

#include "common/geometry/sphere.h"
#include "common/material/ggx.h"
#include "common/sampling/hash.h"
#include "common/sampling/sobol.h"
#include "common/system/parallel.h"
#include "common/vec/frame.h"
#include "raster/gbuffer/bilinear.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// A sample of the lobe about +z has a direction, a weight, and the solid angle that it represents.
struct LobeSample {
    Vec3 w;
    float weight, solid_angle;
};
std::vector<LobeSample> lobe_samples(float alpha) {
    std::vector<LobeSample> samples;
    float sum = 0;
    const Vec3 n(0, 0, 1);
    for (int i = 0; i < Prefiltered::kSamples; ++i) {
        const Vec2 u((static_cast<float>(i) + 0.5f) / Prefiltered::kSamples,
                     unit_float(reverse_bits(static_cast<std::uint32_t>(i))));
        const Vec3 h = ggx_sample_visible_normal(n, alpha, {u.y, u.x}), w = normalize(reflect(n, h));
        if (!(w.z > 0)) continue;
        samples.push_back({w, w.z, 1 / (Prefiltered::kSamples * ggx_reflection_pdf(n, h, alpha))});
        sum += w.z;
    }
    for (LobeSample& s : samples) s.weight /= sum;
    return samples;
}

/// Returns the mean cosine of a lobe, by which it scales the part of the radiance that is linear in the direction.
float mean_cosine(const std::vector<LobeSample>& samples) {
    float sum = 0;
    for (const LobeSample& s : samples) sum += s.weight * s.w.z;
    return sum;
}

float wrapped(float u) { return u - std::floor(u); }

Rgb at_direction(const ImageRgb& map, Vec2 uv) {
    return bilinear(map, wrapped(uv.x) * static_cast<float>(map.width()),
                    (1 - uv.y) * static_cast<float>(map.height()), true);
}

/// Returns the direction at the center of a map's pixel: the inverse of latlong_uv.
Vec3 direction(int x, int y, const ImageRgb& map) {
    const double theta = kPiDouble * (y + 0.5) / map.height(), phi = 2 * kPiDouble * ((x + 0.5) / map.width() - 0.5);
    return Vec3(Vec3d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)));
}

/// Builds a mip chain of the environment: each level halves the width and height and averages radiance by solid
/// angle.
std::vector<ImageRgb> reduced(const Environment& environment, int width, int threads) {
    std::vector<ImageRgb> levels{ImageRgb(width, width / 2)};
    parallel_for(static_cast<std::size_t>(width / 2), threads, [&](std::size_t row) {
        for (int x = 0; x < width; ++x)
            levels[0](x, static_cast<int>(row)) = radiance(environment, direction(x, static_cast<int>(row), levels[0]));
    });
    while (levels.back().height() > 4) {
        const ImageRgb& fine = levels.back();
        ImageRgb coarse(fine.width() / 2, fine.height() / 2);
        for (int y = 0; y < coarse.height(); ++y) {
            // Rows nearer to a pole subtend less solid angle.
            const auto a = static_cast<float>(std::sin(kPiDouble * (2 * y + 0.5) / fine.height())),
                       b = static_cast<float>(std::sin(kPiDouble * (2 * y + 1.5) / fine.height()));
            for (int x = 0; x < coarse.width(); ++x)
                coarse(x, y) = ((fine(2 * x, 2 * y) + fine(2 * x + 1, 2 * y)) * a +
                                (fine(2 * x, 2 * y + 1) + fine(2 * x + 1, 2 * y + 1)) * b) / (2 * (a + b));
        }
        levels.push_back(std::move(coarse));
    }
    return levels;
}

/// Each sample reads the mip level whose pixels match the solid angle that it represents (Křivánek and Colbert 2008,
/// "Real-time Shading with Filtered Importance Sampling").
Rgb filtered(const std::vector<ImageRgb>& levels, const std::vector<LobeSample>& samples, Vec3 axis) {
    const Frame frame = frame_from_normal(axis);
    const ImageRgb& finest = levels.front();
    Rgb sum;
    for (const LobeSample& s : samples) {
        const Vec3 w = frame.to_world(s.w);
        const float sine = std::max(std::sqrt(w.x * w.x + w.z * w.z), 1.0f / static_cast<float>(finest.height()));
        const float pixel = 2 * kPi * kPi * sine / static_cast<float>(finest.size());
        const float level = clamp(0.5f * std::log2(s.solid_angle / pixel) + 0.5f, 0.0f,
                                  static_cast<float>(levels.size() - 1));
        const auto low = std::min(static_cast<std::size_t>(level), levels.size() - 2);
        const Vec2 uv = latlong_uv(normalize(w));
        sum += lerp(at_direction(levels[low], uv), at_direction(levels[low + 1], uv),
                    level - static_cast<float>(low)) * s.weight;
    }
    return sum;
}

float roughness_of(int map) { return static_cast<float>(map + 1) / Prefiltered::kMaps; }

} // namespace

Prefiltered::Prefiltered(const Environment& environment, int threads) {
    if (std::holds_alternative<SkyEnvironment>(environment))
        for (std::size_t i = 0; i < mean_cosine_.size(); ++i) {
            const float roughness = static_cast<float>(i) / static_cast<float>(mean_cosine_.size() - 1);
            mean_cosine_[i] = i == 0 ? 1 : mean_cosine(lobe_samples(sqr(roughness)));
        }
    const auto* picture = std::get_if<ImageEnvironment>(&environment);
    if (picture == nullptr || picture->image.empty()) return;
    int width = 8;
    while (width < std::min(picture->image.width(), 1024)) width *= 2;
    const std::vector<ImageRgb> levels = reduced(environment, width, threads);
    for (int k = 0; k < kMaps; ++k) {
        const int size = k == 0 ? 128 : 64;
        ImageRgb map(size, size / 2);
        const std::vector<LobeSample> samples = lobe_samples(sqr(roughness_of(k)));
        parallel_for(static_cast<std::size_t>(map.height()), threads, [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < map.width(); ++x) map(x, y) = filtered(levels, samples, direction(x, y, map));
        });
        maps_.push_back(std::move(map));
    }
}

Rgb Prefiltered::at(const Environment& environment, Vec3 w, float alpha) const {
    if (maps_.empty()) {
        const auto* sky = std::get_if<SkyEnvironment>(&environment);
        if (sky == nullptr) return radiance(environment, w);
        const float at = clamp(std::sqrt(alpha), 0.0f, 1.0f) * static_cast<float>(mean_cosine_.size() - 1);
        const auto i = std::min(static_cast<std::size_t>(at), mean_cosine_.size() - 2);
        const float cosine = lerp(mean_cosine_[i], mean_cosine_[i + 1], at - static_cast<float>(i));
        return lerp(sky->down, sky->up, 0.5f * (1 + w.y * cosine));
    }
    const float map_position = clamp(std::sqrt(alpha), 0.0f, 1.0f) * kMaps - 1; // −1: the unfiltered image
    if (map_position < 0)
        return lerp(radiance(environment, w), at_direction(maps_.front(), latlong_uv(w)), map_position + 1);
    const auto low = std::min(static_cast<std::size_t>(map_position), maps_.size() - 2);
    return lerp(at_direction(maps_[low], latlong_uv(w)), at_direction(maps_[low + 1], latlong_uv(w)),
                map_position - static_cast<float>(low));
}

Vec3 Prefiltered::axis(Vec3 normal, Vec3 mirror_direction, float alpha) {
    const float smoothness = clamp(1 - alpha, 0.0f, 1.0f);
    return normalize(lerp(normal, mirror_direction, smoothness * (std::sqrt(smoothness) + alpha)));
}

std::int64_t Prefiltered::memory_bytes() const {
    std::size_t pixels = 0;
    for (const ImageRgb& map : maps_) pixels += map.size();
    return static_cast<std::int64_t>(pixels * sizeof(Rgb));
}

} // namespace duet::raster
