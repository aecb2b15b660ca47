#include "raytrace/integrator/scattered_light.h"

#include "common/medium/density_grid.h"
#include "raytrace/integrator/medium_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet::raytrace {

namespace {

// Returns the part of a ray from the first to the last point at which a medium scatters light, if there is any.
Interval scattering_range(MediaOnRay& media) {
    Interval range{media.t_end(), 0};
    for (const MediumOnRay& medium : media) {
        const Interval inside = medium.inside();
        if (inside.empty() || is_black(medium.medium().scattering)) continue;
        range.begin = std::min(range.begin, inside.begin);
        range.end = std::max(range.end, inside.end);
    }
    return range;
}

// Returns the sum of σs times the phase function over the media at t, 1/(m sr), for light from wi.
Rgb scattering_at(std::span<const Medium> media, const Ray& ray, float t, Vec3 wi) {
    Rgb sum;
    for (const Medium& medium : media) {
        const Interval inside = overlap(medium.box, ray, kInfinity);
        if (!(inside.begin <= t && t < inside.end)) continue;
        sum += medium.scattering * (density_at(medium, ray.at(t)) * phase(ray.direction, wi, medium.asymmetry));
    }
    return sum;
}

// Returns the part of the range in which a ray is inside the cone of a spot light, or a longer one. A point of the ray
// is inside if its height over the apex, along the axis, is at least cos θ times its distance from the apex. The
// squares of both are equal at the roots of a quadratic equation.
Interval lit_range(const SpotLight& light, const Ray& ray, Interval range) {
    if (light.cos_outer <= 0) return range; // the cone is not convex
    const Vec3d axis(light.direction), d(ray.direction), from_apex = Vec3d(ray.origin) - Vec3d(light.position);
    const double cosine2 = sqr(static_cast<double>(light.cos_outer));
    const double height = dot(axis, from_apex), slope = dot(axis, d);
    const double a = sqr(slope) - cosine2, b = height * slope - cosine2 * dot(from_apex, d);
    const double c = sqr(height) - cosine2 * length_squared(from_apex);
    const double discriminant = sqr(b) - a * c;
    if (std::abs(a) < 1e-9) return range;
    if (discriminant <= 0) return a < 0 ? Interval{} : range;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b)); // without cancellation
    const double roots[] = {q / a, q == 0 ? 0 : c / q};
    const float first = static_cast<float>(std::min(roots[0], roots[1])),
                second = static_cast<float>(std::max(roots[0], roots[1]));
    if (a > 0) // the ray is steeper than the cone, and stays inside
        return slope > 0 ? Interval{std::max(range.begin, second), range.end}
                         : Interval{range.begin, std::min(range.end, first)};
    if (height + slope * (roots[0] + roots[1]) / 2 < 0) return {}; // the ray hits only the cone's mirror image
    return {std::max(range.begin, first), std::min(range.end, second)};
}

// Describes how to sample the distances at which the light of a delta light is scattered.
struct LightOnRay {
    Interval range;
    std::optional<EquiangularDistance> angle; // only for point and spot lights
    float weight = 0; // rough estimate of the light that reaches the range, without media and occluders
};
// Returns a weight of 0 if the light does not reach the range.
LightOnRay light_on_ray(const Light& light, const Ray& ray, Interval range, const StoppedDistance& stopped) {
    if (const auto* sun = std::get_if<SunLight>(&light))
        return {range, std::nullopt, average(sun->irradiance) * stopped.lit_length()};
    const auto* point = std::get_if<PointLight>(&light);
    const auto* spot = std::get_if<SpotLight>(&light);
    if (spot != nullptr) range = lit_range(*spot, ray, range);
    if (range.empty()) return {range, std::nullopt, 0};
    const EquiangularDistance angle(ray, range, point != nullptr ? point->position : spot->position);
    return {range, angle, average(point != nullptr ? point->intensity : spot->intensity) * angle.integral()};
}

// At most kCandidates delta lights are candidates, of which one is chosen by its weight. If there are more lights,
// every k-th is a candidate, starting from a random one.
constexpr std::size_t kCandidates = 8;

struct ChosenLight {
    std::size_t index;
    float probability;
    LightOnRay on_ray;
};
std::optional<ChosenLight> choose_light(const RenderPlan& plan, const Ray& ray, Interval range,
                                        const StoppedDistance& stopped, float u) {
    const std::size_t stride = (plan.delta_lights + kCandidates - 1) / kCandidates;
    const float scaled = u * static_cast<float>(stride);
    const std::size_t first = std::min(static_cast<std::size_t>(scaled), stride - 1);
    std::array<LightOnRay, kCandidates> candidates;
    float sum = 0;
    for (std::size_t i = first, k = 0; i < plan.delta_lights; i += stride, ++k) {
        candidates[k] = light_on_ray(plan.scene.lights[i], ray, range, stopped);
        sum += candidates[k].weight;
    }
    float left = (scaled - static_cast<float>(first)) * sum;
    std::optional<ChosenLight> chosen;
    for (std::size_t i = first, k = 0; i < plan.delta_lights && left >= 0; i += stride, ++k) {
        const float weight = candidates[k].weight;
        if (!(weight > 0)) continue;
        chosen = ChosenLight{i, weight / (sum * static_cast<float>(stride)), candidates[k]};
        left -= weight;
    }
    return chosen;
}

} // namespace

std::optional<ScatteredLight> sample_scattered_light(const RenderPlan& plan, MediaOnRay& on_ray, Vec2 u) {
    const std::vector<Medium>& media = plan.scene.media;
    const Ray& ray = on_ray.ray();
    const Interval range = scattering_range(on_ray);
    if (range.empty()) return std::nullopt;
    StoppedDistance stopped(on_ray, range);
    const std::optional<ChosenLight> chosen = choose_light(plan, ray, range, stopped, u.y);
    if (!chosen) return std::nullopt;
    const Interval lit = chosen->on_ray.range;
    std::optional<StoppedDistance> stopped_there;
    if (lit.begin != range.begin || lit.end != range.end) stopped_there.emplace(on_ray, lit);
    if (!(stopped_there ? *stopped_there : stopped).possible()) return std::nullopt;
    ScatteringDistance distance(stopped_there ? *stopped_there : stopped, chosen->on_ray.angle);
    const float t = distance.sample(u.x);
    if (t == kInfinity) return std::nullopt;
    const MediumVertex vertex{ray.at(t), ray.direction, ray.time, 0};
    const std::optional<LightSample> s = sample_light(plan.scene.lights[chosen->index], vertex.p, {});
    if (!s) return std::nullopt;
    const PointOnRay point = distance.at(t);
    const float pdf = chosen->probability * point.pdf;
    if (!(pdf > 0)) return std::nullopt;                              // rounding has moved t out of the media
    const Rgb scattering = scattering_at(media, ray, t, s->wi) / pdf; // divided first, because both may be very large
    const Rgb radiance = point.transmittance * scattering * s->radiance *
                         estimate_transmittance(media, spawn_ray(plan, vertex, s->wi), s->distance, u.x);
    if (is_black(radiance)) return std::nullopt;
    return ScatteredLight{vertex, light_sample(*s, {chosen->index, pdf, 0}), radiance};
}

EquiangularDistance::EquiangularDistance(const Ray& ray, Interval range, Vec3 light) : range_(range) {
    const Vec3 to_light = light - ray.at(range.begin);
    // If the light lay on the ray itself, only its own distance could be drawn. It is therefore moved slightly off the
    // ray.
    height_ = std::max(length(cross(to_light, ray.direction)), 1e-5f * std::max(length(to_light), 1e-30f));
    begin_ = -dot(to_light, ray.direction);
    const float end = begin_ + (range.end - range.begin);
    // A difference of the angles to both ends would suffer from cancellation for a distant light.
    angle_ = end < kInfinity ? std::atan2(height_ * (range.end - range.begin), sqr(height_) + begin_ * end)
                             : std::atan2(height_, begin_);
}

float EquiangularDistance::sample(float u) const {
    // The distance is the tangent of a sum of angles minus the tangent of the first angle. The sum is below π/2, so the
    // denominator is positive.
    const float cosine = std::cos(angle_ * u), sine = std::sin(angle_ * u);
    const float distance = (sqr(height_) + sqr(begin_)) * sine / (height_ * cosine - begin_ * sine);
    return distance >= 0 ? std::min(range_.begin + distance, range_.end) : range_.end; // beyond π/2 by rounding
}

float EquiangularDistance::pdf(float t) const {
    return height_ / (angle_ * (sqr(height_) + sqr(begin_ + (t - range_.begin))));
}

StoppedDistance::StoppedDistance(MediaOnRay& media, Interval range)
    : media_(media), range_(range), lit_length_(range.end - range.begin) {
    constexpr float kDeep = 4; // optical depth at which 2 % of the light is left
    for (std::size_t i = 0; i < media_.size(); ++i) {
        const Medium& medium = media_[i].medium();
        shares_[i] = Rgb();
        const Interval in = inside(media_[i]);
        if (in.empty() || is_black(medium.scattering)) continue;
        const Rgb sigma = medium.scattering + medium.absorption;
        float least = max_component(sigma);
        for (std::size_t c = 0; c < 3; ++c)
            if (sigma[c] > 0) least = std::min(least, sigma[c]);
        const float passed_by = media_[i].passed_by(in.begin, kDeep / least);
        const bool deep = passed_by < in.end;
        const float column = deep ? kInfinity : media_[i].column(in.begin, in.end);
        for (std::size_t c = 0; c < 3; ++c) {
            shares_[i][c] = sigma[c] == 0 ? 0 : -std::expm1(-sigma[c] * column);
            stopped_ += shares_[i][c];
        }
        const float largest = medium.density ? medium.density->largest() : 1;
        if (deep) lit_length_ = std::min(lit_length_, std::max(passed_by - range_.begin, kDeep / (least * largest)));
    }
}

Interval StoppedDistance::inside(const MediumOnRay& medium) const {
    return {std::max(medium.inside().begin, range_.begin), std::min(medium.inside().end, range_.end)};
}

float StoppedDistance::sample(float u) {
    float left = u * stopped_;
    for (std::size_t i = 0; i < media_.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            if (left < shares_[i][c]) {
                const float sigma = media_[i].medium().scattering[c] + media_[i].medium().absorption[c];
                const Interval in = inside(media_[i]);
                const float t = media_[i].follow(in.begin, -std::log1p(-left) / sigma).t;
                return t < in.end ? t : kInfinity;
            }
            left -= shares_[i][c];
        }
    return kInfinity;
}

PointOnRay StoppedDistance::at(float t) {
    PointOnRay point;
    Rgb depth;
    for (std::size_t i = 0; i < media_.size(); ++i) {
        const Medium& medium = media_[i].medium();
        depth += optical_depth(medium, media_[i].column(t));
        const Interval in = inside(media_[i]);
        if (!(in.begin <= t) || in.end < t) continue; // t is outside the medium
        const float column = media_[i].column(range_.begin, t);
        const float density = density_at(medium, media_.ray().at(t));
        for (std::size_t c = 0; c < 3; ++c)
            if (const float sigma = medium.scattering[c] + medium.absorption[c]; shares_[i][c] > 0)
                point.pdf += sigma * density * std::exp(-sigma * column);
    }
    point.pdf /= stopped_;
    point.transmittance = transmittance(depth);
    return point;
}

float ScatteringDistance::sample(float u) {
    if (!angle_) return stopped_.sample(u);
    return u < 0.5f ? angle_->sample(2 * u) : stopped_.sample(2 * u - 1);
}

PointOnRay ScatteringDistance::at(float t) {
    PointOnRay point = stopped_.at(t);
    if (angle_) point.pdf = (angle_->pdf(t) + point.pdf) / 2;
    return point;
}

} // namespace duet::raytrace
