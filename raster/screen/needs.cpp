#include "raster/screen/needs.h"

#include "raster/light/environment_light.h"
#include "raster/screen/mirrored.h"

#include "common/scene/used_materials.h"

#include <algorithm>

namespace duet::raster {

bool needs_occlusion(const PreparedData& data, const Settings& settings) {
    const bool shown = settings.parts.environment || needs_screen_radiance(data, settings) ||
        needs_screen_behind(data, settings);
    return settings.shading == Shading::kLit && settings.output != Output::kNearness &&
           settings.ambient_occlusion != AmbientOcclusion::kNone && shown && shows_environment(data, settings);
}

bool needs_screen(const PreparedData& data, const Settings& settings) {
    return needs_occlusion(data, settings) ||
           (settings.output != Output::kNearness &&
            (needs_screen_radiance(data, settings) || needs_screen_behind(data, settings)));
}

bool needs_screen_radiance(const PreparedData& data, const Settings& settings) {
    return settings.shading == Shading::kLit && settings.screen_reflections && settings.parts.reflection &&
           any_used_material(data.scene, may_mirror);
}

bool needs_screen_behind(const PreparedData& data, const Settings& settings) {
    return settings.shading == Shading::kLit && settings.screen_refractions && settings.parts.reflection &&
        !data.glass.empty();
}

double occlusion_radius(const PreparedData& data, const Settings& settings) {
    if (settings.occlusion_radius > 0) return settings.occlusion_radius;
    const Camera& camera = data.scene.camera;
    return min(static_cast<double>(length(data.scene.bounds.diagonal())), length(camera.look_at - camera.eye)) /
           // Sample points in the hemisphere find fewer distant occluders.
           (settings.ambient_occlusion == AmbientOcclusion::kSsao ? 8 : 2);
}

} // namespace duet::raster
