// Chooses the light to sample by the contribution of each light to a point.
#pragma once

#include "common/light/environment.h"
#include "common/light/light.h"
#include "raytrace/sampling/light_tree.h"

#include <optional>
#include <vector>

namespace duet {

/// Chooses among the lights and the environment. Indices below environment_index() are lights.
class LightSampler {
public:
    LightSampler() = default;
    /// `sampled_irradiance` is the irradiance of the environment's sampled part, W/m² (see environment.h). If it is 0,
    /// the environment is not sampled.
    LightSampler(const std::vector<Light>& lights, float sampled_irradiance);

    /// Chooses a light by its estimated irradiance at the receiver. u is in [0, 1). The result is empty if no light can
    /// illuminate the receiver.
    std::optional<SampledLight> sample(const LightReceiver& receiver, float u) const;
    /// Returns the probability with which sample chooses `index`. It is 0 for an index beyond the last.
    float probability(const LightReceiver& receiver, std::size_t index) const;

    std::size_t environment_index() const { return light_count_; }
    /// Returns whether there is no light to sample.
    bool empty() const { return choice_count_ == 0; }

private:
    /// Represents a light at infinity: a sun or the environment. The tree of all other lights is one further choice.
    struct InfiniteLight {
        std::size_t index;
        Vec3 to_light; ///< direction to a sun, unit; (0, 0, 0) for the environment
        float irradiance;
    };
    float weight(const InfiniteLight& light, const LightReceiver& receiver) const;
    /// Holds the weights of all choices at a receiver, W/m².
    struct Weights {
        float tree = 0, sum = 0;
        int nonzero = 0; ///< number of choices of a weight above 0
        /// Returns the probability of a choice of this weight.
        float probability(float weight) const;
    };
    Weights weights(const LightReceiver& receiver) const;

    std::size_t light_count_ = 0;
    std::size_t choice_count_ = 0; ///< number of choices: infinite lights and the tree
    std::vector<InfiniteLight> infinite_lights_;
    LightTree tree_;
};

} // namespace duet
