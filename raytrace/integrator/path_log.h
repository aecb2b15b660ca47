// A path in words, event by event: for who wants to know why a pixel looks as it does.
#pragma once

#include "common/material/bsdf.h"
#include "raytrace/integrator/light_parts.h"
#include "raytrace/integrator/light_sampling.h"
#include "raytrace/integrator/path_state.h"

#include <sstream>
#include <string>

namespace duet::raytrace {

/// Told of what happens along one path, it writes a line or more of each.
class PathLog {
public:
    explicit PathLog(const Scene& scene) : scene_(scene) {}

    void vertex(const Vertex& vertex, const Hit& hit, int depth);
    void escape(const Ray& ray, int depth);
    /// Light found by the ray itself, which counts with `weight` against light samples, and adds `light`.
    void found(Rgb emission, float weight, Rgb light);
    void no_light_sample(const char* why);
    /// A light sample that reaches the vertex or does not; with `weight` against BSDF samples it adds `light`.
    void light_sample(const Arrival& arrival, Rgb scattered, bool visible, float weight, Rgb light);
    void scattered(const Vertex& vertex, const BsdfSample& sample, Vec3 wi, const PathState& state);
    void roulette(float probability, bool survived);
    void end(const char* why);

    std::string text() const { return out_.str(); }

private:
    const Scene& scene_;
    std::ostringstream out_;
};

/// As path_radiance, and tells the log.
Rgb logged_path_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, PathLog& log);

} // namespace duet::raytrace
