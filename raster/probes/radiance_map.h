// Stores the radiance that arrives at a point from all directions, prefiltered for rough reflections. It is the first
// factor of the split sum (Karis 2013, "Real Shading in Unreal Engine 4").
#pragma once

#include "raster/shader/octahedral_map.h"

#include "common/image/rgb.h"

#include <functional>

namespace duet::raster {

/// Holds octahedral maps for several widths of the GGX lobe. The first is sharp; the k-th of the others is filtered by
/// the lobe of roughness k / kLevels about each direction, with viewer and normal on the lobe's axis.
class RadianceMap {
public:
    static constexpr int kLevels = 5;
    /// This is the distance of the background, in meters. It exceeds all coordinates, and its square is still a finite
    /// float.
    static constexpr float kFarthest = 4e18f;

    RadianceMap() = default;
    /// Holds the radiance from one direction, and the distance in meters of the surface that it comes from.
    struct Arriving {
        Rgb radiance;
        float distance = kInfinity;
    };
    using Source = std::function<Arriving(Vec3)>; ///< its argument is a unit direction
    /// Samples and filters `without_lights`, the radiance without visible lights, at side × side texels (a power of 2,
    /// at least 8). Lights are left out because their reflections on rough surfaces are direct light. `with_lights` is
    /// the radiance that mirrors show; it may be empty if there are no lights. The result is the same for any number of
    /// threads.
    RadianceMap(int side, const Source& without_lights, const Source& with_lights, int threads);

    /// Returns the radiance without lights, filtered by lobes of GGX width alpha about directions of any length.
    RgbT<Floats> at(const Vec3T<Floats>& axis, const Floats& alpha) const;
    /// Returns the harmonic mean of the surfaces' distances in these lobes, which background does not make infinite.
    Floats distance(const Vec3T<Floats>& axis, const Floats& alpha) const;
    /// Returns the unfiltered radiance with lights, in directions of any length.
    RgbT<Floats> at(const Vec3T<Floats>& w) const;
    bool has_lights() const { return !bright_.empty(); }
    /// Returns the distance of the visible surface in directions of any length, with or without lights.
    Floats distance(const Vec3T<Floats>& w, bool lights) const {
        return Floats(1.0f) / (lights && has_lights() ? bright_ : sharp_).nearest<1>(w, kInverseDistance)[0];
    }
    std::size_t memory_bytes() const;

private:
    static constexpr std::size_t kInverseDistance = 3; ///< the channel after those of the radiance; unit: 1/m
    template <std::size_t kCount>
    std::array<Floats, kCount> lookup(const Vec3T<Floats>& axis, const Floats& alpha, std::size_t first) const;

    OctahedralMap sharp_, bright_;             ///< unfiltered, without and with lights; bright_ may be empty
    std::array<OctahedralMap, kLevels> rough_; ///< rough_[k] has roughness (k + 1) / kLevels
};

/// Returns the dominant direction of a GGX lobe: between the mirrored direction and the normal, and nearer to the
/// normal the rougher the surface (Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
/// §4.9.3). The vectors are unit; the result is not.
template <typename T> Vec3T<T> dominant_direction(const Vec3T<T>& normal, const Vec3T<T>& mirrored, const T& alpha) {
    const T smooth = T(1) - alpha;
    return lerp(normal, mirrored, smooth * (sqrt(smooth) + alpha));
}

} // namespace duet::raster
