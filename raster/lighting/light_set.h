// Finds the lights that reach a cluster of surfaces (Olsson, Billeter and Assarsson 2012, "Clustered Deferred and
// Forward Shading"), and sums those that are so far away that a linear field represents them.
#pragma once

#include "raster/lighting/frame_lights.h"
#include "raster/lighting/light_clusters.h"
#include "raster/shadows/light_visibility.h"

namespace duet::raster {

/// Represents the sum of distant lights as one irradiance vector per color channel (Gershun 1939, "The Light Field"),
/// which is linear in the position. If no light is below the horizon, the irradiance is exactly the vector's dot
/// product with the normal.
struct LightField {
    Vec3 center, inverse_extent;
    std::array<std::array<Vec3, 4>, 3> colors{}; ///< per channel the vector at the center, and its change per extent

    template <typename T> RgbT<T> irradiance(const Vec3T<T>& p, const Vec3T<T>& n) const {
        const Vec3T<T> q = (p - broadcast<T>(center)) * broadcast<T>(inverse_extent);
        const auto channel = [&](const std::array<Vec3, 4>& v) {
            const auto axis = [&](float Vec3::*c) {
                return multiply_add(T(v[1].*c), q.x,
                                    multiply_add(T(v[2].*c), q.y, multiply_add(T(v[3].*c), q.z, T(v[0].*c))));
            };
            return max(T(dot(Vec3T<T>(axis(&Vec3::x), axis(&Vec3::y), axis(&Vec3::z)), n)), T(0));
        };
        return {channel(colors[0]), channel(colors[1]), channel(colors[2])};
    }
};

/// Holds the lights that reach a cluster. Reusing the object saves allocations.
struct LightsOfCluster {
    std::vector<std::uint32_t> near, far; ///< columns of a LightSet; `field` holds the irradiance of the far ones
    LightField field;
    std::vector<float, HugePageAllocator<float>> most;  ///< approximate bound of a light's irradiance, by column
    std::vector<float, HugePageAllocator<float>> error, distant; ///< scratch memory, one number per light
};

/// Refers to a light, whose weight accounts for the lights that were not chosen.
struct WeightedLight {
    std::uint32_t index; ///< index into the frame's lights
    float weight;
};

/// Holds bounds of lights as a structure of arrays.
class LightSet {
public:
    /// For so few lights, a field costs more time than it saves, and cluster borders would be visible.
    static constexpr std::size_t kFewLights = 16;
    /// This bounds the field's error per light, as a fraction of the irradiance at the cluster's center.
    static constexpr float kError = 1.0f / 512;

    LightSet() = default;
    /// `shadows` may be null. Lights with shadow maps never count as far, and no light does if `sums` is false.
    LightSet(std::span<const FrameLight> lights, const LightVisibility* shadows, bool sums = true);
    /// Replaces this set by the given columns of another set.
    void assign(const LightSet& other, std::span<const std::uint32_t> columns);

    /// Returns the lights' indices among the frame's lights.
    std::span<const std::uint32_t> lights() const { return lights_; }
    std::size_t size() const { return lights_.size(); }

    /// Finds the lights that reach a cluster. A light is left out only if it contributes nothing: it is behind all
    /// surfaces or faces away from them, or its cone misses them.
    ///
    /// If there are many lights, they are divided into near and far ones. Light has no maximum range, so all lights
    /// reach every cluster, and the distant ones together may outshine the near ones, but their sum varies slowly. A
    /// light is far if it is above the horizon of all surfaces and the error of a linear field is small enough.
    /// `other_irradiance` is the irradiance from lights that are not in the set.
    void reach(const SurfaceBounds& surfaces, float other_irradiance, LightsOfCluster& result) const;

    /// Returns the near lights of a cluster. If there are more than `most`, it chooses about `most` of them, with
    /// probabilities in proportion to the bounds of their irradiance, and weights them so that the expected light is
    /// unchanged. `u` is uniform in [0, 1) (systematic sampling; Shirley, Wang and Zimmerman 1996, "Monte Carlo
    /// Techniques for Direct Lighting").
    void choose(const LightsOfCluster& cluster, std::size_t most, float u, std::vector<WeightedLight>& result) const;

private:
    enum Row {
        kLowX,
        kLowY,
        kLowZ,
        kHighX,
        kHighY,
        kHighZ, ///< last coordinate of the box around the light
        kAxisX,
        kAxisY,
        kAxisZ,
        kPlane, ///< points with axis·p > plane are in front
        kConeCosine,
        kConeSine,  ///< sine of a spot's outer angle; sine and cosine are 0 for other lights
        kRadius,    ///< radius of the box
        kIntensity, ///< intensity, W/sr (common/light/light_bounds.h); 0 in unused columns
        kMost,      ///< upper bound of the irradiance, W/m²
        kRed,
        kGreen,
        kBlue, ///< intensity in W/sr, or 0 if the light never counts as far
        kRows
    };
    void resize(std::size_t count);
    const float* row(int r) const { return bounds_.data() + static_cast<std::size_t>(r) * stride_; }
    float* row(int r) { return bounds_.data() + static_cast<std::size_t>(r) * stride_; }
    LightField sum(const SurfaceBounds& surfaces, std::span<const float> distant) const;

    std::vector<std::uint32_t> lights_;
    std::size_t stride_ = 0;
    std::vector<float, HugePageAllocator<float>> bounds_; ///< kRows rows with a column per light, and padding
};

} // namespace duet::raster
