// Converts the scene's lights to what shading models use: one incident direction per light, for one point or a SIMD
// batch.
#pragma once

#include "common/light/light.h"
#include "raster/visibility/shader.h"

namespace duet::raster {

/// Holds the light that arrives at a point from one light.
template <typename T> struct IncidentT {
    Vec3T<T> wi;        ///< unit, toward the light
    RgbT<T> irradiance; ///< on a surface facing the light, without occlusion
};

/// Approximates a surface light by a distant light in the direction of its center. The irradiance is that at p on a
/// surface facing this direction. The result is black if p is the center itself.
IncidentT<float> as_distant(const SurfaceLight& light, Vec3 p);

/// Returns the incident light at a world-space point, for any light but a sun. An area light is approximated by a
/// distant light of equal irradiance in the direction of its center.
template <typename T> IncidentT<T> incident(const Light& light, Vec3T<T> p) {
    const auto from = [&](Vec3 position, Rgb intensity) -> IncidentT<T> {
        const Vec3T<T> to_light = broadcast<T>(position) - p;
        const T squared = dot(to_light, to_light);
        return {to_light * inverse_sqrt(squared), broadcast<T>(intensity) * (T(1) / squared)};
    };
    if (const auto* point = std::get_if<PointLight>(&light)) return from(point->position, point->intensity);
    if (const auto* spot = std::get_if<SpotLight>(&light)) {
        IncidentT<T> result = from(spot->position, spot->intensity);
        result.irradiance *= spot_falloff(*spot, -dot(result.wi, broadcast<T>(spot->direction)));
        return result;
    }
    const auto& surface = std::get<SurfaceLight>(light);
    if constexpr (std::same_as<T, float>) {
        return as_distant(surface, p);
    } else {
        Vec3T<PacketOf<float>> points, wi;
        RgbT<PacketOf<float>> irradiance;
        store(points.x, 0, p.x), store(points.y, 0, p.y), store(points.z, 0, p.z);
        for (std::size_t i = 0; i < T::size; ++i) {
            const IncidentT<float> one = as_distant(surface, Vec3(points.x[i], points.y[i], points.z[i]));
            wi.x[i] = one.wi.x, wi.y[i] = one.wi.y, wi.z[i] = one.wi.z;
            irradiance.r[i] = one.irradiance.r, irradiance.g[i] = one.irradiance.g, irradiance.b[i] = one.irradiance.b;
        }
        return {{load(wi.x, 0), load(wi.y, 0), load(wi.z, 0)},
                {load(irradiance.r, 0), load(irradiance.g, 0), load(irradiance.b, 0)}};
    }
}

/// Returns the incident light of a sun, which is the same everywhere.
template <typename T> IncidentT<T> incident(const SunLight& sun) {
    return {-broadcast<T>(sun.direction), broadcast<T>(sun.irradiance)};
}

/// Calls use(IncidentT<T>) for each light, at the world-space point returned by position(). position() is not called
/// for suns, whose light is the same everywhere.
template <typename Position, typename Use>
void for_each_incident(std::span<const Light> lights, const Position& position, const Use& use) {
    using T = decltype(position().x);
    for (const Light& light : lights) {
        if (const auto* sun = std::get_if<SunLight>(&light))
            use(incident<T>(*sun));
        else
            use(incident<T>(light, position()));
    }
}

} // namespace duet::raster
