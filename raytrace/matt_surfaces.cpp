#include "raytrace/matt_surfaces.h"

namespace duet::raytrace {

namespace {

MattSurfaces::Kind kind_of(const Scene& scene, const Object& object) {
    if (!object.identity || object.moving) return MattSurfaces::Kind::kNone;
    const Shape& shape = scene.shapes[object.shape];
    if (std::holds_alternative<Sphere>(shape)) return MattSurfaces::Kind::kRound;
    const auto* mesh = std::get_if<Mesh>(&shape);
    return mesh == nullptr || mesh->normals.empty() ? MattSurfaces::Kind::kFlat : MattSurfaces::Kind::kNone;
}

const DiffuseBsdf* matt(const Scene& scene, std::uint32_t material, const std::optional<Bsdf>& bsdf) {
    if (!bsdf || surface_detail(scene, material) != SurfaceDetail::kWithoutUv) return nullptr;
    if (emitter(scene.materials[material]) != nullptr) return nullptr;
    const auto* diffuse = std::get_if<DiffuseBsdf>(&*bsdf);
    return diffuse != nullptr && !is_black(diffuse->albedo) ? diffuse : nullptr;
}

} // namespace

MattSurfaces::MattSurfaces(const Scene& scene, const std::vector<std::optional<Bsdf>>& bsdfs) : scene_(&scene) {
    for (const Object& object : scene.objects) kinds_.push_back(kind_of(scene, object));
    for (std::uint32_t i = 0; i < bsdfs.size(); ++i) bsdfs_.push_back(matt(scene, i, bsdfs[i]));
}

} // namespace duet::raytrace
