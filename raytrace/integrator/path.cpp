// Paths are traced for a sum of light, for its components, or for a log of each step.
#include "raytrace/integrator/path.h"

#include "raytrace/integrator/path_gains.h"
#include "raytrace/integrator/path_log.h"

namespace duet::raytrace {

namespace {

// This sink splits the light of a path into components. `bounces` is the number of scatterings between the light and
// the camera.
class Split {
public:
    static constexpr bool kTold = false;
    void start(const Bsdf& first) {
        diffuse_ = is_diffuse(first);
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
    bool diffuse_ = false, specular_ = false; // about the BSDF of the first hit
};

// This sink adds up the light and logs each step.
template <typename Log> class Told : public Sum {
public:
    static constexpr bool kTold = true;
    explicit Told(Log& log) : log_(log) {}
    Log& log() { return log_; }

private:
    Log& log_;
};

template <typename Sink>
auto traced(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts,
            Sink sink = {}) {
    if (plan.insides) return Path<Sink, true>(plan, sampler, counts, sink).trace(sampler, ray, hit);
    return Path<Sink, false>(plan, sampler, counts, sink).trace(sampler, ray, hit);
}

} // namespace

Rgb path_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts) {
    return traced<Sum>(plan, ray, hit, sampler, counts);
}

Rgb logged_path_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, PathLog& log) {
    RayCounts counts;
    return traced(plan, ray, hit, sampler, counts, Told(log));
}

void follow_path(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, PathGains& gains) {
    RayCounts counts;
    traced(plan, ray, hit, sampler, counts, Told(gains));
}

LightParts path_parts(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts) {
    return traced<Split>(plan, ray, hit, sampler, counts);
}

} // namespace duet::raytrace
