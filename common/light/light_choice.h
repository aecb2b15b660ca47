// Which light to sample: by what each could contribute at a point.
#pragma once

#include "common/light/environment.h"
#include "common/light/light.h"
#include "common/light/light_tree.h"

#include <optional>
#include <vector>

namespace duet {

/// Chooses among lights and the environment. Index i < light_count() is a light, index light_count() the environment.
class LightChooser {
public:
    LightChooser() = default;
    /// sampled_irradiance: of the environment (see there), W/m²; 0: it is not sampled.
    LightChooser(const std::vector<Light>& lights, float sampled_irradiance);

    /// u in [0, 1). Empty where nothing can light the receiver.
    std::optional<LightChoice> sample(const LightReceiver& receiver, float u) const;
    /// The probability with which sample chooses `index`; 0 beyond the last.
    float probability(const LightReceiver& receiver, std::size_t index) const;

    std::size_t light_count() const { return light_count_; }
    std::size_t environment_index() const { return light_count_; }
    /// Nothing emits: there is no light to sample.
    bool empty() const { return sources_ == 0; }

private:
    /// Lights infinitely far away; the tree of all others is one choice more.
    struct Distant {
        std::size_t index;
        Vec3 to_light; ///< of a sun; (0, 0, 0) for the environment
        float irradiance;
    };
    float weight(const Distant& distant, const LightReceiver& receiver) const;
    /// What the choices weigh at a receiver, W/m².
    struct Weights {
        float tree = 0, sum = 0;
        int lit = 0; ///< choices of a weight above 0
        /// Of a choice of this weight.
        float probability(float weight) const;
    };
    Weights weights(const LightReceiver& receiver) const;

    std::size_t light_count_ = 0;
    std::size_t sources_ = 0; ///< choices: distant lights and the tree
    std::vector<Distant> distant_;
    LightTree tree_;
};

} // namespace duet
