#include "raytrace/sampling/light_sampler.h"

#include <algorithm>
#include <limits>

namespace duet {

namespace {

/// This fraction of the samples is shared evenly among lights at infinity and the tree of all other lights. The
/// irradiance estimates ignore shadows, and a sun that the walls block must not starve the lights inside a room.
constexpr float kUniformFraction = 0.5f;

} // namespace

LightSampler::LightSampler(const std::vector<Light>& lights, float sampled_irradiance)
    : light_count_(lights.size()), tree_(lights) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto* sun = std::get_if<SunLight>(&lights[i]);
        if (sun != nullptr && !is_black(sun->irradiance))
            infinite_lights_.push_back({i, -sun->direction, average(sun->irradiance)});
    }
    if (sampled_irradiance > 0) infinite_lights_.push_back({light_count_, Vec3(), sampled_irradiance});
    choice_count_ = infinite_lights_.size() + (tree_.empty() ? 0 : 1);
}

float LightSampler::weight(const InfiniteLight& light, const LightReceiver& receiver) const {
    if (light.index == light_count_ || receiver.n == Vec3()) return light.irradiance;
    return light.irradiance * max(dot(light.to_light, receiver.n), 0.0f);
}

float LightSampler::Weights::probability(float weight) const {
    return weight > 0 ? kUniformFraction / static_cast<float>(nonzero) + (1 - kUniformFraction) * (weight / sum) : 0.0f;
}

LightSampler::Weights LightSampler::weights(const LightReceiver& receiver) const {
    Weights all;
    all.tree = min(tree_.irradiance(receiver), std::numeric_limits<float>::max());
    const auto add = [&](float weight) {
        all.sum += weight;
        all.nonzero += weight > 0;
    };
    add(all.tree);
    for (const InfiniteLight& light : infinite_lights_) add(weight(light, receiver));
    return all;
}

std::optional<SampledLight> LightSampler::sample(const LightReceiver& receiver, float u) const {
    if (infinite_lights_.empty()) return tree_.sample(receiver, u);
    if (choice_count_ == 1) return SampledLight{infinite_lights_[0].index, 1, u};
    const Weights all = weights(receiver);
    // Returns whether u selects a choice of this probability, and prepares u for the next decision.
    const auto choose = [&](float probability) {
        if (!(u < probability)) {
            u -= probability;
            return false;
        }
        u = min(u / probability, kOneMinusEpsilon);
        return true;
    };
    const float tree_probability = all.probability(all.tree);
    if (choose(tree_probability)) {
        std::optional<SampledLight> choice = tree_.sample(receiver, u);
        if (choice) choice->probability *= tree_probability;
        return choice;
    }
    for (const InfiniteLight& light : infinite_lights_) {
        const float probability = all.probability(weight(light, receiver));
        if (choose(probability)) return SampledLight{light.index, probability, u};
    }
    return std::nullopt; // no light reaches the receiver, or u exceeds the rounded sum
}

float LightSampler::probability(const LightReceiver& receiver, std::size_t index) const {
    if (infinite_lights_.empty()) return tree_.probability(receiver, index);
    const auto found = std::find_if(infinite_lights_.begin(), infinite_lights_.end(),
                                    [&](const InfiniteLight& d) { return d.index == index; });
    if (choice_count_ == 1) return found != infinite_lights_.end() ? 1.0f : 0.0f;
    const Weights all = weights(receiver);
    if (found != infinite_lights_.end()) return all.probability(weight(*found, receiver));
    const float probability_in_tree = tree_.probability(receiver, index);
    return probability_in_tree > 0 ? all.probability(all.tree) * probability_in_tree : 0.0f;
}

} // namespace duet
