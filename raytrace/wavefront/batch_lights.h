// The light samples of the paths of a batch.
#pragma once

#include "raytrace/integrator/light_sampling.h"
#include "raytrace/wavefront/lanes.h"

namespace duet::raytrace::lanes {

#if XSIMD_WITH_AVX

class BatchLightSamples {
public:
    /// Draws a light sample for each path. Its receiver must be in the path's state.
    BatchLightSamples(const RenderPlan& plan, std::span<const BatchPath> paths);

    /// Returns a bit mask of the paths that have a light sample.
    unsigned some() const { return some_; }
    /// Returns the light sample of path i, which must have one.
    const Arrival& operator[](std::size_t i) const { return all_[i]; }
    /// Returns the light samples in lanes. Lanes without one have a black sample.
    LightLiSampleT<Floats> lanes() const {
        return {wi_.floats(), radiance_.colors(), pdf_.floats(), delta_.floats() > Floats(0.0f)};
    }

private:
    using Choices = std::array<std::optional<LightChoice>, kLanes>;

    void set(std::size_t i, const Arrival& arrival);
    unsigned sample_far_rectangles(const RenderPlan& plan, std::span<const BatchPath> paths, const Choices& choices);

    std::array<Arrival, kLanes> all_;
    unsigned some_ = 0;
    Columns wi_, radiance_;
    Column pdf_, delta_;
};

#endif

} // namespace duet::raytrace::lanes
