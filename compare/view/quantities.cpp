#include "compare/view/quantities.h"

namespace duet::compare {

std::vector<RungRenderers> color_quantities(const Scene& scene, PreparedPair pair) {
    pair.raster_settings.shading = raster::Shading::kLit;
    pair.raytrace_settings.integrator = raytrace::Integrator::kPath;
    std::vector<RungRenderers> all;
    for (const RungPlan& rung : plan_rungs(scene, pair))
        for (const RungRenderers& quantity : rung.renderers)
            if (quantity.name != "hits") all.push_back(quantity);
    return all;
}

} // namespace duet::compare
