#include "raster/screen/glass.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// Refracts a ray from inside at a boundary with the outward normal n; eta is the index inside over outside. The
/// result is empty at total internal reflection.
std::optional<Vec3> refract_out(Vec3 way, Vec3 n, float eta) {
    const float cosine = dot(way, n), squared = 1 - sqr(eta) * (1 - sqr(cosine));
    if (!(squared > 0)) return std::nullopt;
    return normalize(way * eta + n * (std::sqrt(squared) - eta * cosine));
}

constexpr float kTouching = 1e-3f; ///< relative to the depth: a surface within this distance touches the glass
/// This is a heuristic angle in radians by which neighboring rays diverge if their paths through glass differ.
constexpr float kParting = 0.3f;

/// Returns whether the surface at a pixel is convex, according to its neighbors' normals.
bool bulges(const Screen& screen, int x, int y) {
    const std::optional<Vec3> here = screen.seen(x, y);
    float sum = 0;
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
        if (const auto there = screen.seen(x + dx, y + dy); here && there)
            sum += dot(screen.normal(x + dx, y + dy) - screen.normal(x, y), *there - *here);
    return sum >= 0;
}

/// Returns the blur angle of GGX alpha through two boundaries: a slope deflects a refracted ray by η − 1 times its
/// angle.
float blur_through(float eta, float alpha) { return 2.8f * std::abs(eta - 1) * alpha; }

} // namespace

bool is_glass(const PreparedData& data, std::uint32_t object) {
    return std::binary_search(data.glass.begin(), data.glass.end(), object);
}

SeenThrough::SeenThrough(const PreparedData& data, const Settings& settings, const Screen& screen,
                         const ShadingPoint& point)
    : data_(data), screen_(screen), point_(point), scenery_{screen, screen.behind(), point.surface.object},
      around_(data, settings, scenery_),
      p_(screen.relative(point.surface.p)), size_(length(data.objects[point.surface.object].bounds.diagonal())) {
    const Vec3 place = screen.project(p_);
    if (!(place.z > 0)) return;
    const auto [x, y] = screen.pixel_at(place);
    width_ = screen.pixel_size(place.z);
    turn_ = bulges(screen, x, y) ? screen.turn(x, y) : -screen.turn(x, y);
}

/// Returns the reflection at the front surface.
Rgb SeenThrough::mirror(Vec3 way, float alpha, bool lamps) const {
    return around_.seen({.p = p_, .n = point_.ng, .way = way, .width = width_, .turn = 2 * turn_,
                         .spread = blur_mirrored(alpha),
                         .alpha = alpha, .lamps = lamps, .point = &point_, .from_picture = false});
}

Rgb SeenThrough::boundary(const DielectricBsdf& bsdf, float alpha) const {
    Rgb sum;
    for (const bool transmitted : {false, true}) {
        // TransportMode::kImportance omits the factor η² of radiance inside the medium, which cancels on leaving it.
        const float lobe = transmitted ? kOneMinusEpsilon : 0.0f;
        const auto sample = bsdf.sample(point_.wo, lobe, {0.5f, 0.5f}, TransportMode::kImportance);
        if (!sample || sample->transmitted != transmitted) continue;
        const Vec3 way = normalize(point_.frame.to_world(sample->wi));
        if (point_.receives(way) == transmitted) continue; // the geometric and the shading normal disagree
        if (!transmitted)
            sum += mirror(way, alpha, alpha == 0) * sample->weight * sample->pdf;
        else if (point_.wo.z < 0) // seen from inside
            sum += around_.seen({.p = p_, .n = -point_.ng, .way = way, .width = width_, .turn = (bsdf.eta - 1) * turn_,
                                 .spread = blur_through(bsdf.eta, alpha), .alpha = alpha, .from_picture = false}) *
                   sample->weight * sample->pdf;
        else
            sum += through(way, bsdf.eta, alpha) * sample->pdf;
    }
    return sum;
}

Rgb SeenThrough::through(Vec3 way, float eta, float alpha) const {
    const auto& glass = std::get<Dielectric>(data_.scene.materials[point_.surface.material]);
    const Rgb tint = glass.at(data_.scene.textures, point_.surface).tint;
    const Segment left = follow(way, eta);
    // A convex side makes neighboring rays converge, as in a thick symmetric lens.
    const float bend = (1 - 1 / eta) * turn_, parting = static_cast<float>(left.lost) * kParting;
    const auto kept = [&](float absorption) { return std::exp(-left.inside * absorption); };
    const std::optional<Rgb> met = met_inside(left.p);
    SurfacePoint exit = point_.surface; // the point at which shadow maps are sampled for visible lights
    exit.p = screen_.absolute(left.p);
    exit.ng = exit.ns = exit.horizon = left.n;
    exit.lift = {};
    const ShadingPoint leaves(exit, left.n);
    const Look look{.p = left.p, .n = left.n, .way = left.way, .width = width_ - left.inside * bend, .turn = -2 * bend,
                    .spread = parting + blur_through(eta, alpha), .alpha = alpha, .lamps = left.lost == 0,
                    .point = &leaves,
                    .from_picture = false};
    const Rgb light = met ? *met : around_.seen(look);
    return light * tint * tint * Rgb(kept(glass.absorption.r), kept(glass.absorption.g), kept(glass.absorption.b));
}

/// Returns the radiance of a surface inside the glass, or touching it where the ray would leave.
std::optional<Rgb> SeenThrough::met_inside(Vec3 p) const {
    const Vec3 place = screen_.project(p);
    if (!(place.z > 0) || !screen_.contains(place.x, place.y)) return std::nullopt;
    const auto [x, y] = screen_.pixel_at(place);
    const Screen& behind = scenery_.at(x, y);
    const float depth = behind.depth(x, y);
    if (!(depth <= place.z * (1 + kTouching)) || !(layer(x, y).depth(x, y) < depth)) return std::nullopt;
    return behind.first_look().radiance.at(place.x, place.y, 1);
}

/// Follows the ray from its entry to its exit, or to the last known point.
SeenThrough::Segment SeenThrough::follow(Vec3 way, float eta) const {
    Segment at{.p = p_, .way = way, .n = way};
    const bool ball =
        std::holds_alternative<Sphere>(data_.scene.shapes[data_.scene.objects[point_.surface.object].shape]);
    for (int i = 0; i < kSegments; ++i) {
        const std::optional<Segment> next = ball ? across_ball(at) : across_picture(at);
        if (!next) break;
        at = *next;
        if (const auto out = refract_out(at.way, at.n, eta)) {
            at.way = *out;
            return at;
        }
        at.way = normalize(at.way - at.n * (2 * dot(at.way, at.n)));
        ++at.lost;
    }
    at.n = at.way;
    return at;
}

std::optional<SeenThrough::Segment> SeenThrough::across_ball(const Segment& from) const {
    const Object& object = data_.scene.objects[point_.surface.object];
    const ObjectTransform transform = object_transform(object, point_.surface.time);
    const Sphere& sphere = std::get<Sphere>(data_.scene.shapes[object.shape]);
    const Vec3 p = transform_point(transform.to_object, screen_.absolute(from.p)) - sphere.center,
               way = transform_vector(transform.to_object, from.way);
    const float t = -2 * dot(p, way) / dot(way, way); // the ray starts on the sphere
    if (!(t > 0)) return std::nullopt;
    const Vec3 n = transform_normal(transform.to_object, p + way * t);
    return Segment{.p = from.p + from.way * t, .way = from.way, .n = normalize(n), .inside = from.inside + t,
                   .lost = from.lost};
}

/// Returns the glass layer with this object at a pixel. Where another glass object partly covers it, the covered and
/// uncovered pixels are in different layers.
const Screen& SeenThrough::layer(int x, int y) const {
    for (const Screen* layer = &screen_.front(); layer->backs() != nullptr; layer = layer->behind())
        if (layer->first_look().objects(x, y) == point_.surface.object) return *layer;
    return screen_;
}

std::optional<SeenThrough::Segment> SeenThrough::across_picture(const Segment& from) const {
    const bool deeper = screen_.homogeneous_change(from.way)[2] > 0;
    float t = 0;
    Vec3 n;
    bool found = false;
    for (int i = 0; i < kSteps && !found; ++i) {
        const Vec3 place = screen_.project(from.p + from.way * t);
        if (!(place.z > 0)) return std::nullopt;
        const auto [x, y] = screen_.pixel_at(place);
        const Screen& shown = layer(x, y);
        const Screen& far = deeper ? *shown.backs() : shown;
        const std::optional<Vec3> seen = far.seen(x, y);
        if (!seen) { // outside the silhouette: go back halfway
            if (i == 0) return std::nullopt;
            t *= 0.5f;
            continue;
        }
        n = far.normal(x, y);
        if (dot(n, from.way) < 0) n = -n;
        const Vec3 to = *seen - from.p;
        const float along = dot(n, to) / max(dot(n, from.way), 0.2f); // limits extrapolation at grazing angles
        const float next = clamp(along > 0 ? along : length(to), 0.0f, size_);
        found = std::abs(next - t) < width_;
        t = next;
    }
    return Segment{.p = from.p + from.way * t, .way = from.way, .n = n, .inside = from.inside + t, .lost = from.lost +
                   !found};
}

/// Returns the mirror reflection and the undeviated transmission. A closed sheet has two sides along the ray, with
/// multiple reflections between them.
Rgb SeenThrough::operator()(const ThinDielectricBsdf& bsdf) const {
    const ThinDielectricBsdf::Parts parts = bsdf.parts(std::abs(point_.wo.z));
    const Object& object = data_.scene.objects[point_.surface.object];
    const Shape& shape = data_.scene.shapes[object.shape];
    const auto* mesh = std::get_if<Mesh>(&shape);
    const bool closed = std::holds_alternative<Sphere>(shape) || (mesh != nullptr && mesh->closed);
    const Vec3 straight = point_.frame.to_world(-point_.wo),
               mirrored = point_.frame.to_world({-point_.wo.x, -point_.wo.y, point_.wo.z});
    Rgb transmitted = parts.transmitted, reflected = parts.reflected;
    for (std::size_t c = 0; c < 3 && closed; ++c) { // T²/(1 − R²) and R + T² R/(1 − R²)
        const float t = sqr(parts.transmitted[c]) / max(1 - sqr(parts.reflected[c]), 1e-6f);
        transmitted[c] = t, reflected[c] += t * parts.reflected[c];
    }
    const Look behind{.p = p_, .n = -point_.ng, .way = normalize(straight), .width = width_, .from_picture = false};
    const Rgb sum = around_.seen(behind) * transmitted;
    if (!point_.receives(mirrored)) return sum;
    return sum + mirror(normalize(mirrored), 0, true) * reflected;
}

} // namespace duet::raster
