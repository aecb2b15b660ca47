#include "raytrace/batched_surfaces.h"

namespace duet::raytrace {

namespace {

std::optional<BatchedSurfaces::Geometry> geometry_of(const Scene& scene, const Object& object) {
    if (!object.identity || object.moving) return {};
    const Shape& shape = scene.shapes[object.shape];
    if (std::holds_alternative<Sphere>(shape)) return BatchedSurfaces::Geometry::kSphere;
    const auto* mesh = std::get_if<Mesh>(&shape);
    return mesh == nullptr || mesh->normals.empty() ? BatchedSurfaces::Geometry::kFlat
                                                    : BatchedSurfaces::Geometry::kSmooth;
}

std::optional<BatchedSurfaces::BsdfKind> bsdf_kind_of(const Bsdf& bsdf) {
    if (const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf)) {
        if (is_black(diffuse->albedo)) return {}; // such surfaces end paths
        return BatchedSurfaces::BsdfKind::kDiffuse;
    }
    if (const auto* metal = std::get_if<MetalBsdf>(&bsdf))
        return metal->smooth() ? BatchedSurfaces::BsdfKind::kMirror : BatchedSurfaces::BsdfKind::kMetal;
    if (std::holds_alternative<DielectricBsdf>(bsdf)) return BatchedSurfaces::BsdfKind::kGlass;
    return {};
}

} // namespace

BatchedSurfaces::BatchedMaterial BatchedSurfaces::batched_material(const Scene& scene, std::uint32_t material,
                                                                   const std::optional<Bsdf>& bsdf) {
    if (!bsdf || surface_detail(scene, material) != SurfaceDetail::kWithoutUv) return {};
    if (emitter(scene.materials[material]) != nullptr) return {};
    const auto bsdf_kind = bsdf_kind_of(*bsdf);
    return bsdf_kind ? BatchedMaterial{&*bsdf, *bsdf_kind} : BatchedMaterial{};
}

BatchedSurfaces::BatchedSurfaces(const Scene& scene, const std::vector<std::optional<Bsdf>>& bsdfs)
    : BatchedSurfaces(scene.objects.size()) {
    scene_ = &scene;
    for (std::uint32_t i = 0; i < bsdfs.size(); ++i) materials_.push_back(batched_material(scene, i, bsdfs[i]));
    for (const Object& object : scene.objects) {
        const auto* mesh = std::get_if<Mesh>(&scene.shapes[object.shape]);
        BatchedObject& batched = objects_.emplace_back();
        batched.shape = &scene.shapes[object.shape];
        batched.multi_material = mesh != nullptr && !mesh->material_slots.empty();
        if (!batched.multi_material) batched.material = materials_[object.materials[0]];
        if (batched.multi_material || batched.material.bsdf != nullptr) batched.geometry = geometry_of(scene, object);
        if (!batched.geometry) continue;
        classes_[objects_.size() - 1] =
            batched.multi_material
                ? kByMaterial
                : static_cast<std::uint8_t>(Kind{*batched.geometry, batched.material.bsdf_kind}.index());
    }
}

std::size_t BatchedSurfaces::class_by_material(const Hit& hit) const {
    const BatchedObject& object = objects_[hit.object];
    const BatchedMaterial& material = material_at(hit, object);
    return material.bsdf == nullptr ? kOther : Kind{*object.geometry, material.bsdf_kind}.index();
}

} // namespace duet::raytrace
