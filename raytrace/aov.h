// Auxiliary pictures of what the camera rays hit.
#pragma once

#include "common/film/film.h"
#include "raytrace/plan.h"

namespace duet::raytrace {

/// Gathers depth, normal, albedo and hit: as many of them as are asked for. Threads may add to different pixels at
/// once.
class AovBuffers {
public:
    AovBuffers(const RenderPlan& plan, const View& view, const AovSet& asked);

    /// Whether anything of a sample is looked at.
    bool any() const { return asked_.depth || asked_.normal || asked_.albedo || asked_.hit; }
    /// The first hit (or none) of a camera ray, sample `index` of its pixel.
    void add(int x, int y, std::uint32_t index, const Ray& ray, const Hit& hit);
    /// Moves the pictures to where they were asked for; those of the film, too.
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
    Vec3d forward_; // of the camera
    AovSet asked_;
    Image<Sums> sums_;
    Image<Hit> hits_;
};

} // namespace duet::raytrace
