// Converts the scene's lights to the form that one frame uses: floats relative to the eye.
#pragma once

#include "common/light/light.h"
#include "common/medium/medium.h"
#include "raster/gbuffer/screen_projection.h"
#include "raster/raster_scene.h"

#include <span>
#include <vector>

namespace duet::raster {

/// Represents a light in a form that one branch per light, not per pixel, can evaluate.
struct FrameLight {
    enum class Kind { kTriangle, kQuad, kSphere, kPoint, kSpot, kSun };

    Kind kind;
    std::size_t index = 0; ///< argument of RasterSceneData::light()
    Rgb emitted;           ///< radiance, W/(m² sr); intensity of a point or spot light, W/sr; irradiance of a sun, W/m²
    Vec3 position;         ///< corner of a flat light, center of a sphere, position of a point or spot light
    Vec3 u, v;             ///< edges of a flat light; its front is the side to which u × v points
    Vec3 axis;             ///< unit normal of a flat light, direction of a spot, direction toward a sun
    float radius = 0;      ///< radius of a sphere
    bool two_sided = false;
    bool diffuse_only = false; ///< whether the specular lobes see this light in the environment instead
    /// A spot's intensity rises from 0 at the cosine cos_outer to its full value at cos_outer + 1 / inverse_range.
    float cos_outer = -1, inverse_range = 0;

    explicit FrameLight(Kind kind_, Rgb emitted_ = {}) : kind(kind_), emitted(emitted_) {}
    bool flat() const { return kind == Kind::kTriangle || kind == Kind::kQuad; }
    /// Returns the middle of a light that is not a sun.
    Vec3 center() const {
        if (!flat()) return position;
        return position + (u + v) * (kind == Kind::kQuad ? 1.0f / 2 : 1.0f / 3);
    }
};

/// Returns `fraction` dimmed by the falloff of the spot's cone, for unit directions wi toward the spot.
inline Floats dimmed_by_cone(const FrameLight& spot, const Vec3T<Floats>& wi, const Floats& fraction) {
    const Floats cosine = -dot(wi, broadcast<Floats>(spot.axis)), three(3.0f);
    const Floats s = clamp((cosine - Floats(spot.cos_outer)) * Floats(spot.inverse_range), Floats(0.0f), Floats(1.0f));
    return fraction * s * s * (three - s - s);
}

/// Describes where a light lies, for points relative to the eye.
struct LightDirection {
    Vec3T<Floats> wi; ///< unit direction to the light's middle
    Floats distance;  ///< infinite for a sun
};
/// Returns the direction and the distance from points relative to the eye to the light's middle.
LightDirection direction_to(const FrameLight& light, const Vec3T<Floats>& p);

/// Converts the lights that emit, and leaves out black ones.
std::vector<FrameLight> frame_lights(std::span<const Light> lights, const ScreenProjection& projection);
/// Converts Scene::lights. Returns none if the settings leave direct light out.
std::vector<FrameLight> scene_lights(const RasterSceneData& data, const RasterSettings& settings,
                                     const ScreenProjection& projection);
/// Converts the environment's sun. Returns none if there is none or the settings leave the environment's light out.
std::vector<FrameLight> sun_lights(const RasterSceneData& data, const RasterSettings& settings,
                                   const ScreenProjection& projection);

/// Converts the scene's media, whose boxes become relative to the eye. Returns none if the settings leave media out.
std::vector<Medium> frame_media(std::span<const Medium> media, const RasterSettings& settings,
                                const ScreenProjection& projection);

} // namespace duet::raster
