#include "raytrace/integrator/medium_sampling.h"

#include "raytrace/sampling/random_sequence.h"

#include <algorithm>
#include <cmath>

namespace duet::raytrace {

namespace {

// Returns x · y, or 0 if x is 0 and y is infinite.
float product(float x, float y) { return x > 0 ? x * y : 0.0f; }

// Calls function(channel) for each channel.
template <typename Function> Rgb for_channels(const Function& function) {
    return {function(0), function(1), function(2)};
}

// Returns the optical depth of all media but media[index] up to t.
Rgb depth_of_others(MediaOnRay& media, std::size_t index, float t) {
    Rgb depth;
    for (std::size_t i = 0; i < media.size(); ++i)
        if (i != index) depth += optical_depth(media[i].medium(), media[i].column(t));
    return depth;
}
// Returns whether another medium than media[index] overlaps the interval of the ray.
bool others_overlap(MediaOnRay& media, std::size_t index, Interval interval) {
    for (std::size_t i = 0; i < media.size(); ++i) {
        const Interval other{media[i].inside().begin, std::min(media[i].inside().end, interval.end)};
        if (i != index && !other.empty() && other.end > interval.begin) return true;
    }
    return false;
}

// Returns the light that a medium emits on the ray, times the path's throughput. If no other medium overlaps it on the
// ray, it is integrated in closed form, for any density. Otherwise one random point estimates it.
Rgb sample_emission(MediaOnRay& media, std::size_t index, Rgb throughput, RandomSequence& random) {
    const Medium& medium = media[index].medium();
    if (is_black(throughput * medium.absorption * medium.radiance)) return {};
    const Interval inside = media[index].inside();
    const float column = media[index].column(inside.end);
    if (!(column > 0)) return {};
    // The medium absorbs the fraction σa / (σs + σa) of the light that it stops, and emits the same fraction of its
    // radiance.
    const Rgb extinction = medium.scattering + medium.absorption;
    const Rgb stopped = for_channels([&](std::size_t c) { return -std::expm1(-product(extinction[c], column)); });
    const Rgb source = throughput * medium.radiance * for_channels([&](std::size_t c) {
                           return medium.absorption[c] > 0 ? medium.absorption[c] / extinction[c] : 0.0f;
                       });
    const Rgb alone = source * stopped;
    if (is_black(alone)) return {};
    if (!others_overlap(media, index, inside))
        return alone * transmittance(depth_of_others(media, index, inside.begin));

    const ChosenChannel channel(alone, random());
    const float sigma = extinction[channel.index]; // > 0, because the medium emits in this channel
    const float passed = -std::log1p(-random() * stopped[channel.index]) / sigma;
    const float t = std::min(media[index].follow(inside.begin, passed).t, inside.end);
    const Rgb before = for_channels([&](std::size_t c) { return std::exp(-extinction[c] * passed); });
    const Rgb density =
        for_channels([&](std::size_t c) { return alone[c] > 0 ? extinction[c] * before[c] / stopped[c] : 0.0f; });
    return source * extinction * before * transmittance(depth_of_others(media, index, t)) / channel.mean(density);
}

// Holds the optical depths of media up to a point of a ray.
struct OpticalDepths {
    Rgb extinction, scattering;

    void add(const Medium& medium, float column) {
        const Rgb& s = medium.scattering;
        extinction += optical_depth(medium, column);
        scattering += Rgb(product(s.r, column), product(s.g, column), product(s.b, column));
    }
};

} // namespace

std::optional<MediumCollision> sample_collision(MediaOnRay& media, float u, Rgb& throughput, Rgb& emitted) {
    if (is_black(throughput)) return std::nullopt;
    RandomSequence random(u);
    for (std::size_t i = 0; i < media.size(); ++i) emitted += sample_emission(media, i, throughput, random);
    const ChosenChannel channel(throughput, random());
    float t_end = media.t_end(); // distance of the first collision so far
    MediumOnRay* collided = nullptr;
    float passed_column = 0; // column of the medium that collided
    bool first = true; // u is stratified, so the first medium on the ray uses it
    for (MediumOnRay& on_ray : media) {
        const Interval inside = on_ray.inside();
        if (inside.empty() || inside.begin >= t_end) continue;
        const float depth = -std::log1p(first ? -u : -random());
        first = false;
        const float sigma = on_ray.medium().scattering[channel.index];
        if (!(sigma > 0)) continue;
        const PassedColumn passed = on_ray.follow(inside.begin, depth / sigma);
        if (!(passed.t < t_end)) continue;
        t_end = passed.t, passed_column = passed.column;
        collided = &on_ray;
    }
    OpticalDepths depths;
    for (MediumOnRay& on_ray : media)
        depths.add(on_ray.medium(), &on_ray == collided ? passed_column : on_ray.column(t_end));
    Rgb value = transmittance(depths.extinction), density = transmittance(depths.scattering);
    if (collided != nullptr) {
        value *= collided->medium().scattering;
        density *= collided->medium().scattering;
    }
    const float mean = channel.mean(density);
    throughput *= mean == 0 ? Rgb() : value / mean; // an invalid throughput stays invalid
    if (collided == nullptr) return std::nullopt;
    return MediumCollision{t_end, collided->medium().asymmetry};
}

Rgb estimate_transmittance(std::span<const Medium> media, const Ray& ray, float t_end, float u) {
    constexpr float kDeep = 3; // optical depth at which 5 % of the light is left
    RandomSequence random(u);
    Rgb depth;
    for (const Medium& medium : media) {
        const Interval inside = overlap(medium.box, ray, t_end);
        if (inside.empty()) continue;
        const Rgb extinction = medium.scattering + medium.absorption;
        const float least = std::min({extinction.r, extinction.g, extinction.b});
        if (!medium.density || least == 0) {
            depth += optical_depth(medium, column_of(medium, ray.origin, ray.direction, inside));
            continue;
        }
        const float survived = kDeep - std::log1p(-random()); // optical depth at which roulette ends the ray
        const PassedColumn passed = follow(medium, ray, inside, survived / least);
        if (passed.t < kInfinity) return {};
        depth += optical_depth(medium, passed.column);
        depth += Rgb(std::min(kDeep - least * passed.column, 0.0f)); // divides by the survival probability
    }
    return transmittance(depth);
}

} // namespace duet::raytrace
