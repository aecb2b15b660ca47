#include "raster/screen/mirrored.h"

#include "common/sampling/sobol.h"

#include <cmath>

namespace duet::raster {

namespace {

bool mirrors(const ScalarSlot& roughness) { return !roughness.constant() || sqr(roughness.value) <= kRoughestMirror; }

/// Returns ray i of Mirrored::kRays from a rough metal. The rays form a (0,2)-net, as does each aligned subset.
Vec2 mirror_ray(int i) { return net_point(static_cast<std::uint32_t>(i), Mirrored::kRays); }

} // namespace

bool may_mirror(const Material& material) {
    if (const auto* metal = std::get_if<Metal>(&material)) return mirrors(metal->roughness);
    if (const auto* coated = std::get_if<Coated>(&material)) return mirrors(coated->roughness);
    const auto* layers = std::get_if<Principled>(&material);
    if (layers == nullptr) return false;
    const bool coat = !layers->clearcoat.constant() || layers->clearcoat.value > 0;
    return mirrors(layers->roughness) || (coat && mirrors(layers->clearcoat_roughness));
}

bool is_mirror(const Material& material) {
    if (const auto* metal = std::get_if<Metal>(&material)) return mirrors(metal->roughness);
    const auto* layers = std::get_if<Principled>(&material);
    return layers != nullptr && layers->metallic.constant() && layers->metallic.value == 1 &&
        mirrors(layers->roughness);
}

Mirrored::Mirrored(const PreparedData& data, const Settings& settings, const Screen& screen, const ShadingPoint& point,
                   const MetalBsdf& bsdf)
    : around_(data, settings, {screen, nullptr, point.surface.object}), point_(point), bsdf_(bsdf),
      p_(screen.relative(point.surface.p)) {
    const Vec3 place = screen.project(p_);
    if (place.z > 0) {
        const auto [x, y] = screen.pixel_at(place);
        spread_ = 2 * screen.turn(x, y);
    }
    width_ = screen.pixel_size(max(place.z, screen.near()));
}

std::optional<Rgb> Mirrored::operator()(TapRange taps) const {
    if (bsdf_.smooth()) {
        const Sample ray = sample({0.5f, 0.5f});
        return ray.weight == Rgb() ? std::nullopt : std::optional(seen(ray, 1) * ray.weight);
    }
    const int share = TapRange().count / taps.count, count = kRays / share, first = taps.first * count / taps.count;
    Rgb sum, all;
    for (int i = 0; i < kRays; ++i) {
        const Sample ray = sample(mirror_ray(i));
        all += ray.weight;
        if (i >= first && i < first + count && !(ray.weight == Rgb())) sum += seen(ray, kRays) * ray.weight;
    }
    if (all == Rgb()) return std::nullopt;
    const Rgb albedo = bsdf_.albedo(std::abs(point_.wo.z));
    for (std::size_t c = 0; c < 3; ++c)
        sum[c] = all[c] > 0 ? sum[c] * static_cast<float>(share) / all[c] * albedo[c] : 0.0f;
    return sum;
}

Mirrored::Sample Mirrored::sample(Vec2 u) const {
    const auto sample = bsdf_.sample(point_.wo, 0, u, TransportMode::kRadiance);
    if (!sample) return {};
    const Vec3 way = normalize(point_.frame.to_world(sample->wi));
    return point_.receives(way) ? Sample{way, sample->pdf, sample->weight} : Sample{};
}

/// Returns the radiance along one of `rays` rays.
Rgb Mirrored::seen(const Sample& ray, int rays) const {
    const bool smooth = bsdf_.smooth();
    // The cone about the ray has the solid angle 1/(rays · pdf), so that it contains one ray on average.
    const float wide = smooth ? 0.0f : 2 * std::sqrt(kInvPi / (static_cast<float>(rays) * max(ray.pdf, 1e-6f)));
    return around_.seen({.p = p_, .n = point_.ng, .way = ray.way, .width = width_, .turn = spread_, .spread = wide,
                         .alpha = min(alpha_as_wide(wide), 1.0f), .lamps = smooth, .point = &point_});
}

} // namespace duet::raster
