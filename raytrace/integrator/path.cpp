// Unidirectional path tracing with next event estimation: at each vertex a light sample and a BSDF sample, combined by
// multiple importance sampling (Kajiya 1986; Veach 1997, §9 and §10). Without light samples (plan.lights is null)
// it is the naive path tracer, in which only chance finds the lights.
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/light_sampling.h"

namespace duet::raytrace {

namespace {

// How the ray left the vertex before: what its chance to find a light is weighed against.
struct Departure {
    Vec3 p;
    float pdf = 0;
    bool certain = true; // no light sample competes: a camera ray, or a delta lobe
};

class Path {
public:
    Path(const RenderPlan& plan, Sampler& sampler, RayCounts& counts)
        : plan_(plan), sampler_(sampler), counts_(counts) {}

    Rgb radiance(Ray ray, Hit hit) {
        for (int depth = 0;; ++depth) {
            if (!hit.valid()) {
                add_environment(normalize(ray.direction));
                break;
            }
            const Vertex vertex = make_vertex(plan_, ray, hit);
            add_emission(vertex, ray.direction);
            if (depth == plan_.max_depth) break;
            const VertexDimensions dimensions(depth);
            const bool specular = is_specular(vertex.bsdf);
            if (plan_.lights != nullptr && !specular) add_light_sample(vertex, dimensions);
            if (depth + 1 == plan_.max_depth && !plan_.hits_find_light) break; // nothing is left to find
            if (!scatter(vertex, dimensions, ray)) break;
            if (plan_.russian_roulette && depth >= kFirstRoulette && !survives(dimensions)) break;
            hit = plan_.prepared.accelerator.closest(ray);
            ++counts_.indirect;
        }
        return radiance_;
    }

private:
    static constexpr int kFirstRoulette = 3;

    void add_environment(Vec3 w) {
        if (plan_.environment == nullptr) return;
        float weight = 1;
        if (!departure_.certain) weight = mis_weight(departure_.pdf, arrival_pdf(*plan_.environment, *plan_.lights, w));
        radiance_ += throughput_ * duet::radiance(*plan_.environment, w) * weight;
    }

    void add_emission(const Vertex& vertex, Vec3 direction) {
        if (!plan_.prepared.emitters) return;
        const Rgb emission = emitted(*vertex.material, vertex.point, -direction);
        if (is_black(emission)) return;
        float weight = 1;
        if (!departure_.certain)
            weight = mis_weight(departure_.pdf, arrival_pdf(plan_.scene, *plan_.lights, departure_.p, vertex.point));
        radiance_ += throughput_ * emission * weight;
    }

    void add_light_sample(const Vertex& vertex, VertexDimensions dimensions) {
        sampler_.set_dimension(dimensions.light_choice());
        const float choice = sampler_.get_1d();
        sampler_.set_dimension(dimensions.light());
        const auto arrival = sample_arrival(plan_.scene, *plan_.lights, vertex.point.p, choice, sampler_.get_2d());
        if (!arrival) return;
        const Rgb scattered = vertex.scattered(arrival->wi) * arrival->radiance;
        if (is_black(scattered)) return;
        ++counts_.shadow;
        if (!reaches(plan_, vertex, *arrival)) return;
        // The environment and all still emitters are found by BSDF samples, too.
        const float bsdf_pdf = arrival->delta ? 0 : pdf(vertex.bsdf, vertex.wo, vertex.frame.to_local(arrival->wi));
        radiance_ += throughput_ * scattered * (mis_weight(arrival->pdf, bsdf_pdf) / arrival->pdf);
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
    Rgb radiance_, throughput_{1.0f};
    float refraction_ = 1; // what the path's refractions have scaled its throughput by
    Departure departure_;
};

} // namespace

Rgb path_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts) {
    return Path(plan, sampler, counts).radiance(ray, hit);
}

} // namespace duet::raytrace
