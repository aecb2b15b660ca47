// Declares AovBuffers, which accumulates auxiliary images (AOVs) of the first hits of camera rays.
#pragma once

#include "raytrace/film/film.h"
#include "raytrace/render_plan.h"

namespace duet::raytrace {

/// Accumulates the auxiliary images depth, normal, albedo and hit that are requested. Threads may add to different
/// pixels at the same time.
class AovBuffers {
public:
    AovBuffers(const RenderPlan& plan, const View& view, const PathTracerSettings& settings);

    /// Returns whether any image that this class accumulates is requested, so that add() has to be called.
    bool any() const { return requested_.depth || requested_.normal || requested_.albedo || requested_.hit; }
    /// Adds the first hit of a camera ray, which is sample `index` of its pixel. The hit may be invalid.
    void add(int x, int y, std::uint32_t index, const Ray& ray, const Hit& hit);
    /// Moves the requested images to `rendering`, including those that the film provides.
    void finish(const Film& film, Rendering& rendering);
    std::int64_t memory_bytes() const;

private:
    struct Sums {
        double depth = 0;
        Vec3d normal;
        Rgbd albedo;
        std::uint32_t hits = 0;
    };
    const RenderPlan& plan_;
    Vec3d forward_; // view direction of the camera
    AovSet requested_;
    std::uint32_t first_sample_;
    Image<Sums> sums_;
    Image<Hit> hits_;
};

} // namespace duet::raytrace
