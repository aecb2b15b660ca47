// A tree over lights, by which one of thousands is chosen for what it can contribute at a point.
#pragma once

#include "common/light/light_bounds.h"

#include <optional>
#include <vector>

namespace duet {

struct LightChoice {
    std::size_t index; ///< into the list of lights
    float probability; ///< of this choice, > 0
    float remapped;    ///< what is left of the number that chose: uniform in [0, 1)
};

/// Bounds of lights in a binary tree. A light is chosen on the way down, at each fork in proportion to the irradiance
/// that its sides could give (Conty Estevez and Kulla 2018); among the few lights of a leaf by each one's own. So few
/// lights, which are one leaf, are weighed one by one.
class LightTree {
public:
    /// Lights that a leaf may hold.
    static constexpr std::size_t kLeafLights = 8;

    LightTree() = default;
    /// Of all lights of the list but suns and those that send nothing.
    explicit LightTree(const std::vector<Light>& lights);

    bool empty() const { return nodes_.empty(); }
    /// What all could give together, W/m².
    float irradiance(const LightReceiver& receiver) const;
    /// u in [0, 1). Empty where no light can light the receiver.
    std::optional<LightChoice> sample(const LightReceiver& receiver, float u) const;
    /// The probability with which sample chooses a light; 0 for one that is not in the tree.
    float probability(const LightReceiver& receiver, std::size_t index) const;

private:
    struct Leaf {
        LightBounds bounds;
        std::size_t index; ///< into the list of lights
    };
    struct Node {
        LightBounds bounds;
        std::uint32_t first = 0; ///< the second child (the first is the next node); of a leaf: its lights
        std::uint32_t count = 0; ///< of a leaf's lights; 0: an inner node
    };
    /// Where a light is found: turns from the root down, the first the lowest bit, and its place.
    struct Place {
        std::uint64_t turns = 0;
        std::uint32_t leaf_light = kNowhere;
    };
    static constexpr std::uint32_t kNowhere = 0xffffffffu;

    std::uint32_t build(std::uint32_t first, std::uint32_t last, std::uint64_t turns, int depth);
    std::uint32_t split(std::uint32_t first, std::uint32_t last, const LightBounds& bounds, int depth);
    float first_share(const Node& node, const LightReceiver& receiver) const;

    std::vector<Node> nodes_;
    std::vector<Leaf> lights_;  ///< in the order of leaves
    std::vector<Place> places_; ///< by index of the light
};

} // namespace duet
