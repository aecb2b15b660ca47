// The light samples of the paths of a batch.
#pragma once

#include "raytrace/integrator/light_sampling.h"
#include "raytrace/wavefront/lanes.h"

namespace duet::raytrace::lanes {

#if XSIMD_WITH_AVX

class BatchLightSamples {
public:
    /// Draws a light sample for each path, at the points p. The light receiver must be in the path's state.
    BatchLightSamples(const RenderPlan& plan, std::span<const BatchPath> paths, const Vec& p);

    /// Returns a bit mask of the paths that have a light sample.
    unsigned some() const { return some_; }
    /// Returns the light sample of path i, which must have one.
    Arrival operator[](std::size_t i) const {
        return {{wi_.vec(i), radiance_.rgb(i), pdf_.of[i], delta_.of[i] > 0}, distance_[i], light_[i]};
    }
    /// Returns the light samples in lanes. Lanes without one have a black sample.
    LightLiSampleT<Floats> lanes() const {
        return {wi_.floats(), radiance_.colors(), pdf_.floats(), delta_.floats() > Floats(0.0f)};
    }

private:
    // Holds a LightChoice for each path that has one. Choices and samples are copied component by component: if a whole
    // one were copied right after its components were written, that load would wait for the stores.
    struct Choices {
        unsigned some = 0; // bit mask of the paths
        std::array<std::size_t, kLanes> index;
        std::array<float, kLanes> probability;

        LightChoice operator[](std::size_t i) const { return {index[i], probability[i], 0}; }
    };

    void set(std::size_t i, const Arrival& arrival);
    unsigned sample_far_rectangles(const RenderPlan& plan, std::span<const BatchPath> paths, const Vec& p,
                                   const Choices& choices);

    unsigned some_ = 0;
    Columns wi_, radiance_;
    Column pdf_, delta_;
    std::array<float, kLanes> distance_;
    std::array<std::int64_t, kLanes> light_;
};

#endif

} // namespace duet::raytrace::lanes
