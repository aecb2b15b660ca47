// Implements unidirectional path tracing with next event estimation. Each vertex draws a light sample and a BSDF
// sample, combined by multiple importance sampling (Kajiya 1986; Veach 1997, §9 and §10). Without light samples
// (plan.lights is null) it is the naive path tracer, in which only BSDF samples find the lights.
//
// The functions at the top hold the formulas of a step. They are templates over the number type T: Path calls them for
// one path (T = float), and wavefront/batch.cpp for a batch of paths, one per SIMD lane. All paths are computed by
// them.
#pragma once

#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/light_sampling.h"
#include "raytrace/integrator/medium_sampling.h"
#include "raytrace/integrator/medium_stack.h"
#include "raytrace/integrator/mis.h"
#include "raytrace/integrator/path_footprint.h"
#include "raytrace/integrator/path_state.h"
#include "raytrace/integrator/random_walk.h"
#include "raytrace/integrator/russian_roulette.h"
#include "raytrace/integrator/scattered_light.h"

#include <type_traits>
#include <utility>

namespace duet::raytrace {

/// Returns the light of a light sample that the vertex scatters to the viewer, unless the light is occluded. It is not
/// divided by the sample's density yet.
template <typename AnyVertex, typename T>
inline RgbT<T> light_toward_viewer(const AnyVertex& vertex, const LightLiSampleT<T>& light) {
    return scattering(vertex, light.wi) * light.radiance;
}

/// Returns the MIS weight of a light sample against the BSDF samples of the vertex.
template <typename AnyVertex, typename T>
inline T light_sample_weight(const AnyVertex& vertex, const LightLiSampleT<T>& light) {
    if (all(light.delta)) return T(1);
    // BSDF samples also find the environment and all emitters at rest.
    return mis_weight(light.pdf, select(light.delta, T(0), scattering_pdf(vertex, light.wi)));
}

/// Returns the MIS weight of light that a ray has found, against light samples at the previous vertex. `light_pdf` is
/// the density with which light samples draw the ray's direction.
inline float found_light_weight(const PreviousVertex& previous, float light_pdf) {
    return previous.no_light_sample ? 1 : mis_weight(previous.pdf, light_pdf);
}

/// Holds how a path leaves a vertex.
template <typename T> struct ScatteringT {
    OptionalBsdfSample<T> sample;
    MaskOf<T> scatters = has_sample(sample); ///< whether the surface scatters any light; else it absorbs all of it
    MaskOf<T> continues = MaskOf<T>(false);  ///< whether the new direction is valid, too
    Vec3T<T> wi{};                           ///< direction of the next ray, unit, in world space
};

/// Samples the next direction from the BSDF of the vertex and multiplies the path's throughput by the sample's weight.
template <typename AnyVertex, typename T>
inline ScatteringT<T> scatter(const AnyVertex& vertex, const VertexRandomSamplesT<T>& u, PathThroughputT<T>& path,
                              TransportMode mode = TransportMode::kRadiance) {
    ScatteringT<T> next{sample(vertex.bsdf, vertex.wo, u.lobe, u.bsdf, mode)};
    if (none_of(next.scatters)) return next;
    const BsdfSampleT<T>& s = *next.sample;
    next.scatters = next.scatters & !is_black(s.weight);
    next.wi = normalize(vertex.frame.to_world(s.wi));
    next.continues = next.scatters & is_consistent(vertex, next.wi, s.wi);
    path.throughput *= s.weight;
    if (is_transmissive(vertex.bsdf) && mode == TransportMode::kRadiance) {
        // Entering glass scales radiance by 1/η², and leaving it by η². Roulette must ignore both factors.
        const T eta2 = sqr(T(refraction_index(vertex.bsdf)));
        const T factor = select(vertex.wo.z > T(0), T(1) / eta2, eta2);
        path.refraction = select(s.transmitted, path.refraction * factor, path.refraction);
    }
    return next;
}

/// Sums the light that a path finds, from any source. It is the sink for images: a sink receives all light of a path.
class RadianceSum {
public:
    static constexpr bool kLogsEvents = false; // whether the sink has a log() of all events
    void start(const Bsdf&) {}
    void start_in_medium() {}
    void add(Rgb light, LightSource, int) { total_ += light; }
    void add_shadowed(Rgb, LightSource, int) {}
    Rgb result() const { return total_; }

private:
    Rgb total_;
};

/// Replaces the medium stack in scenes without media and absorbing dielectrics. It is empty.
struct NoMediumStack {
    explicit NoMediumStack(const RenderPlan&) {}
    static constexpr float relative_index() { return 0; }
};

/// Returns the random samples of the vertex at the end of a ray, if it uses any.
inline VertexRandomSamples random_samples_at(const RenderPlan& plan, Sampler& sampler, const Hit& hit, int depth) {
    const bool used = (hit.valid() && depth < plan.max_depth) || plan.random_distances;
    return used ? vertex_random_samples(sampler, depth) : VertexRandomSamples{};
}

/// Traces one path. kHasMedia is true in scenes with media between or inside surfaces (RenderPlan::needs_medium_stack).
template <typename Sink, bool kHasMedia> class Path {
public:
    Path(const RenderPlan& plan, const Sampler& sampler, RayCounts& counts, Sink sink = {})
        : plan_(plan), counts_(counts), sink_(sink), medium_stack_(plan), footprint_(plan, sampler.sample()) {}

    /// Traces a camera ray, and returns the result of the sink. Images do not call this function: Wavefront
    /// (wavefront/wavefront.cpp) calls advance() for many paths. It is for one path alone, as of `--pixel`.
    auto trace(Sampler& sampler, Ray ray, Hit hit) {
        for (int depth = 0; advance(ray, hit, depth, random_samples_at(plan_, sampler, hit, depth)); ++depth)
            hit = plan_.prepared.accelerator.closest(ray);
        return result();
    }

    /// Processes the hit of the ray after `depth` scatterings: adds the light found there, and replaces the ray by the
    /// one that continues. Returns false if the path ends.
    bool advance(Ray& ray, const Hit& nearest, int depth, const VertexRandomSamples& u) {
        if constexpr (kHasMedia) {
            if (solid_) return pass_solid(ray, nearest, depth, u);
            const std::optional<MediumCollision> collision = pass_media(ray, nearest.t, depth, u);
            if (is_black(state_.throughput)) return log_end("media absorb it");
            if (collision) return scatter_in_medium(*collision, ray, depth, u) && goes_on(depth, u);
        }
        Hit boundary_hit;
        if constexpr (kHasMedia) boundary_hit = skip_ignored_boundaries(ray, nearest);
        const Hit& hit = kHasMedia ? std::as_const(boundary_hit) : nearest;
        if (!hit.valid()) {
            if constexpr (Sink::kLogsEvents) sink_.log().escape(ray, depth);
            add_environment(ray.direction, depth);
            return false;
        }
        const Vertex vertex(plan_, ray, hit, footprint_.at_hit(ray, hit.t), {medium_stack_.relative_index()});
        return scatter_at(vertex, hit, ray, depth, u);
    }
    auto result() const { return sink_.result(); }

    /// Returns the state of the path. A batch modifies it instead of advance().
    PathState& state() { return state_; }
    /// Adds the light of a light sample that a batch has drawn.
    void add(Rgb light) { sink_.add(light, LightSource::kLight, 0); }
    /// Adds light that the ray has found after `bounces` scatterings. `light_pdf` is the density with which light
    /// samples at the previous vertex find it, if any compete.
    void add_found(Rgb emission, float light_pdf, LightSource source, int bounces) {
        const float weight = found_light_weight(state_.previous_vertex, light_pdf);
        const Rgb light = state_.throughput * emission * weight;
        if constexpr (Sink::kLogsEvents) sink_.log().light_found(emission, weight, light);
        sink_.add(light, source, bounces);
    }

private:
    // Adds the light at a surface that the ray has hit, and replaces the ray. Returns false if the path ends.
    bool scatter_at(const Vertex& vertex, const Hit& hit, Ray& ray, int depth, const VertexRandomSamples& u) {
        if constexpr (Sink::kLogsEvents) sink_.log().vertex(vertex, hit, depth);
        if (depth == 0) sink_.start(vertex.bsdf);
        add_emission(vertex, ray.direction, depth);
        if (depth == plan_.max_depth) return log_end("it is as long as it may be (--depth)");
        const bool specular = is_specular(vertex.bsdf) && !plan_.specular_light_samples;
        if (plan_.lights != nullptr && !specular) add_light_sample(vertex, u, depth);
        if (depth + 1 == plan_.max_depth && !plan_.hits_find_light) return log_end("nothing is left to find");
        return leave(vertex, u, ray) && goes_on(depth, u);
    }

    void add_environment(Vec3 w, int bounces) {
        if (plan_.environment == nullptr) return;
        const PreviousVertex& previous = state_.previous_vertex;
        const float light_pdf =
            previous.no_light_sample ? 0 : pdf_li(*plan_.environment, *plan_.lights, previous.receiver, w);
        add_found(radiance(*plan_.environment, w), light_pdf, LightSource::kEnvironment, bounces);
    }

    void add_emission(const Vertex& vertex, Vec3 direction, int bounces) {
        if (!plan_.emission) return;
        const Rgb emission = emitted(vertex.material, plan_.scene.textures, vertex.point, -direction);
        if (is_black(emission)) return;
        const PreviousVertex& previous = state_.previous_vertex;
        const float light_pdf =
            previous.no_light_sample ? 0 : pdf_li(plan_.scene, *plan_.lights, previous.receiver, vertex.point);
        add_found(emission, light_pdf, source_of(vertex.point), bounces);
    }

    template <typename AnyVertex>
    void add_light_sample(const AnyVertex& vertex, const VertexRandomSamples& u, int bounces) {
        const auto light_sample =
            sample_li(plan_.scene, *plan_.lights, light_receiver(vertex), u.light_choice, u.light);
        if (!light_sample) return log_no_light_sample("the chosen light does not shine here");
        if constexpr (std::is_same_v<AnyVertex, MediumVertex>)
            if (light_sample->delta) return log_no_light_sample("the chosen light is sampled along the whole ray");
        Rgb scattered = light_toward_viewer(vertex, *light_sample);
        if constexpr (kHasMedia) scattered *= transmittance_to_light(vertex, *light_sample, u.light.y);
        if (is_black(scattered) && !plan_.black_shadow_rays)
            return log_no_light_sample("the surface does not scatter the chosen light toward here");
        const LightSource source = light_sample->light < 0 ? LightSource::kEnvironment : LightSource::kLight;
        ++counts_.shadow;
        if (!unoccluded(plan_, vertex, *light_sample)) {
            if constexpr (Sink::kLogsEvents) sink_.log().light_sample(*light_sample, scattered, false, 0, Rgb());
            sink_.add_shadowed(state_.throughput * scattered / light_sample->pdf, source, bounces + 1);
            return;
        }
        const float weight = light_sample_weight(vertex, *light_sample);
        const Rgb light = state_.throughput * scattered * (weight / light_sample->pdf);
        if constexpr (Sink::kLogsEvents) sink_.log().light_sample(*light_sample, scattered, true, weight, light);
        sink_.add(light, source, bounces + 1);
    }

    // Only the sink that splits the light needs the source, so other sinks skip the search.
    LightSource source_of(const SurfacePoint& point) const {
        if constexpr (std::is_same_v<Sink, RadianceSum>) return LightSource::kLight;
        const bool sampled = surface_light_index(plan_.scene, point.object, point.primitive) >= 0;
        return sampled ? LightSource::kLight : LightSource::kOther;
    }

    // Samples the next direction from the BSDF. Returns false if the path ends.
    bool leave(const Vertex& vertex, const VertexRandomSamples& u, Ray& ray) {
        const ScatteringT<float> next = scatter(vertex, u, state_);
        if (!next.scatters) return log_end("the surface absorbs it");
        if (!next.continues) return log_end("its direction lies between the horizons of both normals");
        if constexpr (kHasMedia)
            if (next.sample->transmitted) enter(vertex);
        footprint_.scatter(next.sample->pdf, next.sample->specular);
        // Each component is written directly to its destination. If a whole ray were copied right after its components
        // were written, the load would stall on store forwarding.
        state_.previous_vertex.no_light_sample = next.sample->specular || plan_.lights == nullptr;
        if (!state_.previous_vertex.no_light_sample) {
            state_.previous_vertex.receiver = light_receiver(vertex);
            state_.previous_vertex.pdf = next.sample->pdf;
        }
        ray.origin = ray_origin(plan_, vertex.point, next.wi, vertex.point.time);
        ray.direction = next.wi;
        ray.t_min = 0;
        if constexpr (Sink::kLogsEvents) sink_.log().scattered(*next.sample, ray, state_);
        return true;
    }

    // Records the solid or the dielectric behind a surface that the path passes.
    void enter(const Vertex& vertex) {
        if (const auto* bsdf = std::get_if<SubsurfaceBsdf>(&vertex.bsdf))
            solid_ = {bsdf->interior, vertex.point.object};
        if (has_interior(vertex)) medium_stack_.cross(vertex.point.material, vertex.wo.z > 0);
    }

    // Carries the path through a solid, and scatters it where it leaves the solid. Returns false if the path ends.
    bool pass_solid(Ray& ray, const Hit& nearest, int depth, const VertexRandomSamples& u) {
        Rgb emitted;
        const auto exit = random_walk(plan_, *solid_, ray, nearest, u.distance, state_, emitted, counts_);
        solid_.reset();
        if (!is_black(emitted)) sink_.add(emitted, LightSource::kOther, depth);
        if (!exit) return log_end("it does not leave the solid: absorbed, or ended by roulette");
        if constexpr (Sink::kLogsEvents) sink_.log().walk(*exit);
        ray = exit->outside;
        const Vertex vertex(plan_, ray, exit->hit, footprint_.at_hit(ray, exit->hit.t), {0, true});
        return scatter_at(vertex, exit->hit, ray, depth, u);
    }

    // Continues the ray to the first boundary that is not ignored, in scenes with a medium stack.
    Hit skip_ignored_boundaries(Ray& ray, const Hit& nearest) {
        int ignored = 0;
        const Hit hit = medium_stack_.skip_ignored_boundaries(ray, nearest, state_.throughput, ignored);
        counts_.indirect += ignored;
        // Light samples do not reach beyond an ignored boundary, because shadow rays end at any boundary.
        if (ignored > 0) state_.previous_vertex.no_light_sample = true;
        return hit;
    }

    static bool has_interior(const Vertex& vertex) {
        const auto* glass = std::get_if<Dielectric>(&vertex.material);
        return glass != nullptr && !glass->thin;
    }

    // Returns an estimate, decided by u, of the transmittance from the vertex to a light sample. It depends on the
    // dielectric or the media on the light's side of the surface.
    Rgb transmittance_to_light(const Vertex& vertex, const LightLiSample& light_sample, float u) const {
        const Ray ray{vertex.point.p, light_sample.wi};
        if (same_hemisphere(vertex.wo, vertex.frame.to_local(light_sample.wi)) || !has_interior(vertex))
            return transmittance_inside(medium_stack_, ray, light_sample.distance, u);
        MediumStack beyond = medium_stack_;
        beyond.cross(vertex.point.material, vertex.wo.z > 0);
        return transmittance_inside(beyond, ray, light_sample.distance, u);
    }
    Rgb transmittance_to_light(const MediumVertex& vertex, const LightLiSample& light_sample, float u) const {
        return estimate_transmittance(plan_.scene.media, Ray{vertex.p, light_sample.wi}, light_sample.distance, u);
    }
    Rgb transmittance_inside(const MediumStack& stack, const Ray& ray, float distance, float u) const {
        return stack.in_dielectric() ? stack.transmittance(distance)
                                     : estimate_transmittance(plan_.scene.media, ray, distance, u);
    }

    // Carries the path through the media on [0, t_end] of the ray. Adds the light that they emit, and the light from
    // delta lights that they scatter toward the path. Returns where they scatter the path itself, if they do.
    std::optional<MediumCollision> pass_media(const Ray& ray, float t_end, int depth, const VertexRandomSamples& u) {
        if (!plan_.scene.needs.media || medium_stack_.in_dielectric()) return std::nullopt;
        MediaOnRay media(plan_.scene.media, ray, t_end);
        if (plan_.delta_lights > 0 && depth < plan_.max_depth) add_scattered_light(media, depth, u);
        Rgb emitted;
        const auto collision = sample_collision(media, u.distance, state_.throughput, emitted);
        if (!is_black(emitted)) sink_.add(emitted, LightSource::kOther, depth);
        return collision;
    }

    void add_scattered_light(MediaOnRay& media, int bounces, const VertexRandomSamples& u) {
        const std::optional<ScatteredLight> s = sample_scattered_light(plan_, media, u.light);
        if (!s) return;
        ++counts_.shadow;
        const bool visible = unoccluded(plan_, s->vertex, s->light);
        const Rgb light = state_.throughput * s->radiance;
        if constexpr (Sink::kLogsEvents) sink_.log().light_sample(s->light, s->radiance, visible, 1, light);
        if (visible)
            sink_.add(light, LightSource::kLight, bounces + 1);
        else
            sink_.add_shadowed(light, LightSource::kLight, bounces + 1);
    }

    // Samples the next direction from the phase function. Returns false if the path ends.
    bool scatter_in_medium(const MediumCollision& collision, Ray& ray, int depth, const VertexRandomSamples& u) {
        const MediumVertex vertex{ray.at(collision.t), ray.direction, ray.time, collision.asymmetry};
        footprint_.at_hit(ray, collision.t);
        if constexpr (Sink::kLogsEvents) sink_.log().medium_vertex(vertex, depth);
        if (depth == 0) sink_.start_in_medium();
        if (depth == plan_.max_depth) return log_end("it is as long as it may be (--depth)");
        if (plan_.lights != nullptr) add_light_sample(vertex, u, depth);
        if (depth + 1 == plan_.max_depth && !plan_.hits_find_light) return log_end("nothing is left to find");
        const Vec3 wi = sample_phase(vertex.direction, vertex.asymmetry, u.bsdf);
        const float pdf = scattering_pdf(vertex, wi);
        footprint_.scatter(pdf, false);
        state_.previous_vertex = {light_receiver(vertex), pdf, plan_.lights == nullptr};
        ray = spawn_ray(plan_, vertex, wi);
        return true;
    }

    // Returns whether the path continues after a scattering.
    bool goes_on(int depth, const VertexRandomSamples& u) {
        if (plan_.russian_roulette && depth > 0 && !survives(u.roulette)) return false;
        ++counts_.indirect;
        return true;
    }

    bool survives(float u) {
        const auto [probability, survives] = russian_roulette(u, state_);
        if constexpr (Sink::kLogsEvents)
            if (probability < 1) sink_.log().roulette(probability, survives);
        counts_.ended += !survives;
        return survives;
    }

    bool log_end([[maybe_unused]] const char* why) {
        if constexpr (Sink::kLogsEvents) sink_.log().end(why);
        return false;
    }
    void log_no_light_sample([[maybe_unused]] const char* why) {
        if constexpr (Sink::kLogsEvents) sink_.log().no_light_sample(why);
    }

    const RenderPlan& plan_;
    RayCounts& counts_;
    Sink sink_;
    PathState state_;
    std::conditional_t<kHasMedia, MediumStack, NoMediumStack> medium_stack_;
    std::optional<EnteredSolid> solid_; // solid that the path is inside of
    PathFootprint footprint_;
};

} // namespace duet::raytrace
