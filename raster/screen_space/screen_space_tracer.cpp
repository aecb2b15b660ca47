#include "raster/screen_space/screen_space_tracer.h"

#include "common/scene/emitter_texture.h"
#include "raster/lighting/environment_light.h"
#include "raster/lighting/prefiltered_environment.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// Stores the distance to a light and the fraction of the lookup's footprint that it covers.
struct FootprintHit {
    float distance = kInfinity, fraction = 0;
};

/// Returns the covered fraction of a footprint of `width` meters, centered at the fraction x of a segment of this
/// length.
float covered_fraction(float x, float length, float width) {
    const auto side = [&](float to_edge) { return clamp(to_edge * length / width + 0.5f, 0.0f, 1.0f); };
    return side(x) * side(1 - x);
}

struct LightIntersector {
    Vec3 p, direction;
    const RayCone& cone;

    FootprintHit operator()(const Quad& quad) const {
        float distance, a, b;
        if (!meet(quad.corner, quad.u, quad.v, distance, a, b)) return {};
        const float wide = max(cone.size(distance), 1e-6f * distance);
        return {distance, covered_fraction(a, length(quad.u), wide) * covered_fraction(b, length(quad.v), wide)};
    }
    /// A triangle may be fraction of a larger light, so its edges are not blurred.
    FootprintHit operator()(const SurfaceLight::Triangle& t) const {
        float distance, a, b;
        if (!meet(t.a, t.b - t.a, t.c - t.a, distance, a, b) || a < 0 || b < 0 || a + b > 1) return {};
        return {distance, 1};
    }
    FootprintHit operator()(const Sphere& sphere) const {
        const Vec3 to = sphere.center - p;
        const float along = dot(to, direction), beside = length(to - direction * along);
        if (!(along > 0) || dot(to, to) < sqr(sphere.radius)) return {};
        const float wide = max(cone.size(along), 1e-6f * along);
        return {along - std::sqrt(max(sqr(sphere.radius) - sqr(beside), 0.0f)),
                clamp((sphere.radius - beside) / wide + 0.5f, 0.0f, 1.0f)};
    }

private:
    /// Intersects the ray with the plane through `corner`, and returns a and b of the point corner + a·u + b·v.
    bool meet(Vec3 corner, Vec3 u, Vec3 v, float& distance, float& a, float& b) const {
        const Vec3 n = cross(u, v), to = corner - p;
        const float towards = dot(n, direction);
        if (towards == 0) return false;
        distance = dot(n, to) / towards;
        if (!(distance > 1e-5f * length(to))) return false;
        const Vec3 q = direction * distance - to;
        const float over = 1 / dot(n, n);
        a = dot(cross(q, v), n) * over, b = dot(cross(u, q), n) * over;
        return true;
    }
};

} // namespace

ScreenSpaceTracer::ScreenSpaceTracer(const RasterSceneData& data, const RasterSettings& settings,
                                     const ReflectionSource& source)
    : data_(data), settings_(settings), source_(source), bounds_{source.image.to_eye_relative(data.scene.bounds.low),
                                                                 source.image.to_eye_relative(data.scene.bounds.high)} {
    const Vec3 slack = bounds_.diagonal() * 1e-4f; // for surfaces in the faces of the bounds
    bounds_ = {bounds_.low - slack, bounds_.high + slack};
}

/// Returns the nearest light in the lookup's footprint, regardless of occluders; fraction 0: none.
ScreenSpaceTracer::LightHit ScreenSpaceTracer::nearest_light(const RayCone& cone) const {
    const LightIntersector finder{source_.image.to_world_position(cone.p), cone.direction, cone};
    LightHit nearest;
    for (const std::size_t i : data_.reflected_lights) {
        const auto [distance, fraction] = std::visit(finder, std::get<SurfaceLight>(data_.scene.lights[i]).shape);
        if (fraction > 0 && distance < nearest.distance) nearest = {distance, fraction, i};
    }
    return nearest;
}

Rgb ScreenSpaceTracer::incoming_radiance(const RayCone& cone) const {
    float distance = kInfinity;
    if (!cone.include_lights) return image_or_environment(cone, false, distance);
    LightHit light_hit = nearest_light(cone);
    const Rgb behind = image_or_environment(cone, light_hit.fraction == 0, distance);
    if (light_hit.fraction == 0 || distance < light_hit.distance) return behind;
    const auto& light = std::get<SurfaceLight>(data_.scene.lights[light_hit.light]);
    const Vec3 p = source_.image.to_world_position(cone.p);
    if (!emits_towards(light, p)) return behind * (1 - light_hit.fraction); // the back of a light is black
    if (cone.point != nullptr && settings_.shadows)
        light_hit.fraction *= LightVisibility{data_.shadows.get(), {}}(light_hit.light, *cone.point);
    const Rgb shown = data_.scene.needs.emitter_textures
                          ? radiance_towards(data_.scene, light, p, cone.direction, light_hit.distance)
                          : light.radiance;
    return lerp(behind, shown, light_hit.fraction);
}

Rgb ScreenSpaceTracer::image_or_environment(const RayCone& cone, bool ignore_lights, float& distance) const {
    if (const auto hit =
            march_ray(source_, bounds_, {cone.p, cone.n, cone.direction, cone.from_visible_surface, ignore_lights})) {
        distance = hit->distance;
        if (const auto mirrored = reflection_behind_metal(cone, *hit)) return *mirrored;
        return image_color(cone, *hit, distance);
    }
    if (!shows_environment(data_, settings_)) return {};
    const Environment& environment = data_.scene.environment;
    const bool blurred = cone.alpha > 0 && settings_.prefiltered_environment && data_.prefiltered;
    return blurred ? data_.prefiltered->at(environment, cone.direction, cone.alpha)
                   : radiance(environment, cone.direction);
}

/// Returns the reflection of a metal sheet that is hit from behind. The visible front shows lights and sky that its
/// back does not reflect. For a second reflection the image's color is used. The result is empty for other surfaces.
std::optional<Rgb> ScreenSpaceTracer::reflection_behind_metal(const RayCone& cone, const ScreenHit& hit) const {
    if (cone.second_reflection || hit.hidden) return std::nullopt;
    const auto [x, y] = source_.image.pixel_at({hit.x, hit.y, 0});
    const ScreenGBuffer& gbuffer = source_.at(x, y);
    const std::uint32_t object = gbuffer.color_prepass().objects(x, y);
    if (object == kNoObject || data_.objects[object].closed) return std::nullopt;
    const std::optional<MetalBsdf>& metal = data_.objects[object].metal;
    const Vec3 n = gbuffer.normal(x, y);
    const float away = dot(n, cone.direction);
    if (!(away > 0) || !metal || metal->alpha > kMaxReflectionAlpha) return std::nullopt;
    RayCone again = cone;
    again.p = cone.p + cone.direction * hit.distance, again.n = -n,
    again.direction = normalize(cone.direction - n * (2 * away));
    again.width = cone.width + hit.distance * cone.divergence, again.point = nullptr;
    again.spread += reflection_blur(metal->alpha), again.alpha = min(cone.alpha + metal->alpha, 1.0f);
    again.from_visible_surface = false, again.second_reflection = true;
    float distance = kInfinity;
    return image_or_environment(again, false, distance) * metal->directional_albedo(away);
}

Rgb ScreenSpaceTracer::image_color(const RayCone& cone, const ScreenHit& hit, float& distance) const {
    const auto [x, y] = source_.image.pixel_at({hit.x, hit.y, 0});
    const float shown_depth = source_.at(x, y).depth(x, y); // the depth of a hit closer than the visible surface
    const float least = shown_depth < kInfinity ? shown_depth : source_.image.near();
    const float there = max(source_.image.homogeneous(cone.p + cone.direction * hit.distance)[2], least);
    const float pixel = source_.image.pixel_size(there),
                size = max(cone.size(hit.distance), kGuessBlur * hit.gap) / pixel;
    // The lookup must not be wider than the object that was hit. It must not be narrower than the blur of a rough
    // surface, which really includes adjacent objects, except for the mirror itself.
    const float blur = hit.distance * cone.spread / pixel;
    const float wide = hit.hidden ? size
                                  : max(source_.max_width_on_object(hit.x, hit.y, size),
                                        source_.max_width_without_own(hit.x, hit.y, blur));
    const ScreenGBuffer& gbuffer = source_.about(hit.x, hit.y, wide);
    const ScreenGBuffer::ColorPrepass& shown = gbuffer.color_prepass();
    // Next to a light, the light is composited with its exact edge (incoming_radiance). Blurring it in the image would
    // add a halo, which would end abruptly where the hit is a guess.
    const bool shows_light = shown.light_mask(x, y) != 0;
    if (shows_light) // the light does not occlude itself
        distance = kInfinity;
    else // the hit may be up to a pixel farther than its center; next to a light, it is the light
        distance = hit.distance + pixel;
    if (const RadiancePyramid& flat = gbuffer.flat_radiance(); hit.hidden && !flat.empty())
        return flat.at(hit.x, hit.y, wide);
    const bool include_lights = cone.include_lights && hit.gap == 0 && (shows_light || data_.unreflected_lights > 0);
    const RadiancePyramid& radiance_pyramid = include_lights ? shown.radiance : shown.radiance_without_lights;
    const bool between_objects = wide <= 1 && !source_.shows_one_object(hit.x, hit.y, 0.5f); // between pixels
    return between_objects ? radiance_pyramid.finest()(x, y) : radiance_pyramid.at(hit.x, hit.y, wide);
}

} // namespace duet::raster
