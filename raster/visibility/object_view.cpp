#include "raster/geometry/geometry.h"
#include "raster/visibility/shader.h"

#include <algorithm>

namespace duet::raster {

ObjectView::ObjectView(const RasterSceneData& data_, const PassView& pass_, std::uint32_t object_)
    : data(data_), pass(pass_), object(object_), color(data_.objects[object_].uniform_color),
      eye(Vec3(pass_.pinhole.origin)), forward(Vec3(pass_.pinhole.forward)), orthographic(pass_.viewport.orthographic) {
    const Object& placed = data.scene.objects[object];
    const Mesh* mesh = std::get_if<Mesh>(&data.scene.shapes[placed.shape]);
    smooth =
        std::holds_alternative<Sphere>(data.scene.shapes[placed.shape]) || (mesh != nullptr && !mesh->normals.empty());
    const auto any_material = [&](const auto& is) {
        return std::any_of(placed.materials.begin(), placed.materials.end(), is);
    };
    has_normal_map = any_material([&](std::uint32_t material) { return data.scene.maps[material].perturbs_normal(); });
    is_emissive =
        any_material([&](std::uint32_t material) { return emitter(data.scene.materials[material]) != nullptr; });
    identity = placed.identity;
    if (identity) return;
    const ObjectTransform at = object_transform(placed, pass.time);
    to_world = at.to_world;
    to_object = at.to_object;
}

} // namespace duet::raster
