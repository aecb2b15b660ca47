#include "raytrace/component_tracer.h"

#include "common/system/error.h"
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/vertex.h"
#include "raytrace/render_pass.h"

namespace duet::raytrace {

ComponentTracer::ComponentTracer(const PathTracerScene& prepared, const View& view, const PathTracerSettings& settings)
    : prepared_(prepared), settings_(settings), plan_(prepared_.data(), view, settings_), camera_(view) {
    DUET_CHECK(settings.integrator == Integrator::kPath || settings.integrator == Integrator::kDirect);
}

PixelSample ComponentTracer::sample(int x, int y, std::uint32_t index) const {
    Sampler sampler = settings_.make_sampler();
    sampler.start(x, y, index);
    PixelSample result;
    result.ray = camera_ray(plan_, camera_, x, y, sampler);
    result.hit = plan_.prepared.accelerator.closest(result.ray);
    if (result.hit.valid()) {
        const Vertex vertex(plan_, result.ray, result.hit, index);
        result.surface = FirstSurface{vertex.point, vertex.bsdf};
        result.footprint = camera_footprint(plan_, result.ray, result.hit, index);
    }
    RayCounts counts;
    result.light = path_components(plan_, result.ray, result.hit, sampler, counts);
    return result;
}

} // namespace duet::raytrace
