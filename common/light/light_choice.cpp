#include "common/light/light_choice.h"

#include <algorithm>

namespace duet {

LightChooser::LightChooser(const std::vector<Light>& lights, float environment_power, float scene_radius)
    : light_count_(lights.size()) {
    std::vector<double> powers;
    powers.reserve(lights.size() + 1);
    for (const Light& light : lights) powers.push_back(static_cast<double>(light_power(light, scene_radius)));
    powers.push_back(static_cast<double>(environment_power));
    // A power may exceed float's range at extreme scales: such a light takes (nearly) all samples.
    for (double& power : powers)
        power = power > 0 ? std::min(power, static_cast<double>(std::numeric_limits<float>::max())) : 0.0;
    // Power says little of what reaches a point: the sun and the sky of a scene a kilometre wide would starve the lamp
    // on the table. Half of the samples are shared evenly, so no light's probability is below 1/2n.
    double total = 0;
    for (const double power : powers) total += power;
    const auto lit = static_cast<double>(std::count_if(powers.begin(), powers.end(), [](double p) { return p > 0; }));
    if (total > 0)
        for (double& power : powers) power = power > 0 ? 0.5 / lit + 0.5 * (power / total) : 0.0;
    distribution_ = Distribution1D(powers);
}

std::optional<LightChoice> LightChooser::sample(float u) const {
    if (empty()) return std::nullopt;
    const Distribution1D::Sample s = distribution_.sample(u);
    return LightChoice{s.index, distribution_.probability(s.index), s.remapped};
}

float LightChooser::probability(std::size_t index) const {
    return !empty() && index < distribution_.size() ? distribution_.probability(index) : 0.0f;
}

float environment_power(const Environment& environment, float scene_radius) {
    // From each direction of the sphere's 4π, radiance times the ball's cross-section π r².
    const double r = static_cast<double>(scene_radius);
    return static_cast<float>(4 * kPiDouble * kPiDouble * r * r *
                              static_cast<double>(average(mean_radiance(environment))));
}

} // namespace duet
