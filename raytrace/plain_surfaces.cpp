#include "raytrace/plain_surfaces.h"

namespace duet::raytrace {

namespace {

std::optional<PlainSurfaces::Form> form_of(const Scene& scene, const Object& object) {
    if (!object.identity || object.moving) return {};
    const Shape& shape = scene.shapes[object.shape];
    if (std::holds_alternative<Sphere>(shape)) return PlainSurfaces::Form::kRound;
    const auto* mesh = std::get_if<Mesh>(&shape);
    return mesh == nullptr || mesh->normals.empty() ? PlainSurfaces::Form::kFlat : PlainSurfaces::Form::kSmooth;
}

std::optional<PlainSurfaces::Scattering> scattering_of(const Bsdf& bsdf) {
    if (const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf)) {
        if (is_black(diffuse->albedo)) return {}; // such surfaces end paths
        return PlainSurfaces::Scattering::kMatt;
    }
    if (const auto* metal = std::get_if<MetalBsdf>(&bsdf))
        return metal->smooth() ? PlainSurfaces::Scattering::kMirror : PlainSurfaces::Scattering::kMetal;
    if (std::holds_alternative<DielectricBsdf>(bsdf)) return PlainSurfaces::Scattering::kGlass;
    return {};
}

} // namespace

PlainSurfaces::PlainMaterial PlainSurfaces::plain(const Scene& scene, std::uint32_t material,
                                                  const std::optional<Bsdf>& bsdf) {
    if (!bsdf || surface_detail(scene, material) != SurfaceDetail::kWithoutUv) return {};
    if (emitter(scene.materials[material]) != nullptr) return {};
    const auto scattering = scattering_of(*bsdf);
    return scattering ? PlainMaterial{&*bsdf, *scattering} : PlainMaterial{};
}

PlainSurfaces::PlainSurfaces(const Scene& scene, const std::vector<std::optional<Bsdf>>& bsdfs)
    : PlainSurfaces(scene.objects.size()) {
    scene_ = &scene;
    for (std::uint32_t i = 0; i < bsdfs.size(); ++i) materials_.push_back(plain(scene, i, bsdfs[i]));
    for (const Object& object : scene.objects) {
        const auto* mesh = std::get_if<Mesh>(&scene.shapes[object.shape]);
        PlainObject& plain = objects_.emplace_back();
        plain.shape = &scene.shapes[object.shape];
        plain.several = mesh != nullptr && !mesh->material_slots.empty();
        if (!plain.several) plain.material = materials_[object.materials[0]];
        if (plain.several || plain.material.bsdf != nullptr) plain.form = form_of(scene, object);
        if (!plain.form) continue;
        classes_[objects_.size() - 1] =
            plain.several ? kAsMaterial
                          : static_cast<std::uint8_t>(Kind{*plain.form, plain.material.scattering}.index());
    }
}

std::size_t PlainSurfaces::class_by_material(const Hit& hit) const {
    const PlainObject& object = objects_[hit.object];
    const PlainMaterial& material = material_at(hit, object);
    return material.bsdf == nullptr ? kOther : Kind{*object.form, material.scattering}.index();
}

} // namespace duet::raytrace
