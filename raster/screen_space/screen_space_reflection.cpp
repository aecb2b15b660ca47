#include "raster/screen_space/screen_space_reflection.h"

#include "common/sampling/sobol.h"

#include <cmath>

namespace duet::raster {

namespace {

bool is_smooth_enough(const ScalarSlot& roughness) {
    return !roughness.constant() || sqr(roughness.value) <= kMaxReflectionAlpha;
}

/// Returns ray i of ScreenSpaceReflection::kRays from a rough metal. The rays form a (0,2)-net, as does each aligned
/// subset.
Vec2 lobe_sample_point(int i) { return sobol_net_point(static_cast<std::uint32_t>(i), ScreenSpaceReflection::kRays); }

} // namespace

bool may_reflect_image(const Material& material) {
    if (const auto* metal = std::get_if<Metal>(&material)) return is_smooth_enough(metal->roughness);
    if (const auto* coated = std::get_if<Coated>(&material)) return is_smooth_enough(coated->roughness);
    const auto* layers = std::get_if<Principled>(&material);
    if (layers == nullptr) return false;
    const bool coat = !layers->clearcoat.constant() || layers->clearcoat.value > 0;
    return is_smooth_enough(layers->roughness) || (coat && is_smooth_enough(layers->clearcoat_roughness));
}

bool reflects_image_only(const Material& material) {
    if (const auto* metal = std::get_if<Metal>(&material)) return is_smooth_enough(metal->roughness);
    const auto* layers = std::get_if<Principled>(&material);
    return layers != nullptr && layers->metallic.constant() && layers->metallic.value == 1 &&
           is_smooth_enough(layers->roughness);
}

ScreenSpaceReflection::ScreenSpaceReflection(const RasterSceneData& data, const RasterSettings& settings,
                                             const ScreenGBuffer& gbuffer, const ShadingPoint& point,
                                             const MetalBsdf& bsdf)
    : tracer_(data, settings, {gbuffer, nullptr, point.surface.object}), point_(point), bsdf_(bsdf),
      p_(gbuffer.to_eye_relative(point.surface.p)) {
    const Vec3 projected = gbuffer.project(p_);
    if (projected.z > 0) {
        const auto [x, y] = gbuffer.pixel_at(projected);
        divergence_ = 2 * gbuffer.normal_angle(x, y);
    }
    width_ = gbuffer.pixel_size(max(projected.z, gbuffer.near()));
}

std::optional<Rgb> ScreenSpaceReflection::operator()(TapRange taps) const {
    if (bsdf_.smooth()) {
        const Sample ray = sample({0.5f, 0.5f});
        return ray.weight == Rgb() ? std::nullopt : std::optional(ray_radiance(ray, 1) * ray.weight);
    }
    const int share = TapRange().count / taps.count, count = kRays / share, first = taps.first * count / taps.count;
    Rgb sum, all;
    for (int i = 0; i < kRays; ++i) {
        const Sample ray = sample(lobe_sample_point(i));
        all += ray.weight;
        if (i >= first && i < first + count && !(ray.weight == Rgb())) sum += ray_radiance(ray, kRays) * ray.weight;
    }
    if (all == Rgb()) return std::nullopt;
    const Rgb albedo = bsdf_.directional_albedo(std::abs(point_.wo.z));
    for (std::size_t c = 0; c < 3; ++c)
        sum[c] = all[c] > 0 ? sum[c] * static_cast<float>(share) / all[c] * albedo[c] : 0.0f;
    return sum;
}

ScreenSpaceReflection::Sample ScreenSpaceReflection::sample(Vec2 u) const {
    const auto sample = bsdf_.sample(point_.wo, 0, u, TransportMode::kRadiance);
    if (!sample) return {};
    const Vec3 direction = normalize(point_.frame.to_world(sample->wi));
    return point_.receives(direction) ? Sample{direction, sample->pdf, sample->weight} : Sample{};
}

/// Returns the radiance along one of `rays` rays.
Rgb ScreenSpaceReflection::ray_radiance(const Sample& ray, int rays) const {
    const bool smooth = bsdf_.smooth();
    // The cone about the ray has the solid angle 1/(rays · pdf), so that it contains one ray on average.
    const float wide = smooth ? 0.0f : 2 * std::sqrt(kInvPi / (static_cast<float>(rays) * max(ray.pdf, 1e-6f)));
    return tracer_.incoming_radiance({.p = p_,
                                      .n = point_.ng,
                                      .direction = ray.direction,
                                      .width = width_,
                                      .divergence = divergence_,
                                      .spread = wide,
                                      .alpha = min(blur_to_alpha(wide), 1.0f),
                                      .include_lights = smooth,
                                      .point = &point_});
}

} // namespace duet::raster
