// Declares ComponentTracer, which traces one camera sample at a time and splits its light into components, for callers
// that need to know where light comes from.
#pragma once

#include "raytrace/integrator/light_components.h"
#include "raytrace/render.h"
#include "raytrace/render_plan.h"

#include <optional>

namespace duet::raytrace {

/// Describes the surface that a camera ray hits first, as the path tracer evaluates it.
struct FirstSurface {
    SurfacePoint point;
    Bsdf bsdf;
};

/// Describes one sample of one pixel.
struct PixelSample {
    Ray ray;
    Hit hit;
    std::optional<FirstSurface> surface;   ///< empty on a miss
    std::optional<RayFootprint> footprint; ///< footprint at the hit; empty on a miss, or if no texture is filtered
    LightComponents light;
};

/// Traces the same samples as render() with the same settings: sample `index` of pixel (x, y) has the same ray, the
/// same path and, except for rounding, the same radiance, light.sum(). If the settings need an error estimate
/// (PathTracerSettings::estimates_error), even and odd indices are two independent halves (see Sampler). The integrator
/// must be path or direct.
class ComponentTracer {
public:
    ComponentTracer(const PathTracerScene& prepared, const View& view, const PathTracerSettings& settings);

    /// Traces one sample. Any number of threads may call it at once.
    PixelSample sample(int x, int y, std::uint32_t index) const;

private:
    PathTracerScene prepared_;
    PathTracerSettings settings_;
    RenderPlan plan_;
    CameraModel camera_;
};

} // namespace duet::raytrace
