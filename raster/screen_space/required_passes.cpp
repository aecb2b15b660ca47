#include "raster/screen_space/required_passes.h"

#include "raster/lighting/environment_light.h"
#include "raster/screen_space/screen_space_reflection.h"

#include "common/scene/used_materials.h"

#include <algorithm>

namespace duet::raster {

bool needs_occlusion(const RasterSceneData& data, const RasterSettings& settings) {
    const bool shown =
        settings.components.environment || needs_color_prepass(data, settings) || needs_glass_layers(data, settings);
    return settings.shading == Shading::kLit && settings.output != Output::kReversedDepth &&
           settings.ambient_occlusion != AmbientOcclusion::kNone && shown && shows_environment(data, settings);
}

bool needs_screen_gbuffer(const RasterSceneData& data, const RasterSettings& settings) {
    return needs_occlusion(data, settings) ||
           (settings.output != Output::kReversedDepth &&
            (needs_color_prepass(data, settings) || needs_glass_layers(data, settings)));
}

bool needs_color_prepass(const RasterSceneData& data, const RasterSettings& settings) {
    return settings.shading == Shading::kLit && settings.screen_reflections && settings.components.reflection &&
           any_used_material(data.scene, may_reflect_image);
}

bool needs_glass_layers(const RasterSceneData& data, const RasterSettings& settings) {
    return settings.shading == Shading::kLit && settings.screen_refractions && settings.components.reflection &&
           !data.glass.empty();
}

double occlusion_radius(const RasterSceneData& data, const RasterSettings& settings) {
    if (settings.occlusion_radius > 0) return settings.occlusion_radius;
    const Camera& camera = data.scene.camera;
    return min(static_cast<double>(length(data.scene.bounds.diagonal())), length(camera.look_at - camera.eye)) /
           // Sample points in the hemisphere find fewer distant occluders.
           (settings.ambient_occlusion == AmbientOcclusion::kSsao ? 8 : 2);
}

} // namespace duet::raster
