// What the steps of a path were worth: the light that it gathered after each, and the rays that this took.
#pragma once

#include "raytrace/integrator/light_sampling.h"
#include "raytrace/integrator/path_state.h"

#include <vector>

namespace duet::raytrace {

/// A scattering that a path went on from. Its numbers are those of the path as it would be without roulette.
struct PathStep {
    bool first = false;   ///< at what the camera sees: there is no roulette
    float throughput = 0; ///< after it, as survival() counts it
    float weight = 1;     ///< 1 / the chance that roulette left the path to get to here and go on
    float light = 0;      ///< found from here on: the mean of the channels
    float next_rays = 0;  ///< from here to the next step, shadow rays too
};

/// Told of what happens along one path, as PathLog is, it keeps the steps.
class PathGains {
public:
    void vertex(const Vertex&, const Hit&, int depth) {
        send();
        first_ = depth == 0;
    }
    void escape(const Ray&, int) { send(); }
    void found(Rgb, float, Rgb light) { find(light); }
    void no_light_sample(const char*) {}
    void light_sample(const Arrival&, Rgb, bool, float, Rgb light) {
        send();
        find(light);
    }
    void scattered(const Vertex&, const BsdfSample&, Vec3, const PathState& state) {
        steps_.push_back({first_, survival(state.throughput, state.refraction, 1.0f) / weight_, weight_});
    }
    void roulette(float probability, bool survived) {
        if (!survived) return steps_.pop_back();
        weight_ /= probability;
        steps_.back().weight = weight_;
    }
    void end(const char*) {}

    const std::vector<PathStep>& steps() const { return steps_; }
    double light() const { return light_; }               ///< of the whole path
    double camera_rays() const { return camera_rays_; }   ///< before the first step

private:
    void send() {
        if (steps_.empty())
            ++camera_rays_;
        else
            ++steps_.back().next_rays;
    }
    void find(Rgb light) {
        const float mean = (light.r + light.g + light.b) / 3;
        for (PathStep& step : steps_) step.light += mean / step.weight;
        light_ += static_cast<double>(mean);
    }

    std::vector<PathStep> steps_;
    float weight_ = 1;
    double light_ = 0, camera_rays_ = 0;
    bool first_ = false;
};

/// Traces the path of a camera ray, and tells it.
void follow_path(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, PathGains& gains); ///< path.cpp

} // namespace duet::raytrace
