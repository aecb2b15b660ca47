#include "raytrace/path_tracer_scene.h"

#include "common/scene/used_materials.h"
#include "raytrace/render.h"

namespace duet::raytrace {

namespace {

bool textured(const Material& material) {
    bool found = false;
    for_each_texture(material, [&](std::int32_t texture) { found = found || texture >= 0; });
    return found;
}

bool emits(const Material& material) { return emitter(material) != nullptr; }

} // namespace

PathTracerSceneData::PathTracerSceneData(const Scene& scene_, Accelerator built)
    : scene(scene_), accelerator(std::move(built)), lights(scene_.lights, sampled_irradiance(scene_.environment)),
      finite_lights(scene_.lights, 0), environment_light({}, sampled_irradiance(scene_.environment)),
      emitters(any_used_material(scene_, emits)), environment(!is_black(scene_.environment)) {
    bsdfs.reserve(scene.materials.size());
    for (const Material& material : scene.materials)
        bsdfs.push_back(textured(material) ? std::nullopt
                                           : std::optional(bsdf_at(material, scene.textures, SurfacePoint{})));
    scatters_diffusely = any_used_material(scene, [&](const Material& material) {
        const auto* metal = std::get_if<Metal>(&material);
        const auto* glass = std::get_if<Dielectric>(&material);
        return (metal != nullptr && !metal->roughness.constant()) ||
               (glass != nullptr && !glass->roughness.constant()) ||
               !is_specular(bsdf_at(material, scene.textures, SurfacePoint{}));
    });
    scatters_diffusely = scatters_diffusely || scene.needs.media;
}

PathTracerScene prepare(const Scene& scene, const PathTracerSettings& settings) {
    return PathTracerScene(std::make_shared<const PathTracerSceneData>(scene, settings.threads));
}

PathTracerScene prepare_edited(const Scene& scene, const PathTracerSettings& settings,
                               const PathTracerScene& before) {
    return PathTracerScene(std::make_shared<const PathTracerSceneData>(scene, settings.threads, before.data()));
}

Hit trace(const PathTracerScene& prepared, const Ray& ray) { return prepared.data().accelerator.closest(ray); }

} // namespace duet::raytrace
