// Which light to sample: one of the scene's, or the environment, in proportion to power.
#pragma once

#include "common/light/environment.h"
#include "common/light/light.h"
#include "common/sampling/distribution.h"

#include <optional>
#include <vector>

namespace duet {

struct LightChoice {
    std::size_t index; ///< into the list of lights; its size stands for the environment
    float probability; ///< of this choice, > 0
    float remapped;    ///< what is left of the number that chose: uniform in [0, 1)
};

/// Chooses among lights and the environment. Index i < light_count() is a light, index light_count() the environment.
class LightChooser {
public:
    LightChooser() = default;
    /// environment_power: W, of environment_power(); scene_radius: metres, of a ball around all objects, for suns.
    LightChooser(const std::vector<Light>& lights, float environment_power, float scene_radius);

    /// u in [0, 1). Empty where nothing emits.
    std::optional<LightChoice> sample(float u) const;
    /// The probability with which `index` is chosen; 0 beyond the last.
    float probability(std::size_t index) const;

    std::size_t light_count() const { return light_count_; }
    std::size_t environment_index() const { return light_count_; }
    /// Nothing emits: there is no light to sample.
    bool empty() const { return distribution_.integral() == 0; }

private:
    std::size_t light_count_ = 0;
    Distribution1D distribution_;
};

/// The flux that the environment sends through a ball of the scene's radius, W, averaged over channels as light_power
/// is.
float environment_power(const Environment& environment, float scene_radius);

} // namespace duet
