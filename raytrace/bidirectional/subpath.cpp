#include "raytrace/bidirectional/subpath.h"

#include <utility>

namespace duet::raytrace {

void MisSums::arrive(double squared_distance, double cosine) {
    connection *= mis(squared_distance / cosine);
    earlier *= mis(1 / cosine);
    last_merging *= mis(1 / cosine);
    earlier_than_merging *= mis(1 / cosine);
}

void MisSums::scatter(double pdf, double reverse_pdf, double cosine, bool specular, double merging, bool merges) {
    earlier += std::exchange(last_merging, 0);
    if (specular) { // both densities are infinite, with a finite ratio
        connection = 0;
        earlier *= mis(cosine);
        earlier_than_merging *= mis(cosine);
        return;
    }
    earlier = mis(cosine / pdf) * (earlier * mis(reverse_pdf) + connection);
    if (merging > 0)
        earlier_than_merging =
            mis(cosine / pdf) * (earlier_than_merging * mis(reverse_pdf) + connection / mis(merging) + merges);
    if (merges) last_merging = mis(cosine / pdf) * mis(merging);
    connection = mis(1 / pdf);
}

double SubpathVertex::cosine_of_light(Vec3 wi) const {
    const Vec3 ng = vertex.point.ng;
    const bool reflected = same_hemisphere(vertex.wo, vertex.frame.to_local(wi));
    return reflected && dot(wi, ng) * dot(to_previous, ng) < 0 ? 0 : cosine(wi);
}

// Passes the direction that the subpath came from to the BSDF in the same form as Vertex::wo: moved to the visible
// side.
double SubpathVertex::pdf(Vec3 from, Vec3 to, TransportMode mode) const {
    const Vec3 came_from = direction_to_viewer(vertex.frame, vertex.point.ng, -from);
    return static_cast<double>(duet::pdf(vertex.bsdf, came_from, vertex.frame.to_local(to), mode));
}

Vec3 SubpathVertex::importance_origin(Vec3 w) const {
    const SurfacePoint& point = vertex.point;
    return offset_origin(point.p, point.p_error, dot(w, point.ng) < 0 ? -point.ng : point.ng);
}

namespace {

// Returns the factor that makes the scattering of importance from `to_light` to w consistent with that of radiance, if
// the shading normal is not the geometric normal. It is a ratio of cosines (Veach 1997, eq. 5.19).
float shading_normal_factor(const Vertex& vertex, Vec3 to_light, Vec3 w) {
    const Vec3 ng = vertex.point.ng, ns = vertex.point.ns;
    return abs(dot(to_light, ns) * dot(w, ng)) / abs(dot(to_light, ng) * dot(w, ns));
}

// Returns whether the vertex lets light from `to_light` pass to a viewer (see is_consistent). `viewer` is a local
// direction in the form of Vertex::wo.
bool lets_light_pass(const Vertex& vertex, Vec3 to_light, Vec3 viewer) {
    const Vec3 light = vertex.frame.to_local(to_light);
    const Vec3 normal = same_hemisphere(light, viewer) ? vertex.point.terminator_normal : vertex.point.ng;
    return dot(to_light, normal) * light.z > 0;
}

} // namespace

// Evaluates the BSDF with the viewer's direction first, moved to the visible side, as the path tracer does.
Rgb SubpathVertex::importance_scattering(Vec3 w) const {
    const Frame& frame = vertex.frame;
    const Vec3 viewer = direction_to_viewer(frame, vertex.point.ng, -w), light = frame.to_local(to_previous);
    if (!lets_light_pass(vertex, to_previous, viewer)) return Rgb();
    const auto geometric = static_cast<float>(cosine(w) / cosine(to_previous));
    return eval(vertex.bsdf, viewer, light) * (abs_cos_theta(light) * geometric);
}

ScatteringT<float> scatter(const SubpathVertex& at, const VertexRandomSamples& u, TransportMode mode,
                           PathThroughputT<float>& path, MisSums& sums, double merging) {
    const bool importance = mode == TransportMode::kImportance;
    ScatteringT<float> next = scatter(at.vertex, u, path, mode);
    if (next.continues && importance) {
        // The BSDF is sampled on the visible side only. A direction beyond the horizon of the shading normal is thus
        // never drawn, although a viewer there would be moved to the visible side.
        const Vec3 viewer = next.sample->wi;
        next.continues =
            dot(next.wi, at.vertex.point.ng) * viewer.z > 0 && lets_light_pass(at.vertex, at.to_previous, viewer);
        path.throughput *= shading_normal_factor(at.vertex, at.to_previous, next.wi);
    }
    if (!next.continues) return next;
    const TransportMode reverse = importance ? TransportMode::kRadiance : TransportMode::kImportance;
    const double reverse_pdf = next.sample->specular ? 0 : at.pdf(next.wi, at.to_previous, reverse);
    const double cosine = importance ? at.cosine(next.wi) : at.cosine_of_light(next.wi);
    sums.scatter(static_cast<double>(next.sample->pdf), reverse_pdf, cosine, next.sample->specular, merging,
                 !importance || at.depth > 0);
    return next;
}

} // namespace duet::raytrace
