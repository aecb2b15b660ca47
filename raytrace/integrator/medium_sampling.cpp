#include "raytrace/integrator/medium_sampling.h"

#include "common/sampling/hash.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace duet::raytrace {

namespace {

// Returns x · y, or 0 if x is 0 and y is infinite.
float product(float x, float y) { return x > 0 ? x * y : 0.0f; }
// Returns x / y, or 0 if both are 0.
Rgb ratio(Rgb x, Rgb y) {
    const auto divide = [](float a, float b) { return b > 0 ? a / b : 0.0f; };
    return {divide(x.r, y.r), divide(x.g, y.g), divide(x.b, y.b)};
}

// Carries a path over a distance on which it is not scattered.
void pass(const MediumStretch& stretch, float distance, Rgb& throughput, Rgb& emitted) {
    if (is_black(stretch.absorption)) return;
    const auto depth = [&](float absorption) { return product(absorption, distance); };
    const Rgb depths(depth(stretch.absorption.r), depth(stretch.absorption.g), depth(stretch.absorption.b));
    // Several media emit like one whose radiance is their mean by absorption.
    const Rgb absorbed(-std::expm1(-depths.r), -std::expm1(-depths.g), -std::expm1(-depths.b));
    emitted += throughput * absorbed * ratio(stretch.emission, stretch.absorption);
    throughput *= Rgb(std::exp(-depths.r), std::exp(-depths.g), std::exp(-depths.b));
}

// Returns the coefficients of scattering in the channels in which the path still carries light.
Rgb scattering_of_path(const MediumStretch& stretch, Rgb throughput) {
    const Rgb& s = stretch.scattering;
    return {throughput.r > 0 ? s.r : 0, throughput.g > 0 ? s.g : 0, throughput.b > 0 ? s.b : 0};
}

// Returns the asymmetry of one of the media on the stretch that begins at t, chosen by its share of their scattering.
float choose_asymmetry(std::span<const Medium> media, const Ray& ray, float t, float t_end, const Rgb& all, float u,
                       Rgb& throughput) {
    float left = u * average(all);
    const Medium* chosen = nullptr;
    for (const Medium& medium : media) {
        const Interval inside = overlap(medium.box, ray, t_end);
        if (inside.empty() || !(inside.begin <= t && t < inside.end) || is_black(medium.scattering)) continue;
        chosen = &medium;
        left -= average(medium.scattering);
        if (left < 0) break;
    }
    throughput *= ratio(chosen->scattering, all) * (average(all) / average(chosen->scattering));
    return chosen->asymmetry;
}

} // namespace

std::optional<MediumCollision> sample_collision(std::span<const Medium> media, const Ray& ray, float t_end, float u,
                                                Rgb& throughput, Rgb& emitted) {
    const std::uint64_t stream = mix_bits(std::bit_cast<std::uint32_t>(u) + kGoldenGamma);
    std::uint64_t drawn = 0;
    const auto random = [&] { return unit_float(high_bits(stream_number(stream, drawn++))); };
    float depth = -std::log1p(-u); // optical depth up to the next tentative collision
    for (float t = 0; t < t_end;) {
        const MediumStretch stretch = stretch_at(media, ray, t, t_end);
        const Rgb scattering = scattering_of_path(stretch, throughput);
        const float majorant = max_component(scattering), rest = product(majorant, stretch.end - t);
        if (rest <= depth) {
            pass(stretch, stretch.end - t, throughput, emitted);
            depth -= rest;
            t = stretch.end;
            continue;
        }
        const float begin = t;
        t += depth / majorant;
        pass(stretch, depth / majorant, throughput, emitted);
        const Rgb real = scattering / majorant, null = Rgb(1.0f) - real;
        const float weight = max_component(throughput * real), null_weight = max_component(throughput * null);
        if (!(weight + null_weight > 0)) return MediumCollision{t, 0}; // absorption leaves nothing, or it is invalid
        const float probability = weight / (weight + null_weight);
        if (random() < probability) {
            throughput *= real / probability;
            return MediumCollision{
                t, choose_asymmetry(media, ray, begin, t_end, stretch.scattering, random(), throughput)};
        }
        // This ends the path in the channel that scatters most. So there are two null collisions at most.
        throughput *= null / (1 - probability);
        depth = -std::log1p(-random());
    }
    return std::nullopt;
}

namespace {

// Returns the part of [0, t_end] from the first to the last point at which a medium scatters light, if there is any.
Interval scattering_range(std::span<const Medium> media, const Ray& ray, float t_end) {
    Interval range{t_end, 0};
    for (const Medium& medium : media) {
        const Interval inside = overlap(medium.box, ray, t_end);
        if (inside.empty() || is_black(medium.scattering)) continue;
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
        if (inside.begin <= t && t < inside.end) sum += medium.scattering * phase(ray.direction, wi, medium.asymmetry);
    }
    return sum;
}

// Returns the part of the range in which a ray is inside of the cone of a spot light, or a longer one. A point of the
// ray is inside if its height over the apex, along the axis, is at least cos θ times its distance from there. The
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
    if (a > 0) // the ray is steeper than the cone, and stays inside of it
        return slope > 0 ? Interval{std::max(range.begin, second), range.end}
                         : Interval{range.begin, std::min(range.end, first)};
    if (height + slope * (roots[0] + roots[1]) / 2 < 0) return {}; // the mirror image of the cone, behind the light
    return {std::max(range.begin, first), std::min(range.end, second)};
}

// A LightOnRay says how to sample the distances at which the light of a delta light is scattered.
struct LightOnRay {
    float intensity; // mean of the channels
    ScatteringDistance distance;

    // Returns what the light sends to the ray without media and occluders, by the roughest estimate.
    float weight() const { return intensity * distance.integral(); }
};
// Returns nothing if the light does not reach the range.
std::optional<LightOnRay> light_on_ray(std::span<const Medium> media, const Light& light, const Ray& ray,
                                       Interval range) {
    const auto extinction = [&](float t) {
        const MediumStretch stretch = stretch_at(media, ray, t, range.end);
        return average(stretch.scattering + stretch.absorption);
    };
    if (const auto* sun = std::get_if<SunLight>(&light))
        return LightOnRay{average(sun->irradiance), {range, extinction(range.begin)}};
    if (const auto* point = std::get_if<PointLight>(&light))
        return LightOnRay{average(point->intensity), {ray, point->position, range, extinction(range.begin)}};
    const auto& spot = std::get<SpotLight>(light);
    range = lit_range(spot, ray, range);
    if (range.empty()) return std::nullopt;
    return LightOnRay{average(spot.intensity), {ray, spot.position, range, extinction(range.begin)}};
}

// Chooses one delta light of at most kCandidates by its weight. If there are more, every k-th is a candidate, from a
// random one on.
constexpr std::size_t kCandidates = 8;

struct ChosenLight {
    std::size_t index;
    float probability;
    ScatteringDistance distance;
};
std::optional<ChosenLight> choose_light(const RenderPlan& plan, const Ray& ray, Interval range, float u) {
    const std::size_t stride = (plan.delta_lights + kCandidates - 1) / kCandidates;
    const float scaled = u * static_cast<float>(stride);
    const std::size_t first = std::min(static_cast<std::size_t>(scaled), stride - 1);
    std::array<std::optional<LightOnRay>, kCandidates> candidates;
    float sum = 0;
    for (std::size_t i = first, k = 0; i < plan.delta_lights; i += stride, ++k) {
        candidates[k] = light_on_ray(plan.scene.media, plan.scene.lights[i], ray, range);
        if (candidates[k]) sum += candidates[k]->weight();
    }
    float left = (scaled - static_cast<float>(first)) * sum;
    std::optional<ChosenLight> chosen;
    for (std::size_t i = first, k = 0; i < plan.delta_lights && left >= 0; i += stride, ++k) {
        const float weight = candidates[k] ? candidates[k]->weight() : 0;
        if (!(weight > 0)) continue;
        chosen = ChosenLight{i, weight / (sum * static_cast<float>(stride)), candidates[k]->distance};
        left -= weight;
    }
    return chosen;
}

} // namespace

std::optional<ScatteredLight> sample_scattered_light(const RenderPlan& plan, const Ray& ray, float t_end, Vec2 u) {
    const std::vector<Medium>& media = plan.scene.media;
    const Interval range = scattering_range(media, ray, t_end);
    if (range.empty()) return std::nullopt;
    const std::optional<ChosenLight> chosen = choose_light(plan, ray, range, u.y);
    if (!chosen) return std::nullopt;
    const float t = chosen->distance.sample(u.x);
    const MediumVertex vertex{ray.at(t), ray.direction, ray.time, 0};
    const std::optional<LightSample> s = sample_light(plan.scene.lights[chosen->index], vertex.p, {});
    if (!s) return std::nullopt;
    const float pdf = chosen->probability * chosen->distance.pdf(t);
    const Rgb scattering = scattering_at(media, ray, t, s->wi) / pdf; // at first, because each of both may be huge
    const Rgb radiance = transmittance(media, ray, t) * scattering * s->radiance *
                         transmittance(media, spawn_ray(plan, vertex, s->wi), s->distance);
    if (is_black(radiance)) return std::nullopt;
    return ScatteredLight{vertex, light_sample(*s, {chosen->index, pdf, 0}), radiance};
}

ScatteringDistance::ScatteringDistance(Interval range, float extinction)
    : range_(range), extinction_(extinction), scattered_(-std::expm1(-product(extinction, range.end - range.begin))) {}

ScatteringDistance::ScatteringDistance(const Ray& ray, Vec3 light, Interval range, float extinction)
    : ScatteringDistance(range, extinction) {
    const Vec3 to_light = light - ray.at(range.begin);
    // A light on the ray itself would leave no distance but its own to draw, so it counts as slightly beside it.
    height_ = std::max(length(cross(to_light, ray.direction)), 1e-5f * std::max(length(to_light), 1e-30f));
    begin_ = -dot(to_light, ray.direction);
    const float end = begin_ + (range.end - range.begin);
    // The difference of the angles to both ends would cancel for a distant light.
    angle_ = end < kInfinity ? std::atan2(height_ * (range.end - range.begin), sqr(height_) + begin_ * end)
                             : std::atan2(height_, begin_);
    share_of_angles_ = scattered_ > 0 ? 0.5f : 1.0f;
}

float ScatteringDistance::sample_angle(float u) const {
    // This is the tangent of a sum of angles, less the tangent of the first. The sum is below π/2, so the denominator
    // is positive.
    const float cosine = std::cos(angle_ * u), sine = std::sin(angle_ * u);
    const float distance = (sqr(height_) + sqr(begin_)) * sine / (height_ * cosine - begin_ * sine);
    return distance >= 0 ? std::min(range_.begin + distance, range_.end) : range_.end; // rounded beyond π/2
}

float ScatteringDistance::sample_transmittance(float u) const {
    return std::min(range_.begin - std::log1p(-u * scattered_) / extinction_, range_.end);
}

float ScatteringDistance::sample(float u) const {
    return u < share_of_angles_ ? sample_angle(u / share_of_angles_)
                                : sample_transmittance((u - share_of_angles_) / (1 - share_of_angles_));
}

float ScatteringDistance::pdf(float t) const {
    const float distance = t - range_.begin;
    float density = 0;
    if (share_of_angles_ > 0) density = share_of_angles_ * height_ / (angle_ * (sqr(height_) + sqr(begin_ + distance)));
    if (share_of_angles_ < 1)
        density += (1 - share_of_angles_) * extinction_ * std::exp(-extinction_ * distance) / scattered_;
    return density;
}

float ScatteringDistance::integral() const {
    return share_of_angles_ > 0 ? angle_ / height_ : std::min(range_.end - range_.begin, 1 / extinction_);
}

} // namespace duet::raytrace
