#include "raster/shading/sample_attributes.h"

namespace duet::raster {

ShadedSample sample_attributes(const RasterSceneData& data, const RasterSettings& settings, const HitTile& tile, int x,
                               int y) {
    const Ray& ray = tile.ray(x, y);
    const Hit& hit = tile.hit(x, y);
    if (!hit.valid()) return {.radiance = {}, .normal = {}, .albedo = {}};
    const Scene& scene = data.scene;
    const RayFootprint footprint = scene.needs.footprints ? tile.footprint(x, y) : RayFootprint{};
    const std::uint32_t material = material_index(scene, hit.object, hit.primitive);
    const SurfacePoint surface = surface_point(scene, ray, hit, &footprint, surface_detail(scene, material));
    const bool back = dot(surface.ng, ray.direction) > 0;
    return {.radiance = {},
            .normal = back ? -surface.ns : surface.ns,
            .albedo = settings.aovs.albedo ? base_color(scene.materials[surface.material], scene.textures, surface)
                                           : Rgb()};
}

} // namespace duet::raster
