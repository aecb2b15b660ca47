#include "common/light/light_choice.h"

#include <algorithm>
#include <limits>

namespace duet {

namespace {

/// The estimates ignore shadows. So that a sun blocked by the walls does not starve the lights inside a room, this
/// fraction of the samples is shared evenly among distant lights and the tree of all other lights.
constexpr float kEven = 0.5f;

} // namespace

LightChooser::LightChooser(const std::vector<Light>& lights, float sampled_irradiance)
    : light_count_(lights.size()), tree_(lights) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto* sun = std::get_if<SunLight>(&lights[i]);
        if (sun != nullptr && !is_black(sun->irradiance))
            distant_.push_back({i, -sun->direction, average(sun->irradiance)});
    }
    if (sampled_irradiance > 0) distant_.push_back({light_count_, Vec3(), sampled_irradiance});
    sources_ = distant_.size() + (tree_.empty() ? 0 : 1);
}

float LightChooser::weight(const Distant& distant, const LightReceiver& receiver) const {
    if (distant.index == light_count_ || receiver.n == Vec3()) return distant.irradiance;
    return distant.irradiance * max(dot(distant.to_light, receiver.n), 0.0f);
}

float LightChooser::Weights::probability(float weight) const {
    return weight > 0 ? kEven / static_cast<float>(lit) + (1 - kEven) * (weight / sum) : 0.0f;
}

LightChooser::Weights LightChooser::weights(const LightReceiver& receiver) const {
    Weights all;
    all.tree = min(tree_.irradiance(receiver), std::numeric_limits<float>::max());
    const auto add = [&](float weight) {
        all.sum += weight;
        all.lit += weight > 0;
    };
    add(all.tree);
    for (const Distant& distant : distant_) add(weight(distant, receiver));
    return all;
}

std::optional<LightChoice> LightChooser::sample(const LightReceiver& receiver, float u) const {
    if (distant_.empty()) return tree_.sample(receiver, u);
    if (sources_ == 1) return LightChoice{distant_[0].index, 1, u};
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
    const float through_tree = all.probability(all.tree);
    if (choose(through_tree)) {
        std::optional<LightChoice> choice = tree_.sample(receiver, u);
        if (choice) choice->probability *= through_tree;
        return choice;
    }
    for (const Distant& distant : distant_) {
        const float probability = all.probability(weight(distant, receiver));
        if (choose(probability)) return LightChoice{distant.index, probability, u};
    }
    return std::nullopt; // no light reaches the receiver, or u fell into the rounding error of the sum
}

float LightChooser::probability(const LightReceiver& receiver, std::size_t index) const {
    if (distant_.empty()) return tree_.probability(receiver, index);
    const auto found =
        std::find_if(distant_.begin(), distant_.end(), [&](const Distant& d) { return d.index == index; });
    if (sources_ == 1) return found != distant_.end() ? 1.0f : 0.0f;
    const Weights all = weights(receiver);
    if (found != distant_.end()) return all.probability(weight(*found, receiver));
    const float in_tree = tree_.probability(receiver, index);
    return in_tree > 0 ? all.probability(all.tree) * in_tree : 0.0f;
}

} // namespace duet
