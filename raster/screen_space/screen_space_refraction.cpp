#include "raster/screen_space/screen_space_refraction.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// Refracts a ray from inside at a boundary with the outward normal n; eta is the index inside over outside. The
/// result is empty at total internal reflection.
std::optional<Vec3> refract_out(Vec3 direction, Vec3 n, float eta) {
    const float cosine = dot(direction, n), squared = 1 - sqr(eta) * (1 - sqr(cosine));
    if (!(squared > 0)) return std::nullopt;
    return normalize(direction * eta + n * (std::sqrt(squared) - eta * cosine));
}

constexpr float kTouching = 1e-3f; ///< relative to the depth: a surface within this distance touches the glass
/// This is a heuristic angle in radians by which neighboring rays diverge if their paths through glass differ.
constexpr float kDivergence = 0.3f;

/// Returns whether the surface at a pixel is convex, according to its neighbors' normals.
bool is_convex(const ScreenGBuffer& gbuffer, int x, int y) {
    const std::optional<Vec3> here = gbuffer.visible_point(x, y);
    float sum = 0;
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
        if (const auto there = gbuffer.visible_point(x + dx, y + dy); here && there)
            sum += dot(gbuffer.normal(x + dx, y + dy) - gbuffer.normal(x, y), *there - *here);
    return sum >= 0;
}

/// Returns the blur angle of GGX alpha through two boundaries: a slope deflects a refracted ray by η − 1 times its
/// angle.
float refraction_blur(float eta, float alpha) { return 2.8f * std::abs(eta - 1) * alpha; }

} // namespace

bool is_glass(const RasterSceneData& data, std::uint32_t object) {
    return std::binary_search(data.glass.begin(), data.glass.end(), object);
}

ScreenSpaceRefraction::ScreenSpaceRefraction(const RasterSceneData& data, const RasterSettings& settings,
                                             const ScreenGBuffer& gbuffer, const ShadingPoint& point)
    : data_(data), gbuffer_(gbuffer), point_(point), source_{gbuffer, gbuffer.behind(), point.surface.object},
      tracer_(data, settings, source_), p_(gbuffer.to_eye_relative(point.surface.p)),
      size_(length(data.objects[point.surface.object].bounds.diagonal())) {
    const Vec3 projected = gbuffer.project(p_);
    if (!(projected.z > 0)) return;
    const auto [x, y] = gbuffer.pixel_at(projected);
    width_ = gbuffer.pixel_size(projected.z);
    normal_angle_ = is_convex(gbuffer, x, y) ? gbuffer.normal_angle(x, y) : -gbuffer.normal_angle(x, y);
}

/// Returns the reflection at the front surface.
Rgb ScreenSpaceRefraction::reflection(Vec3 direction, float alpha, bool include_lights) const {
    return tracer_.incoming_radiance({.p = p_,
                                      .n = point_.ng,
                                      .direction = direction,
                                      .width = width_,
                                      .divergence = 2 * normal_angle_,
                                      .spread = reflection_blur(alpha),
                                      .alpha = alpha,
                                      .include_lights = include_lights,
                                      .point = &point_,
                                      .from_visible_surface = false});
}

Rgb ScreenSpaceRefraction::boundary(const DielectricBsdf& bsdf, float alpha) const {
    Rgb sum;
    for (const bool transmitted : {false, true}) {
        // TransportMode::kImportance omits the factor η² of radiance inside the medium, which cancels on leaving it.
        const float lobe = transmitted ? kOneMinusEpsilon : 0.0f;
        const auto sample = bsdf.sample(point_.wo, lobe, {0.5f, 0.5f}, TransportMode::kImportance);
        if (!sample || sample->transmitted != transmitted) continue;
        const Vec3 direction = normalize(point_.frame.to_world(sample->wi));
        if (point_.receives(direction) == transmitted) continue; // the geometric and the shading normal disagree
        if (!transmitted)
            sum += reflection(direction, alpha, alpha == 0) * sample->weight * sample->pdf;
        else if (point_.wo.z < 0) // seen from inside
            sum += tracer_.incoming_radiance({.p = p_,
                                              .n = -point_.ng,
                                              .direction = direction,
                                              .width = width_,
                                              .divergence = (bsdf.eta - 1) * normal_angle_,
                                              .spread = refraction_blur(bsdf.eta, alpha),
                                              .alpha = alpha,
                                              .from_visible_surface = false}) *
                   sample->weight * sample->pdf;
        else
            sum += through(direction, bsdf.eta, alpha) * sample->pdf;
    }
    return sum;
}

Rgb ScreenSpaceRefraction::through(Vec3 direction, float eta, float alpha) const {
    const auto& glass = std::get<Dielectric>(data_.scene.materials[point_.surface.material]);
    const Rgb tint = glass.at(data_.scene.textures, point_.surface).tint;
    const Segment exit_segment = trace_inside(direction, eta);
    // A convex side makes neighboring rays converge, as in a thick symmetric lens.
    const float bend = (1 - 1 / eta) * normal_angle_,
                divergence = static_cast<float>(exit_segment.divergences) * kDivergence;
    const auto transmittance = [&](float absorption) { return std::exp(-exit_segment.inside * absorption); };
    const std::optional<Rgb> inner_hit = hit_inside(exit_segment.p);
    SurfacePoint exit = point_.surface; // the point at which shadow maps are sampled for visible lights
    exit.p = gbuffer_.to_world_position(exit_segment.p);
    exit.ng = exit.ns = exit.terminator_normal = exit_segment.n;
    exit.terminator_offset = {};
    const ShadingPoint leaves(exit, exit_segment.n);
    const RayCone cone{.p = exit_segment.p,
                       .n = exit_segment.n,
                       .direction = exit_segment.direction,
                       .width = width_ - exit_segment.inside * bend,
                       .divergence = -2 * bend,
                       .spread = divergence + refraction_blur(eta, alpha),
                       .alpha = alpha,
                       .include_lights = exit_segment.divergences == 0,
                       .point = &leaves,
                       .from_visible_surface = false};
    const Rgb light = inner_hit ? *inner_hit : tracer_.incoming_radiance(cone);
    return light * tint * tint *
           Rgb(transmittance(glass.absorption.r), transmittance(glass.absorption.g), transmittance(glass.absorption.b));
}

/// Returns the radiance of a surface inside the glass, or touching it where the ray would leave.
std::optional<Rgb> ScreenSpaceRefraction::hit_inside(Vec3 p) const {
    const Vec3 projected = gbuffer_.project(p);
    if (!(projected.z > 0) || !gbuffer_.contains(projected.x, projected.y)) return std::nullopt;
    const auto [x, y] = gbuffer_.pixel_at(projected);
    const ScreenGBuffer& behind = source_.at(x, y);
    const float depth = behind.depth(x, y);
    if (!(depth <= projected.z * (1 + kTouching)) || !(layer(x, y).depth(x, y) < depth)) return std::nullopt;
    return behind.color_prepass().radiance.at(projected.x, projected.y, 1);
}

/// Follows the ray from its entry to its exit, or to the last known point.
ScreenSpaceRefraction::Segment ScreenSpaceRefraction::trace_inside(Vec3 direction, float eta) const {
    Segment at{.p = p_, .direction = direction, .n = direction};
    const bool is_sphere =
        std::holds_alternative<Sphere>(data_.scene.shapes[data_.scene.objects[point_.surface.object].shape]);
    for (int i = 0; i < kSegments; ++i) {
        const std::optional<Segment> next = is_sphere ? across_sphere(at) : across_back_faces(at);
        if (!next) break;
        at = *next;
        if (const auto out = refract_out(at.direction, at.n, eta)) {
            at.direction = *out;
            return at;
        }
        at.direction = normalize(at.direction - at.n * (2 * dot(at.direction, at.n)));
        ++at.divergences;
    }
    at.n = at.direction;
    return at;
}

std::optional<ScreenSpaceRefraction::Segment> ScreenSpaceRefraction::across_sphere(const Segment& from) const {
    const Object& object = data_.scene.objects[point_.surface.object];
    const ObjectTransform transform = object_transform(object, point_.surface.time);
    const Sphere& sphere = std::get<Sphere>(data_.scene.shapes[object.shape]);
    const Vec3 p = transform_point(transform.to_object, gbuffer_.to_world_position(from.p)) - sphere.center,
               direction = transform_vector(transform.to_object, from.direction);
    const float t = -2 * dot(p, direction) / dot(direction, direction); // the ray starts on the sphere
    if (!(t > 0)) return std::nullopt;
    const Vec3 n = transform_normal(transform.to_object, p + direction * t);
    return Segment{.p = from.p + from.direction * t,
                   .direction = from.direction,
                   .n = normalize(n),
                   .inside = from.inside + t,
                   .divergences = from.divergences};
}

/// Returns the glass layer with this object at a pixel. Where another glass object partly covers it, the covered and
/// uncovered pixels are in different layers.
const ScreenGBuffer& ScreenSpaceRefraction::layer(int x, int y) const {
    for (const ScreenGBuffer* layer = &gbuffer_.front(); layer->back_faces() != nullptr; layer = layer->behind())
        if (layer->color_prepass().objects(x, y) == point_.surface.object) return *layer;
    return gbuffer_;
}

std::optional<ScreenSpaceRefraction::Segment> ScreenSpaceRefraction::across_back_faces(const Segment& from) const {
    const bool deeper = gbuffer_.homogeneous_change(from.direction)[2] > 0;
    float t = 0;
    Vec3 n;
    bool found = false;
    for (int i = 0; i < kSteps && !found; ++i) {
        const Vec3 projected = gbuffer_.project(from.p + from.direction * t);
        if (!(projected.z > 0)) return std::nullopt;
        const auto [x, y] = gbuffer_.pixel_at(projected);
        const ScreenGBuffer& shown = layer(x, y);
        const ScreenGBuffer& far = deeper ? *shown.back_faces() : shown;
        const std::optional<Vec3> seen = far.visible_point(x, y);
        if (!seen) { // outside the silhouette: go back halfway
            if (i == 0) return std::nullopt;
            t *= 0.5f;
            continue;
        }
        n = far.normal(x, y);
        if (dot(n, from.direction) < 0) n = -n;
        const Vec3 to = *seen - from.p;
        const float along = dot(n, to) / max(dot(n, from.direction), 0.2f); // limits extrapolation at grazing angles
        const float next = clamp(along > 0 ? along : length(to), 0.0f, size_);
        found = std::abs(next - t) < width_;
        t = next;
    }
    return Segment{.p = from.p + from.direction * t,
                   .direction = from.direction,
                   .n = n,
                   .inside = from.inside + t,
                   .divergences = from.divergences + !found};
}

/// Returns the reflection reflection and the undeviated transmission. A closed sheet has two sides along the ray, with
/// multiple reflections between them.
Rgb ScreenSpaceRefraction::operator()(const ThinDielectricBsdf& bsdf) const {
    const ThinDielectricBsdf::Fractions fractions = bsdf.fractions(std::abs(point_.wo.z));
    const Object& object = data_.scene.objects[point_.surface.object];
    const Shape& shape = data_.scene.shapes[object.shape];
    const auto* mesh = std::get_if<Mesh>(&shape);
    const bool closed = std::holds_alternative<Sphere>(shape) || (mesh != nullptr && mesh->closed);
    const Vec3 straight = point_.frame.to_world(-point_.wo),
               mirrored = point_.frame.to_world({-point_.wo.x, -point_.wo.y, point_.wo.z});
    Rgb transmitted = fractions.transmitted, reflected = fractions.reflected;
    for (std::size_t c = 0; c < 3 && closed; ++c) { // T²/(1 − R²) and R + T² R/(1 − R²)
        const float t = sqr(fractions.transmitted[c]) / max(1 - sqr(fractions.reflected[c]), 1e-6f);
        transmitted[c] = t, reflected[c] += t * fractions.reflected[c];
    }
    const RayCone behind{
        .p = p_, .n = -point_.ng, .direction = normalize(straight), .width = width_, .from_visible_surface = false};
    const Rgb sum = tracer_.incoming_radiance(behind) * transmitted;
    if (!point_.receives(mirrored)) return sum;
    return sum + reflection(normalize(mirrored), 0, true) * reflected;
}

} // namespace duet::raster
