// Declares PathLog, which describes a path in words, event by event, to show why a pixel has its color.
#pragma once

#include "common/material/bsdf.h"
#include "raytrace/integrator/light_components.h"
#include "raytrace/integrator/medium_vertex.h"
#include "raytrace/integrator/path_state.h"
#include "raytrace/integrator/random_walk.h"

#include <sstream>
#include <string>

namespace duet::raytrace {

/// Logs one path. It writes at least one line of text for each event.
class PathLog {
public:
    explicit PathLog(const Scene& scene) : scene_(scene) {}

    /// Logs a surface that the path hits after `depth` scatterings.
    void vertex(const Vertex& vertex, const Hit& hit, int depth);
    /// Logs a point in a medium at which the path is scattered.
    void medium_vertex(const MediumVertex& vertex, int depth);
    /// Logs the random walk of the path inside a solid.
    void walk(const SolidExit& exit);
    /// Logs a ray that hits nothing.
    void escape(const Ray& ray, int depth);
    /// Logs light that the ray itself has found. `weight` is its MIS weight against light samples, and `light` is its
    /// contribution.
    void light_found(Rgb emission, float weight, Rgb light);
    /// Logs why a vertex has no light sample.
    void no_light_sample(const char* why);
    /// Logs a light sample and whether it is visible. `weight` is its MIS weight against BSDF samples, and `light` is
    /// its contribution.
    void light_sample(const LightLiSample& light_sample, Rgb scattered, bool visible, float weight, Rgb light);
    /// Logs the direction in which the path continues, and its throughput.
    void scattered(const BsdfSample& sample, const Ray& next, const PathState& state);
    /// Logs the decision of Russian roulette.
    void roulette(float probability, bool survived);
    /// Logs why the path ends.
    void end(const char* why);

    std::string text() const { return out_.str(); }

private:
    const Scene& scene_;
    std::ostringstream out_;
};

/// Returns the same radiance as path_radiance, and logs the path.
Rgb logged_path_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, PathLog& log);

} // namespace duet::raytrace
