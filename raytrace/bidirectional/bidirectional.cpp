#include "raytrace/bidirectional/bidirectional.h"

#include "common/vec/robust.h"
#include "raytrace/sampling/primary_sample.h"

#include <cmath>

namespace duet::raytrace {

namespace {

// Returns the MIS weight of a strategy from the sums over the strategies that connect closer to the light and closer to
// the camera. It is 0 if a density is too large for a double.
float weight(double light_side, double camera_side) {
    const double others = light_side + camera_side;
    return others >= 0 ? static_cast<float>(1 / (1 + others)) : 0;
}

// Camera subpaths use the same sample dimensions as the path tracer. Light subpaths use the dimensions after those of
// the longest camera subpath.
int light_subpath_depth(const RenderPlan& plan, int depth) { return plan.max_depth + 1 + depth; }

Ray importance_ray(const SubpathVertex& at, Vec3 w) {
    Ray ray{at.importance_origin(w), w};
    ray.time = at.vertex.point.time;
    return ray;
}

template <typename S> EmissionRandomSamples emission_samples(const RenderPlan& plan, S& sampler) {
    sampler.set_dimension(vertex_dimension(light_subpath_depth(plan, 0)));
    const Sampler::Block u = sampler.get_block();
    return {u[4], {u[0], u[1]}, {u[2], u[3]}};
}

// Returns the MIS sums of a light subpath at its first vertex.
MisSums sums_at_first_hit(const RenderPlan& plan, const LightEmission& emission, const EmittedRay& emitted,
                          const SubpathVertex& at, double merging) {
    const Scene& scene = plan.scene;
    const LightReceiver receiver = light_receiver(at.vertex);
    double light_sample_pdf = static_cast<double>(plan.lights->probability(receiver, emitted.light));
    if (emitted.light == plan.lights->environment_index())
        light_sample_pdf *= static_cast<double>(pdf(*plan.environment, at.to_previous));
    else if (const auto* surface = std::get_if<SurfaceLight>(&scene.lights[emitted.light]))
        light_sample_pdf *= static_cast<double>(light_pdf(*surface, at.vertex.point.p, emitted.position));
    const auto [density, geometry] =
        emission.density(emitted.light, emitted.position, -at.to_previous, at.vertex.point.p);
    const double arrived = density * at.cosine(at.to_previous);
    const double earlier = emission.is_delta(emitted.light) ? 0 : mis(geometry / arrived);
    return {mis(light_sample_pdf * geometry / arrived), earlier, 0, merging > 0 ? earlier / mis(merging) : 0};
}

} // namespace

BidirectionalTracer::BidirectionalTracer(const RenderPlan& plan, const LightEmission& emission, const View& view,
                                         Integrator integrator, float radius, RayCounts& counts)
    : plan_(plan), emission_(emission), view_(view), connects_(connects(integrator)),
      merging_(path_count() * kPiDouble * sqr(static_cast<double>(radius))), counts_(counts) {}

template <typename S> void BidirectionalTracer::trace_light_subpath(float time, S& sampler) {
    light_subpath_.clear();
    if (emission_.empty()) return;
    const std::optional<EmittedRay> emitted = emission_.sample(emission_samples(plan_, sampler), time);
    if (!emitted) return;
    PathThroughputT<float> path;
    if (!connects_ && emitted->light == plan_.lights->environment_index())
        path.throughput *= static_cast<float>(emission_.photon_fraction(-emitted->ray.direction));
    MisSums sums;
    Ray ray = emitted->ray;
    for (int depth = 0; depth < plan_.max_depth; ++depth) {
        ++counts_.indirect;
        const Hit hit = plan_.prepared.accelerator.closest(ray);
        if (!hit.valid()) return;
        SubpathVertex& at = light_subpath_.emplace_back(plan_, ray, hit, nullptr, depth);
        const double cosine = at.cosine(at.to_previous);
        if (!(cosine > 0)) return light_subpath_.pop_back();
        if (depth == 0)
            sums = sums_at_first_hit(plan_, emission_, *emitted, at, merging_);
        else
            sums.arrive(sqr(static_cast<double>(hit.t)), cosine);
        at.throughput = emitted->weight * path.throughput;
        at.mis = sums;
        const bool connectable = !is_specular(at.vertex.bsdf);
        ScatteringT<float> next;
        if (depth + 1 < plan_.max_depth) {
            const VertexRandomSamples u = vertex_random_samples(sampler, light_subpath_depth(plan_, depth + 1));
            next = leave(at, u, TransportMode::kImportance, path, sums);
            if (next.continues) ray = importance_ray(at, next.wi);
        }
        if (!connectable) light_subpath_.pop_back();
        if (!next.continues) return;
    }
}

// Draws the direction in which the subpath continues, unless it ends at the vertex.
ScatteringT<float> BidirectionalTracer::leave(const SubpathVertex& at, const VertexRandomSamples& u, TransportMode mode,
                                              PathThroughputT<float>& path, MisSums& sums) {
    ScatteringT<float> next = scatter(at, u, mode, path, sums, merging_);
    if (!next.continues || !plan_.russian_roulette || at.depth == 0) return next;
    next.continues = russian_roulette(u.roulette, path).survives;
    counts_.ended += !next.continues;
    return next;
}

void BidirectionalTracer::connect_to_camera(const Pinhole& pinhole, std::vector<Splat>& splats) {
    for (const SubpathVertex& at : light_subpath_)
        if (const std::optional<Splat> splat = connection_to_camera(at, pinhole)) splats.push_back(*splat);
}

void BidirectionalTracer::add_photons(std::vector<Photon>& photons) const {
    for (const SubpathVertex& at : light_subpath_) {
        if (at.depth == 0) continue;
        const SurfacePoint& point = at.vertex.point;
        const float ratio = abs(dot(at.to_previous, point.ns) / dot(at.to_previous, point.ng));
        photons.push_back({point.p, at.to_previous, at.throughput * ratio, at.mis, at.depth});
    }
}

std::optional<Splat> BidirectionalTracer::connection_to_camera(const SubpathVertex& at, const Pinhole& pinhole) {
    const std::optional<SeenPoint> seen = seen_through(pinhole, Vec3d(at.vertex.point.p));
    if (!seen) return std::nullopt;
    const auto [x, y] = seen->pixel;
    if (!(x >= 0 && y >= 0 && x < view_.width && y < view_.height)) return std::nullopt;
    const Vec3 w(seen->to_camera);
    const Rgb scattered = at.importance_scattering(w);
    if (is_black(scattered)) return std::nullopt;
    const Ray ray = importance_ray(at, w);
    Hit end;
    end.t = static_cast<float>(seen->distance) - length(ray.origin - at.vertex.point.p);
    ++counts_.shadow;
    if (plan_.prepared.accelerator.occluded(ray, end)) return std::nullopt;
    const double density = seen->pixel_density / path_count();
    const double light_side = at.mis.over_connection(
        density * at.cosine(w), at.pdf(w, at.to_previous, TransportMode::kRadiance), merging_at(at));
    const float factor = static_cast<float>(density) * weight(light_side, 0);
    const auto pixel =
        static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(view_.width) + static_cast<std::uint32_t>(x);
    return Splat{pixel, at.throughput * scattered * factor};
}

template <typename S>
Rgb BidirectionalTracer::trace_camera_subpath(Ray ray, Hit hit, const Pinhole& pinhole, S& sampler,
                                              const PhotonMap* photons) {
    Rgb sum;
    PathThroughputT<float> path;
    MisSums sums;
    LightReceiver previous;
    Wanted wanted = Wanted::kAll;
    PathFootprint footprint(plan_, sampler.sample());
    for (int depth = 0;; ++depth) {
        if (!hit.valid())
            return sum + path.throughput * environment_light(ray.direction, depth, previous, sums, wanted);
        SubpathVertex at(plan_, ray, hit, footprint.at_hit(ray, hit.t), depth);
        const double cosine = at.cosine(at.to_previous);
        if (depth > 0)
            sums.arrive(sqr(static_cast<double>(hit.t)), cosine);
        else if (const auto seen = seen_through(pinhole, Vec3d(at.vertex.point.p)))
            sums.connection = mis(path_count() / (seen->pixel_density * cosine));
        at.throughput = path.throughput;
        at.mis = sums;
        sum += at.throughput * emitted_light(at, depth, hit.t, previous, wanted);
        if (depth == plan_.max_depth || !(cosine > 0)) return sum;
        if (wanted == Wanted::kDirect) {
            if (emission_.complete()) return sum;
            wanted = Wanted::kRest;
        }
        const VertexRandomSamples u = vertex_random_samples(sampler, depth);
        if (wanted == Wanted::kAll && plan_.lights != nullptr && !is_specular(at.vertex.bsdf)) {
            sum += at.throughput * light_sample(at, u);
            for (const SubpathVertex& light : light_subpath_)
                if (depth + light.depth + 2 <= plan_.max_depth) sum += connection(at, light);
            if (photons != nullptr) sum += merged_light(at, *photons);
        }
        if (depth + 1 == plan_.max_depth && !plan_.hits_find_light) return sum;
        previous = light_receiver(at.vertex);
        const ScatteringT<float> next = leave(at, u, TransportMode::kRadiance, path, sums);
        if (!next.continues) return sum;
        if (wanted == Wanted::kAll && !next.sample->specular && photons_bring(static_cast<double>(next.sample->pdf)))
            wanted = Wanted::kDirect;
        footprint.scatter(next.sample->pdf, next.sample->specular);
        ray = spawn_ray(plan_, at.vertex, next.wi);
        ++counts_.indirect;
        hit = plan_.prepared.accelerator.closest(ray);
    }
}

// Returns whether photons estimate the light that arrives from a direction, in photon mapping. They do for all light
// that a vertex scatters, with two exceptions. Direct light is left to light samples, which find it better. Directions
// that the BSDF draws with a high density are traced, because few photons arrive from them, and each would have a large
// weight.
bool BidirectionalTracer::photons_bring(double bsdf_pdf) const {
    constexpr double kFollowed = 4; // per steradian; a diffuse BSDF reaches 0.32, and a rough mirror 0.08 / alpha²
    return !connects_ && merging_ > 0 && !emission_.empty() && bsdf_pdf <= kFollowed;
}

Rgb BidirectionalTracer::environment_light(Vec3 w, int depth, const LightReceiver& previous, const MisSums& sums,
                                           Wanted wanted) const {
    if (plan_.environment == nullptr) return Rgb();
    const Rgb light = radiance(*plan_.environment, w);
    if (wanted == Wanted::kRest) return light * static_cast<float>(1 - emission_.photon_fraction(w));
    if (depth == 0 || plan_.lights == nullptr || emission_.empty()) return light;
    const auto sample_pdf = static_cast<double>(pdf_li(*plan_.environment, *plan_.lights, previous, w));
    const double density = emission_.density(plan_.lights->environment_index(), {}, -w, {}).density;
    return light * weight(0, mis(sample_pdf) * sums.connection + (connects_ ? mis(density) * sums.earlier : 0));
}

Rgb BidirectionalTracer::emitted_light(const SubpathVertex& at, int depth, float distance,
                                       const LightReceiver& previous, Wanted wanted) const {
    if (!plan_.emission) return Rgb();
    const SurfacePoint& point = at.vertex.point;
    const Rgb light = emitted(at.vertex.material, plan_.scene.textures, point, at.to_previous);
    if (is_black(light) || depth == 0 || plan_.lights == nullptr) return light;
    const std::int64_t index = surface_light_index(plan_.scene, point.object, point.primitive);
    if (index < 0) return light; // light samples and light subpaths cannot find it
    if (wanted == Wanted::kRest) return Rgb();
    const auto [density, geometry] =
        emission_.density(static_cast<std::size_t>(index), point.p, at.to_previous, previous.p);
    const double by_area = static_cast<double>(pdf_li(plan_.scene, *plan_.lights, previous, point)) * geometry /
                           sqr(static_cast<double>(distance));
    return light * weight(0, mis(by_area) * at.mis.connection + (connects_ ? mis(density) * at.mis.earlier : 0));
}

Rgb BidirectionalTracer::light_sample(const SubpathVertex& at, const VertexRandomSamples& u) {
    const Vertex& vertex = at.vertex;
    const auto s = sample_li(plan_.scene, *plan_.lights, light_receiver(vertex), u.light_choice, u.light);
    if (!s) return Rgb();
    const Rgb scattered = light_toward_viewer(vertex, *s);
    if (is_black(scattered)) return Rgb();
    ++counts_.shadow;
    if (!unoccluded(plan_, vertex, *s)) return Rgb();
    if (!connects_) return scattered * (light_sample_weight(vertex, *s) / s->pdf);
    const std::size_t index = s->light < 0 ? plan_.lights->environment_index() : static_cast<std::size_t>(s->light);
    const Vec3 q = s->distance < kInfinity ? vertex.point.p + s->wi * s->distance : Vec3();
    const auto [density, geometry] = emission_.density(index, q, -s->wi, vertex.point.p);
    const auto pdf = static_cast<double>(s->pdf);
    const double light_side = s->delta ? 0 : mis(at.pdf(at.to_previous, s->wi, TransportMode::kRadiance) / pdf);
    const double camera_side = at.mis.over_connection(density * at.cosine_of_light(s->wi) / (pdf * geometry),
                                                      at.pdf(s->wi, at.to_previous, TransportMode::kImportance), 0);
    return scattered * (weight(light_side, camera_side) / s->pdf);
}

bool BidirectionalTracer::visible(const Vertex& camera, const SubpathVertex& light, Vec3 w) {
    const float time = camera.point.time;
    const Vec3 start = ray_origin(plan_, camera.point, w, time), end = light.importance_origin(-w);
    Ray ray{start, normalize(end - start)};
    ray.time = time;
    Hit before;
    before.t = length(end - start) * (1 - gamma_bound(8));
    ++counts_.shadow;
    return !plan_.prepared.accelerator.occluded(ray, before);
}

Rgb BidirectionalTracer::connection(const SubpathVertex& camera, const SubpathVertex& light) {
    const Vec3d offset = Vec3d(light.vertex.point.p) - Vec3d(camera.vertex.point.p);
    const double squared_distance = length_squared(offset);
    if (!(squared_distance > 0)) return Rgb();
    const Vec3 w(offset / std::sqrt(squared_distance));
    const Rgb scattered = scattering(camera.vertex, w) * light.importance_scattering(-w);
    if (is_black(scattered) || !visible(camera.vertex, light, w)) return Rgb();
    const double to_light = camera.pdf(camera.to_previous, w, TransportMode::kRadiance);
    const double to_camera = light.pdf(light.to_previous, -w, TransportMode::kImportance);
    const double light_side =
        light.mis.over_connection(to_light * light.cosine(w) / squared_distance,
                                  light.pdf(-w, light.to_previous, TransportMode::kRadiance), merging_at(light));
    const double camera_side =
        camera.mis.over_connection(to_camera * camera.cosine_of_light(w) / squared_distance,
                                   camera.pdf(w, camera.to_previous, TransportMode::kImportance), merging_);
    return camera.throughput * light.throughput * scattered *
           (weight(light_side, camera_side) / static_cast<float>(squared_distance));
}

// Returns the MIS weight of merging. In photon mapping it is 1, or 0 if the photon's direction is traced instead.
float BidirectionalTracer::photon_weight(const SubpathVertex& at, const Photon& photon) const {
    const Vec3 wi = photon.to_previous;
    const double pdf = at.pdf(at.to_previous, wi, TransportMode::kRadiance);
    if (!connects_) return photons_bring(pdf) ? 1 : 0;
    return weight(photon.mis.over_merging(pdf, merging_),
                  at.mis.over_merging(at.pdf(wi, at.to_previous, TransportMode::kImportance), merging_));
}

// Returns the light of the photons near a vertex of the camera subpath. A photon is moved to that vertex: its light is
// scattered by the camera subpath's BSDF, without a visibility test, and spread over the area of the disk around the
// vertex.
Rgb BidirectionalTracer::merged_light(const SubpathVertex& at, const PhotonMap& photons) const {
    const Vertex& vertex = at.vertex;
    Rgb sum;
    photons.for_each_near(vertex.point.p, [&](const Photon& photon) {
        if (at.depth + photon.depth + 1 > plan_.max_depth) return;
        const Vec3 wi = photon.to_previous;
        const Rgb scattered = scattering(vertex, wi);
        if (is_black(scattered) || at.cosine_of_light(wi) == 0) return;
        const float mis_weight = photon_weight(at, photon);
        // The photon's flux includes the cosine at its own surface, which replaces the cosine at this vertex.
        sum += photon.flux * scattered * (mis_weight / abs(dot(wi, vertex.point.ns)));
    });
    return at.throughput * sum * static_cast<float>(1 / merging_);
}

template void BidirectionalTracer::trace_light_subpath(float, Sampler&);
template void BidirectionalTracer::trace_light_subpath(float, PrimarySample&);
template Rgb BidirectionalTracer::trace_camera_subpath(Ray, Hit, const Pinhole&, Sampler&, const PhotonMap*);
template Rgb BidirectionalTracer::trace_camera_subpath(Ray, Hit, const Pinhole&, PrimarySample&, const PhotonMap*);

} // namespace duet::raytrace
