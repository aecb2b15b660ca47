// Finds the lights that reach a cluster of surfaces (Olsson, Billeter and Assarsson 2012, "Clustered Deferred and
// Forward Shading"), and sums those that are too far for their places to matter.
#pragma once

#include "raster/lighting/frame_lights.h"
#include "raster/lighting/light_clusters.h"
#include "raster/shadows/shadow_lookup.h"

namespace duet::raster {

/// Holds the irradiance from distant lights together, as a vector per color (Gershun 1939, "The Light Field") that is
/// linear in the position. If no light is below the horizon, the irradiance is exactly the vector's dot product with
/// the normal.
struct LightField {
    Vec3 center, inverse_extent;
    std::array<std::array<Vec3, 4>, 3> colors{}; ///< per color the vector at the center, and its change per extent

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

/// Holds how lights reach a cluster. It may be reused, which saves allocations.
struct LightsOfCluster {
    std::vector<std::uint32_t> near, far; ///< columns of a LightSet; `field` holds the irradiance of the far ones
    LightField field;
    std::vector<float, HugePageAllocator<float>> most;  ///< about the lights' greatest irradiance, by column
    std::vector<float, HugePageAllocator<float>> error, distant; ///< scratch memory, one number per light
};

/// Refers to a light that stands for several.
struct WeightedLight {
    std::uint32_t index; ///< among the frame's lights
    float weight;
};

/// Holds bounds of lights as a structure of arrays.
class LightSet {
public:
    /// A field takes longer than it saves for so few lights, and would show where clusters meet.
    static constexpr std::size_t kFewLights = 16;
    /// Greatest error of the field for one light, as a fraction of the irradiance at the cluster's center.
    static constexpr float kError = 1.0f / 512;

    LightSet() = default;
    /// Lights that `shadows`, which may be null, shadows one by one never count as far. None does unless `sums`.
    LightSet(std::span<const FrameLight> lights, const ShadowLookup* shadows, bool sums = true);
    /// Makes this a copy of the given columns of another set.
    void assign(const LightSet& other, std::span<const std::uint32_t> columns);

    /// Returns the lights' indices among the frame's lights.
    std::span<const std::uint32_t> lights() const { return lights_; }
    std::size_t size() const { return lights_.size(); }

    /// Finds the lights that reach a cluster. A light is left out only where it gives no light: where it is behind all
    /// surfaces or faces away from them, or its cone misses them.
    ///
    /// Many lights are divided into near and far. Lights have no end, so all of them reach every cluster, and together
    /// the distant ones may outshine the near ones; but their sum varies slowly. A light is far if it is above the
    /// horizon of all surfaces and the error of a linear field is small enough. `other_irradiance` is the irradiance
    /// from lights that are not in the set.
    void reach(const SurfaceBounds& surfaces, float other_irradiance, LightsOfCluster& result) const;

    /// Returns the near lights of a cluster or, if there are more than `most`, about that many of them: each in
    /// proportion to its greatest irradiance, and weighted so that the expected light is the same, for `u` uniform in
    /// [0, 1) (systematic sampling; Shirley, Wang and Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting").
    void choose(const LightsOfCluster& cluster, std::size_t most, float u, std::vector<WeightedLight>& result) const;

private:
    enum Row {
        kLowX,
        kLowY,
        kLowZ,
        kHighX,
        kHighY,
        kHighZ, ///< box around the light
        kAxisX,
        kAxisY,
        kAxisZ,
        kPlane, ///< front: axis·p > plane
        kConeCosine,
        kConeSine,  ///< of a spot's outer angle; both 0 for others
        kRadius,    ///< of the box
        kIntensity, ///< W/sr, as in common/light/light_bounds.h; 0 in unused columns
        kMost,      ///< greatest irradiance, W/m²
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
