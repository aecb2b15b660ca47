// Traces paths for a sum of light, for its components, or for a log of each step.
#include "raytrace/integrator/path.h"

#include "raytrace/integrator/path_log.h"

namespace duet::raytrace {

namespace {

// Splits the light of a path into components. `bounces` is the number of scatterings between the light and the camera.
class ComponentSink {
public:
    static constexpr bool kLogsEvents = false;
    void start(const Bsdf& first) {
        diffuse_ = is_diffuse(first);
        specular_ = is_specular(first);
    }
    void start_in_medium() { diffuse_ = true; }
    void add(Rgb light, LightSource source, int bounces) { component(source, bounces) += light; }
    void add_shadowed(Rgb light, LightSource source, int bounces) {
        if (bounces == 1 && source == LightSource::kLight) components_.shadowed += light;
    }
    const LightComponents& result() const { return components_; }

private:
    Rgb& component(LightSource source, int bounces) {
        if (bounces == 0) return components_.emission;
        if (bounces == 1 && source == LightSource::kLight && !specular_) return components_.direct;
        if (!diffuse_) return components_.reflection;
        return bounces == 1 && source == LightSource::kEnvironment ? components_.environment : components_.indirect;
    }

    LightComponents components_;
    bool diffuse_ = false, specular_ = false; // whether the first scattering is diffuse or specular
};

// Adds up the light and logs each step.
class LoggingSink : public RadianceSum {
public:
    static constexpr bool kLogsEvents = true;
    explicit LoggingSink(PathLog& log) : log_(log) {}
    PathLog& log() { return log_; }

private:
    PathLog& log_;
};

template <typename Sink>
auto trace_path(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts,
                Sink sink = {}) {
    if (plan.needs_medium_stack) return Path<Sink, true>(plan, sampler, counts, sink).trace(sampler, ray, hit);
    return Path<Sink, false>(plan, sampler, counts, sink).trace(sampler, ray, hit);
}

} // namespace

Rgb path_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts) {
    return trace_path<RadianceSum>(plan, ray, hit, sampler, counts);
}

Rgb logged_path_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, PathLog& log) {
    RayCounts counts;
    return trace_path(plan, ray, hit, sampler, counts, LoggingSink(log));
}

LightComponents path_components(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler,
                                RayCounts& counts) {
    return trace_path<ComponentSink>(plan, ray, hit, sampler, counts);
}

} // namespace duet::raytrace
