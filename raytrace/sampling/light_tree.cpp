#include "raytrace/sampling/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet {

namespace {

constexpr std::size_t kBins = 12;
constexpr int kMedianSplitDepth = 32; ///< from this depth on lists are halved, so that no path exceeds 64 levels

/// Returns the solid angle of the directions into which lights with normals in a cone emit, weighted as in Conty
/// Estevez and Kulla 2018, eq. 1, for emission up to 90° from the normal.
float orientation_measure(float cos_normals) {
    const float o = std::acos(clamp(cos_normals, -1.0f, 1.0f)), w = min(o + kPi / 2, kPi);
    return 2 * kPi * (1 - std::cos(o)) +
           kPi / 2 * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
}
float cost(const LightBounds& bounds) {
    if (bounds.empty()) return 0;
    // The cost of a flat or thin box is not its area alone, because the lights in it are still apart.
    const Vec3 d = bounds.box.diagonal();
    return bounds.intensity * orientation_measure(bounds.cos_normals) * (bounds.box.half_area() + length_squared(d));
}

/// Rescales u from the subinterval [from, from + size) to [0, 1).
float remap_sample(float u, float from, float size) { return clamp((u - from) / size, 0.0f, kOneMinusEpsilon); }

} // namespace

LightTree::LightTree(const std::vector<Light>& lights) : paths_(lights.size()) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (std::holds_alternative<SunLight>(lights[i])) continue;
        const LightBounds bounds = light_bounds(lights[i]);
        if (!bounds.empty()) lights_.push_back({bounds, i});
    }
    if (!lights_.empty()) build(0, static_cast<std::uint32_t>(lights_.size()), 0, 0);
}

// Builds the node of lights [first, last) with its whole subtree, and returns its index.
std::uint32_t LightTree::build(std::uint32_t first, std::uint32_t last, std::uint64_t bit_trail, int depth) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    LightBounds bounds;
    for (std::uint32_t i = first; i < last; ++i) bounds.extend(lights_[i].bounds);
    nodes_[index].bounds = bounds;
    if (last - first <= kLeafLights) {
        nodes_[index].first = first;
        nodes_[index].count = last - first;
        for (std::uint32_t i = first; i < last; ++i) paths_[lights_[i].index] = {bit_trail, i};
        return index;
    }
    const std::uint32_t middle = split(first, last, bounds, depth);
    build(first, middle, bit_trail, depth + 1);
    nodes_[index].first = build(middle, last, bit_trail | std::uint64_t{1} << depth, depth + 1);
    return index;
}

// Partitions lights [first, last) at the split of least cost, and returns the start of the second part.
std::uint32_t LightTree::split(std::uint32_t first, std::uint32_t last, const LightBounds& bounds, int depth) {
    const auto begin = lights_.begin() + first, end = lights_.begin() + last;
    Box3 centers;
    for (auto light = begin; light != end; ++light) centers.extend(light->bounds.box.center());
    const auto bin_of = [&](const LeafLight& light, std::size_t axis) {
        const float extent = centers.diagonal()[axis];
        const float part = (light.bounds.box.center()[axis] - centers.low[axis]) / extent;
        return std::min(static_cast<std::size_t>(part * static_cast<float>(kBins)), kBins - 1);
    };
    struct {
        float cost = std::numeric_limits<float>::infinity();
        std::size_t axis = 0, bin = 0;
    } best;
    const Vec3 extent = bounds.box.diagonal();
    for (std::size_t axis = 0; axis < 3 && depth < kMedianSplitDepth; ++axis) {
        if (!(centers.diagonal()[axis] > 0)) continue;
        std::array<LightBounds, kBins> bins, right;
        for (auto light = begin; light != end; ++light) bins[bin_of(*light, axis)].extend(light->bounds);
        for (std::size_t i = kBins - 1; i > 0; --i) {
            right[i - 1] = i + 1 < kBins ? right[i] : LightBounds();
            right[i - 1].extend(bins[i]);
        }
        const float stretch = max_component(extent) / max(extent[axis], max_component(extent) * 1e-6f);
        LightBounds left;
        for (std::size_t i = 0; i + 1 < kBins; ++i) {
            left.extend(bins[i]);
            const float both = stretch * (cost(left) + cost(right[i]));
            if (!left.empty() && !right[i].empty() && both < best.cost) best = {both, axis, i};
        }
    }
    if (!std::isfinite(best.cost)) { // all centers coincide, or the depth limit is reached
        const std::size_t axis = longest_axis(centers.diagonal());
        const auto middle = begin + (end - begin) / 2;
        std::nth_element(begin, middle, end, [&](const LeafLight& a, const LeafLight& b) {
            const float ca = a.bounds.box.center()[axis], cb = b.bounds.box.center()[axis];
            return ca != cb ? ca < cb : a.index < b.index;
        });
        return static_cast<std::uint32_t>(middle - lights_.begin());
    }
    const auto middle =
        std::stable_partition(begin, end, [&](const LeafLight& light) { return bin_of(light, best.axis) <= best.bin; });
    return static_cast<std::uint32_t>(middle - lights_.begin());
}

float LightTree::irradiance(const LightReceiver& receiver) const {
    return empty() ? 0.0f : irradiance_estimate(nodes_[0].bounds, receiver);
}

// Returns the probability of an inner node's first child, or a negative value where neither child can illuminate the
// receiver.
float LightTree::first_child_probability(const Node& node, const LightReceiver& receiver) const {
    const float a = irradiance_estimate((&node)[1].bounds, receiver);
    const float b = irradiance_estimate(nodes_[node.first].bounds, receiver);
    return a + b > 0 ? a / (a + b) : -1.0f;
}

std::optional<SampledLight> LightTree::sample(const LightReceiver& receiver, float u) const {
    if (empty()) return std::nullopt;
    const Node* node = &nodes_[0];
    float probability = 1;
    while (node->count == 0) {
        const float p_first = first_child_probability(*node, receiver);
        if (p_first < 0) return std::nullopt;
        const bool first = u < p_first;
        probability *= first ? p_first : 1 - p_first;
        u = first ? remap_sample(u, 0, p_first) : remap_sample(u, p_first, 1 - p_first);
        node = first ? node + 1 : &nodes_[node->first];
    }
    if (node->count == 1) return SampledLight{lights_[node->first].index, probability, u};
    std::array<float, kLeafLights> weights;
    float sum = 0;
    for (std::uint32_t i = 0; i < node->count; ++i)
        sum += weights[i] = irradiance_estimate(lights_[node->first + i].bounds, receiver);
    if (!(sum > 0)) return std::nullopt;
    float left = u * sum;
    std::uint32_t i = 0, last = node->count; // if rounding leads beyond the end, `last` is chosen
    for (; i < node->count; ++i) {
        if (!(weights[i] > 0)) continue;
        last = i;
        if (left < weights[i]) break;
        left -= weights[i];
    }
    const float weight = weights[last];
    return SampledLight{lights_[node->first + last].index, probability * (weight / sum), remap_sample(left, 0, weight)};
}

float LightTree::probability(const LightReceiver& receiver, std::size_t index) const {
    if (index >= paths_.size() || paths_[index].leaf_light == kNoLeaf) return 0;
    const TreePath& path = paths_[index];
    const Node* node = &nodes_[0];
    float probability = 1;
    for (std::uint64_t bit_trail = path.bit_trail; node->count == 0; bit_trail >>= 1) {
        const float p_first = first_child_probability(*node, receiver);
        if (p_first < 0) return 0;
        probability *= bit_trail & 1 ? 1 - p_first : p_first;
        node = bit_trail & 1 ? &nodes_[node->first] : node + 1;
    }
    if (node->count == 1) return probability;
    float sum = 0, light_weight = 0;
    for (std::uint32_t i = node->first; i < node->first + node->count; ++i) {
        const float weight = irradiance_estimate(lights_[i].bounds, receiver);
        sum += weight;
        if (i == path.leaf_light) light_weight = weight;
    }
    return sum > 0 ? probability * (light_weight / sum) : 0.0f;
}

} // namespace duet
