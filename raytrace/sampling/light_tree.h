// Declares the light tree, which chooses one of thousands of lights by its contribution at a point.
#pragma once

#include "common/light/light_bounds.h"

#include <optional>
#include <vector>

namespace duet {

/// Holds a light that was chosen at random.
struct SampledLight {
    std::size_t index; ///< index into the list of lights
    float probability; ///< probability of this choice, > 0
    float remapped;    ///< random number for reuse, uniform in [0, 1)
};

/// Stores a binary tree over the bounds of lights. Sampling descends from the root and chooses a child in proportion to
/// the irradiance that its lights could cause (Conty Estevez and Kulla 2018). In a leaf it chooses among the few lights
/// by the estimate of each. A tree of at most kLeafLights lights is a single leaf.
class LightTree {
public:
    /// A leaf holds at most this many lights.
    static constexpr std::size_t kLeafLights = 8;

    LightTree() = default;
    /// Builds the tree of all lights of the list, except suns and lights that emit nothing.
    explicit LightTree(const std::vector<Light>& lights);

    bool empty() const { return nodes_.empty(); }
    /// Returns an estimate of the irradiance from all lights together, W/m².
    float irradiance(const LightReceiver& receiver) const;
    /// Chooses a light. u is in [0, 1). The result is empty where no light can illuminate the receiver.
    std::optional<SampledLight> sample(const LightReceiver& receiver, float u) const;
    /// Returns the probability with which sample chooses a light. It is 0 for a light that is not in the tree.
    float probability(const LightReceiver& receiver, std::size_t index) const;

private:
    struct LeafLight {
        LightBounds bounds;
        std::size_t index; ///< index into the list of lights
    };
    struct Node {
        LightBounds bounds;
        /// In an inner node this is the index of the second child; the first child is the next node. In a leaf it is
        /// the index of the first light.
        std::uint32_t first = 0;
        std::uint32_t count = 0; ///< number of lights in a leaf; 0: an inner node
    };
    /// Stores the path from the root to a light. Bit i of `bit_trail` is set where level i takes the second child.
    /// leaf_light is the light's index in lights_.
    struct TreePath {
        std::uint64_t bit_trail = 0;
        std::uint32_t leaf_light = kNoLeaf;
    };
    static constexpr std::uint32_t kNoLeaf = 0xffffffffu;

    std::uint32_t build(std::uint32_t first, std::uint32_t last, std::uint64_t bit_trail, int depth);
    std::uint32_t split(std::uint32_t first, std::uint32_t last, const LightBounds& bounds, int depth);
    float first_child_probability(const Node& node, const LightReceiver& receiver) const;

    std::vector<Node> nodes_;
    std::vector<LeafLight> lights_; ///< all lights, in the order of leaves
    std::vector<TreePath> paths_;   ///< path to each light, indexed as the list of lights
};

} // namespace duet
