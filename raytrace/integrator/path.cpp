// Unidirectional path tracing with next event estimation: at each vertex a light sample and a BSDF sample, combined by
// multiple importance sampling (Kajiya 1986; Veach 1997, §9 and §10). Without light samples (plan.lights is null)
// it is the naive path tracer, in which only chance finds the lights.
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/light_sampling.h"
#include "raytrace/integrator/path_footprint.h"

#include <type_traits>

namespace duet::raytrace {

namespace {

// How the ray left the vertex before: what its chance to find a light is weighed against.
struct Departure {
    Vec3 p;
    float pdf = 0;
    bool certain = true; // no light sample competes: a camera ray, or a delta lobe
};

// What becomes of the light that a path finds: in a picture it is added up, whatever way it came.
class Sum {
public:
    void start(const Bsdf&) {}
    void add(Rgb light, LightSource, int) { total_ += light; }
    void add_shadowed(Rgb, LightSource, int) {}
    Rgb result() const { return total_; }

private:
    Rgb total_;
};

// Or it goes to the part it belongs to. `bounces` is the number of scatterings between the light and the camera.
class Split {
public:
    void start(const Bsdf& first) {
        diffuse_ = std::holds_alternative<DiffuseBsdf>(first);
        specular_ = is_specular(first);
    }
    void add(Rgb light, LightSource source, int bounces) { part(source, bounces) += light; }
    void add_shadowed(Rgb light, LightSource source, int bounces) {
        if (bounces == 1 && source == LightSource::kLight) parts_.shadowed += light;
    }
    const LightParts& result() const { return parts_; }

private:
    Rgb& part(LightSource source, int bounces) {
        if (bounces == 0) return parts_.emission;
        if (bounces == 1 && source == LightSource::kLight && !specular_) return parts_.direct;
        if (!diffuse_) return parts_.reflection;
        return bounces == 1 && source == LightSource::kEnvironment ? parts_.environment : parts_.indirect;
    }

    LightParts parts_;
    bool diffuse_ = false, specular_ = false; // the first hit
};

template <typename Sink> class Path {
public:
    Path(const RenderPlan& plan, Sampler& sampler, RayCounts& counts)
        : plan_(plan), sampler_(sampler), counts_(counts), footprint_(plan) {}

    /// The light along a camera ray, as the sink keeps it.
    auto trace(Ray ray, Hit hit) {
        for (int depth = 0;; ++depth) {
            if (!hit.valid()) {
                add_environment(normalize(ray.direction), depth);
                break;
            }
            const Vertex vertex = make_vertex(plan_, ray, hit, footprint_.arrive(ray, hit.t));
            if (depth == 0) sink_.start(vertex.bsdf);
            add_emission(vertex, ray.direction, depth);
            if (depth == plan_.max_depth) break;
            const VertexDimensions dimensions(depth);
            const bool specular = is_specular(vertex.bsdf) && !plan_.mirror_light;
            if (plan_.lights != nullptr && !specular) add_light_sample(vertex, dimensions, depth);
            if (depth + 1 == plan_.max_depth && !plan_.hits_find_light) break; // nothing is left to find
            if (!scatter(vertex, dimensions, ray)) break;
            if (plan_.russian_roulette && depth >= kFirstRoulette && !survives(dimensions)) break;
            hit = plan_.prepared.accelerator.closest(ray);
            ++counts_.indirect;
        }
        return sink_.result();
    }

private:
    static constexpr int kFirstRoulette = 3;

    void add_environment(Vec3 w, int bounces) {
        if (plan_.environment == nullptr) return;
        float weight = 1;
        if (!departure_.certain) weight = mis_weight(departure_.pdf, arrival_pdf(*plan_.environment, *plan_.lights, w));
        sink_.add(throughput_ * radiance(*plan_.environment, w) * weight, LightSource::kEnvironment, bounces);
    }

    void add_emission(const Vertex& vertex, Vec3 direction, int bounces) {
        if (!plan_.emission) return;
        const Rgb emission = emitted(*vertex.material, plan_.scene.textures, vertex.point, -direction);
        if (is_black(emission)) return;
        float weight = 1;
        if (!departure_.certain)
            weight = mis_weight(departure_.pdf, arrival_pdf(plan_.scene, *plan_.lights, departure_.p, vertex.point));
        sink_.add(throughput_ * emission * weight, source_of(vertex.point), bounces);
    }

    void add_light_sample(const Vertex& vertex, VertexDimensions dimensions, int bounces) {
        sampler_.set_dimension(dimensions.light_choice());
        const float choice = sampler_.get_1d();
        sampler_.set_dimension(dimensions.light());
        const auto arrival = sample_arrival(plan_.scene, *plan_.lights, vertex.point.p, choice, sampler_.get_2d());
        if (!arrival) return;
        const Rgb scattered = vertex.scattered(arrival->wi) * arrival->radiance;
        if (is_black(scattered) && !plan_.black_shadow_rays) return;
        const LightSource source = arrival->light < 0 ? LightSource::kEnvironment : LightSource::kLight;
        ++counts_.shadow;
        if (!reaches(plan_, vertex, *arrival)) {
            sink_.add_shadowed(throughput_ * scattered / arrival->pdf, source, bounces + 1);
            return;
        }
        // The environment and all still emitters are found by BSDF samples, too.
        const float bsdf_pdf = arrival->delta ? 0 : pdf(vertex.bsdf, vertex.wo, vertex.frame.to_local(arrival->wi));
        sink_.add(throughput_ * scattered * (mis_weight(arrival->pdf, bsdf_pdf) / arrival->pdf), source, bounces + 1);
    }

    // Asked for the sink that splits alone: a sum need not know.
    LightSource source_of(const SurfacePoint& point) const {
        if constexpr (std::is_same_v<Sink, Sum>) return LightSource::kLight;
        const bool sampled = surface_light_index(plan_.scene, point.object, point.primitive) >= 0;
        return sampled ? LightSource::kLight : LightSource::kOther;
    }

    // Chooses the next direction by the BSDF; false where the path ends.
    bool scatter(const Vertex& vertex, VertexDimensions dimensions, Ray& ray) {
        sampler_.set_dimension(dimensions.lobe());
        const float lobe = sampler_.get_1d();
        sampler_.set_dimension(dimensions.bsdf());
        const auto s = sample(vertex.bsdf, vertex.wo, lobe, sampler_.get_2d());
        if (!s || is_black(s->weight)) return false;
        const Vec3 wi = normalize(vertex.frame.to_world(s->wi));
        if (!vertex.consistent(wi, s->wi)) return false;
        throughput_ *= s->weight;
        if (s->transmitted) note_refraction(vertex);
        departure_ = {vertex.point.p, s->pdf, s->specular || plan_.lights == nullptr};
        footprint_.scatter(s->pdf, s->specular);
        ray = spawn_ray(vertex, wi);
        return true;
    }

    // Entering glass scales the throughput by 1/η², leaving it by η²: no reason to end or to favour a path.
    void note_refraction(const Vertex& vertex) {
        const auto* glass = std::get_if<DielectricBsdf>(&vertex.bsdf);
        if (glass == nullptr) return;
        refraction_ *= vertex.wo.z > 0 ? 1 / sqr(glass->eta) : sqr(glass->eta);
    }

    // Russian roulette: ends dim paths, and lets the survivors stand for them.
    bool survives(VertexDimensions dimensions) {
        const float probability = max_component(throughput_) / refraction_;
        if (probability >= 1) return true;
        sampler_.set_dimension(dimensions.roulette());
        if (!(sampler_.get_1d() < probability)) return false;
        throughput_ *= 1 / probability;
        return true;
    }

    const RenderPlan& plan_;
    Sampler& sampler_;
    RayCounts& counts_;
    Sink sink_;
    Rgb throughput_{1.0f};
    float refraction_ = 1; // what the path's refractions have scaled its throughput by
    Departure departure_;
    PathFootprint footprint_;
};

} // namespace

Rgb path_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts) {
    return Path<Sum>(plan, sampler, counts).trace(ray, hit);
}

LightParts path_parts(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts) {
    return Path<Split>(plan, sampler, counts).trace(ray, hit);
}

} // namespace duet::raytrace
