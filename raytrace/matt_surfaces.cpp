#include "raytrace/matt_surfaces.h"

namespace duet::raytrace {

namespace {

MattSurfaces::Kind kind_of(const Scene& scene, const Object& object) {
    if (!object.identity || object.moving) return MattSurfaces::Kind::kNone;
    const Shape& shape = scene.shapes[object.shape];
    if (std::holds_alternative<Sphere>(shape)) return MattSurfaces::Kind::kRound;
    const auto* mesh = std::get_if<Mesh>(&shape);
    return mesh == nullptr || mesh->normals.empty() ? MattSurfaces::Kind::kFlat : MattSurfaces::Kind::kSmooth;
}

const DiffuseBsdf* matt(const Scene& scene, std::uint32_t material, const std::optional<Bsdf>& bsdf) {
    if (!bsdf || surface_detail(scene, material) != SurfaceDetail::kWithoutUv) return nullptr;
    if (emitter(scene.materials[material]) != nullptr) return nullptr;
    const auto* diffuse = std::get_if<DiffuseBsdf>(&*bsdf);
    return diffuse != nullptr && !is_black(diffuse->albedo) ? diffuse : nullptr;
}

} // namespace

MattSurfaces::MattSurfaces(const Scene& scene, const std::vector<std::optional<Bsdf>>& bsdfs) : scene_(&scene) {
    for (std::uint32_t i = 0; i < bsdfs.size(); ++i) bsdfs_.push_back(matt(scene, i, bsdfs[i]));
    for (const Object& object : scene.objects) {
        const auto* mesh = std::get_if<Mesh>(&scene.shapes[object.shape]);
        MattObject& matt = objects_.emplace_back();
        matt.several = mesh != nullptr && !mesh->material_slots.empty();
        matt.bsdf = matt.several ? nullptr : bsdfs_[object.materials[0]];
        if (matt.several || matt.bsdf != nullptr) matt.kind = kind_of(scene, object);
    }
}

} // namespace duet::raytrace
