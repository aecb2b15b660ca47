// The path tracer, one camera sample at a time, its light split into parts: for those who ask where light comes from.
#pragma once

#include "raytrace/integrator/light_parts.h"
#include "raytrace/plan.h"

#include <optional>

namespace duet::raytrace {

/// The surface that a camera ray meets first, as the path tracer sees it.
struct FirstSurface {
    SurfacePoint point;
    Bsdf bsdf;
};

/// One sample of one pixel.
struct CameraSample {
    Ray ray;
    Hit hit;
    std::optional<FirstSurface> surface;   ///< empty where nothing is hit
    std::optional<RayFootprint> footprint; ///< of the ray there; empty where no texture is filtered, too
    LightParts light;
};

/// Traces what render() with the same settings traces: sample `index` of pixel (x, y) is the same ray, the same path
/// and, but for rounding, the same radiance, light.sum(). Where those know their error, even and
/// odd indices are two independent halves (see Sampler). The integrator must be path or direct.
class SplitTracer {
public:
    SplitTracer(const Prepared& prepared, const View& view, const Settings& settings);

    /// Any number of threads may call it at once.
    CameraSample sample(int x, int y, std::uint32_t index) const;

private:
    Prepared prepared_;
    Settings settings_;
    RenderPlan plan_;
    CameraModel camera_;
};

} // namespace duet::raytrace
