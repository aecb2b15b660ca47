#include "raster/screen/surroundings.h"

#include "common/scene/lamp_texture.h"
#include "raster/light/environment_light.h"
#include "raster/light/prefiltered.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// Stores the distance to a light and the fraction of the lookup's footprint that it covers.
struct Met {
    float distance = kInfinity, part = 0;
};

/// Returns the covered fraction of a footprint of `width` meters, centered at the fraction x of a segment of this
/// length.
float part_within(float x, float length, float width) {
    const auto side = [&](float to_edge) { return clamp(to_edge * length / width + 0.5f, 0.0f, 1.0f); };
    return side(x) * side(1 - x);
}

struct LampFinder {
    Vec3 p, way;
    const Look& look;

    Met operator()(const Quad& quad) const {
        float distance, a, b;
        if (!meet(quad.corner, quad.u, quad.v, distance, a, b)) return {};
        const float wide = max(look.size(distance), 1e-6f * distance);
        return {distance, part_within(a, length(quad.u), wide) * part_within(b, length(quad.v), wide)};
    }
    /// A triangle may be part of a larger light, so its edges are not blurred.
    Met operator()(const SurfaceLight::Triangle& t) const {
        float distance, a, b;
        if (!meet(t.a, t.b - t.a, t.c - t.a, distance, a, b) || a < 0 || b < 0 || a + b > 1) return {};
        return {distance, 1};
    }
    Met operator()(const Sphere& sphere) const {
        const Vec3 to = sphere.center - p;
        const float along = dot(to, way), beside = length(to - way * along);
        if (!(along > 0) || dot(to, to) < sqr(sphere.radius)) return {};
        const float wide = max(look.size(along), 1e-6f * along);
        return {along - std::sqrt(max(sqr(sphere.radius) - sqr(beside), 0.0f)),
                clamp((sphere.radius - beside) / wide + 0.5f, 0.0f, 1.0f)};
    }

private:
    /// Intersects the ray with the plane through `corner`, and returns a and b of the point corner + a·u + b·v.
    bool meet(Vec3 corner, Vec3 u, Vec3 v, float& distance, float& a, float& b) const {
        const Vec3 n = cross(u, v), to = corner - p;
        const float towards = dot(n, way);
        if (towards == 0) return false;
        distance = dot(n, to) / towards;
        if (!(distance > 1e-5f * length(to))) return false;
        const Vec3 q = way * distance - to;
        const float over = 1 / dot(n, n);
        a = dot(cross(q, v), n) * over, b = dot(cross(u, q), n) * over;
        return true;
    }
};

} // namespace

Surroundings::Surroundings(const PreparedData& data, const Settings& settings, const Scenery& scenery)
    : data_(data), settings_(settings), scenery_(scenery),
      bounds_{scenery.all.relative(data.scene.bounds.low), scenery.all.relative(data.scene.bounds.high)} {
    const Vec3 slack = bounds_.diagonal() * 1e-4f; // for surfaces in the faces of the bounds
    bounds_ = {bounds_.low - slack, bounds_.high + slack};
}

/// Returns the nearest light in the lookup's footprint, regardless of occluders; fraction 0: none.
Surroundings::LampSeen Surroundings::nearest_lamp(const Look& look) const {
    const LampFinder finder{scenery_.all.absolute(look.p), look.way, look};
    LampSeen nearest;
    for (const std::size_t i : data_.lamps) {
        const auto [distance, part] = std::visit(finder, std::get<SurfaceLight>(data_.scene.lights[i]).shape);
        if (part > 0 && distance < nearest.distance) nearest = {distance, part, i};
    }
    return nearest;
}

Rgb Surroundings::seen(const Look& look) const {
    float distance = kInfinity;
    if (!look.lamps) return picture_or_environment(look, false, distance);
    LampSeen lamp = nearest_lamp(look);
    const Rgb behind = picture_or_environment(look, lamp.part == 0, distance);
    if (lamp.part == 0 || distance < lamp.distance) return behind;
    const auto& light = std::get<SurfaceLight>(data_.scene.lights[lamp.light]);
    const Vec3 p = scenery_.all.absolute(look.p);
    if (!emits_towards(light, p)) return behind * (1 - lamp.part); // the back of a light is black
    if (look.point != nullptr && settings_.shadows)
        lamp.part *= Visibility{data_.shadows.get(), {}}(lamp.light, *look.point);
    const Rgb shown = data_.scene.needs.lamp_textures ? radiance_towards(data_.scene, light, p, look.way, lamp.distance)
                                                      : light.radiance;
    return lerp(behind, shown, lamp.part);
}

Rgb Surroundings::picture_or_environment(const Look& look, bool past_lamps, float& distance) const {
    if (const auto hit = trace_screen(scenery_, bounds_, {look.p, look.n, look.way, look.from_picture, past_lamps})) {
        distance = hit->distance;
        if (const auto mirrored = behind_metal(look, *hit)) return *mirrored;
        return picture(look, *hit, distance);
    }
    if (!shows_environment(data_, settings_)) return {};
    const Environment& environment = data_.scene.environment;
    const bool blurred = look.alpha > 0 && settings_.prefiltered_environment && data_.prefiltered;
    return blurred ? data_.prefiltered->at(environment, look.way, look.alpha) : radiance(environment, look.way);
}

/// Returns the reflection of a metal sheet that is hit from behind. The visible front shows lights and sky that its
/// back does not reflect. For a second reflection the image's color is used. The result is empty for other surfaces.
std::optional<Rgb> Surroundings::behind_metal(const Look& look, const ScreenHit& hit) const {
    if (look.mirrored_again || hit.hidden) return std::nullopt;
    const auto [x, y] = scenery_.all.pixel_at({hit.x, hit.y, 0});
    const Screen& screen = scenery_.at(x, y);
    const std::uint32_t object = screen.first_look().objects(x, y);
    if (object == kNoObject || data_.objects[object].closed) return std::nullopt;
    const std::optional<MetalBsdf>& metal = data_.objects[object].metal;
    const Vec3 n = screen.normal(x, y);
    const float away = dot(n, look.way);
    if (!(away > 0) || !metal || metal->alpha > kRoughestMirror) return std::nullopt;
    Look again = look;
    again.p = look.p + look.way * hit.distance, again.n = -n, again.way = normalize(look.way - n * (2 * away));
    again.width = look.width + hit.distance * look.turn, again.point = nullptr;
    again.spread += blur_mirrored(metal->alpha), again.alpha = min(look.alpha + metal->alpha, 1.0f);
    again.from_picture = false, again.mirrored_again = true;
    float distance = kInfinity;
    return picture_or_environment(again, false, distance) * metal->albedo(away);
}

Rgb Surroundings::picture(const Look& look, const ScreenHit& hit, float& distance) const {
    const auto [x, y] = scenery_.all.pixel_at({hit.x, hit.y, 0});
    const float shown_depth = scenery_.at(x, y).depth(x, y); // the depth of a hit closer than the visible surface
    const float least = shown_depth < kInfinity ? shown_depth : scenery_.all.near();
    const float there = max(scenery_.all.homogeneous(look.p + look.way * hit.distance)[2], least);
    const float pixel = scenery_.all.pixel_size(there),
                size = max(look.size(hit.distance), kGuessBlur * hit.gap) / pixel;
    // The lookup must not be wider than the object that was hit. It must not be narrower than the blur of a rough
    // surface, which really includes adjacent objects, except for the mirror itself.
    const float blur = hit.distance * look.spread / pixel;
    const float wide = hit.hidden ? size
                                  : max(scenery_.width_within(hit.x, hit.y, size),
                                        scenery_.width_beside_own(hit.x, hit.y, blur));
    const Screen& screen = scenery_.about(hit.x, hit.y, wide);
    const Screen::FirstLook& shown = screen.first_look();
    // Next to a light, the light is composited with its exact edge (seen). Blurring it in the image would add a halo,
    // which would end abruptly where the hit is a guess.
    const bool is_lamp = shown.lamps(x, y) != 0;
    if (is_lamp) // the light does not occlude itself
        distance = kInfinity;
    else // the hit may be up to a pixel farther than its center; next to a light, it is the light
        distance = hit.distance + pixel;
    if (const RadiancePyramid& flat = screen.flat_look(); hit.hidden && !flat.empty())
        return flat.at(hit.x, hit.y, wide);
    const bool lamps = look.lamps && hit.gap == 0 && (is_lamp || data_.unmirrored_lamps > 0);
    const RadiancePyramid& radiance_seen = lamps ? shown.radiance : shown.without_lamps;
    const bool sees_another = wide <= 1 && !scenery_.one_object(hit.x, hit.y, 0.5f); // between pixels
    return sees_another ? radiance_seen.finest()(x, y) : radiance_seen.at(hit.x, hit.y, wide);
}

} // namespace duet::raster
