#include "compare/peers/export_materials.h"

#include "common/image/image_file.h"
#include "common/system/error.h"

namespace duet::compare {
namespace {

using nlohmann::json;

class MaterialExport {
public:
    MaterialExport(const std::filesystem::path& folder, const Scene& scene, std::set<std::string>& notes)
        : folder_(folder), scene_(scene), notes_(notes) {}

    json all() {
        std::set<std::uint32_t> used;
        for (const Object& o : scene_.objects) used.insert(o.materials.begin(), o.materials.end());
        json list = json::array();
        for (std::uint32_t i = 0; i < scene_.materials.size(); ++i) {
            if (used.contains(i) && (scene_.maps[i].perturbs_normal() || scene_.maps[i].has_transparency()))
                fail_unsupported(scene_, "normal maps, bump maps and opacity are not exported");
            json m = used.contains(i) ? material(scene_.materials[i]) : material(Diffuse{});
            m["name"] = scene_.material_names[i];
            list.push_back(std::move(m));
        }
        return list;
    }

private:
    json texture(std::int32_t index) {
        const Texture& t = scene_.textures.textures[static_cast<std::size_t>(index)];
        if (std::holds_alternative<NoiseTexture>(t)) fail_unsupported(scene_, "textures of noise have no counterpart");
        if (const auto* checker = std::get_if<CheckerTexture>(&t))
            return {{"type", "checker"},
                    {"even", rgb_json(checker->even)},
                    {"odd", rgb_json(checker->odd)},
                    {"scale", checker->scale},
                    {"solid", checker->solid}};
        const auto& image = std::get<ImageTexture>(t);
        const std::string name = message("texture-", image.image, ".exr");
        write_image(folder_ / name, scene_.textures.images[image.image]);
        return {{"type", "image"},
                {"file", name},
                {"scale", {image.scale.x, image.scale.y}},
                {"bilinear", image.filter != TextureFilter::kNearest}};
    }

    float constant(const ScalarSlot& slot, const char* what) {
        if (!slot.constant()) fail_unsupported(scene_, message("textures of ", what, " are not exported"));
        return slot.value;
    }

    void export_glass(const Dielectric& glass, json& result) {
        if (glass.thin) fail_unsupported(scene_, "thin glass has no counterpart");
        if (glass.priority > 0) fail_unsupported(scene_, "priorities of dielectrics have no counterpart");
        result["type"] = "dielectric";
        result["ior"] = glass.ior;
        const float roughness = constant(glass.roughness, "roughness");
        result["roughness"] = glass.smooth() ? 0 : roughness;
        result["absorption"] = rgb_json(glass.absorption);
        if (glass.smooth()) return;
        const bool clear = glass.tint.texture < 0 && glass.tint.value == Rgb(1.0f);
        notes_.insert(clear ? "what meets further microfacets of frosted glass goes ways of its own"
                            : "frosted glass takes Fresnel's term at the shading normal, and loses what meets further "
                              "microfacets");
    }

    /// Exports subsurface scattering with the color that is seen through the layers. Cycles expects radii for its
    /// random walk, and computes the mean free path as the radius times a function of the color. The exported radius is
    /// the mean free path divided by that function.
    void export_subsurface(const SubsurfaceBsdf& surface, Rgb color, json& result) {
        const auto radius = [&](std::size_t c) {
            const float factor = 1.9f - color[c] + 3.5f * sqr(color[c] - 0.8f); // Chiang, Kutz and Burley 2016
            return 1 / (factor * (surface.interior.scattering[c] + surface.interior.absorption[c]));
        };
        result["subsurface"] = {{"weight", surface.entering}, {"radius", {radius(0), radius(1), radius(2)}}};
        notes_.insert("solids are Blender's random walks, whose albedo follows from a fit of its own");
    }

    json material(const Material& m) {
        const RgbSlot& slot = texture_slot(m);
        json result = {
            {"slot",
             {{"value", rgb_json(slot.value)}, {"texture", slot.texture < 0 ? json(nullptr) : texture(slot.texture)}}}};
        if (const auto* metal = std::get_if<Metal>(&m)) {
            result["type"] = "metal";
            result["roughness"] = constant(metal->roughness, "roughness");
            if (metal->conductor.valid()) notes_.insert("named conductors have Schlick's Fresnel term");
            if (!metal->at(scene_.textures, SurfacePoint{}).smooth())
                notes_.insert("rough metal's Fresnel term is taken at the shading normal, not at the microfacet's");
        } else if (const auto* glass = std::get_if<Dielectric>(&m)) {
            export_glass(*glass, result);
        } else if (const auto* principled = std::get_if<Principled>(&m)) {
            result["type"] = "principled";
            result["metallic"] = constant(principled->metallic, "metalness");
            result["roughness"] = constant(principled->roughness, "roughness");
            result["ior"] = principled->ior;
            result["clearcoat"] = constant(principled->clearcoat, "clear coats");
            result["clearcoat_roughness"] = constant(principled->clearcoat_roughness, "roughness");
            if (has_subsurface(m))
                fail_unsupported(scene_, "subsurface scattering of principled materials is not exported");
            notes_.insert("principled materials are Blender's, whose layers are not quite ours");
        } else if (const auto* coated = std::get_if<Coated>(&m)) {
            if (coated->albedo.texture >= 0) fail_unsupported(scene_, "textures under a coat are not exported");
            result["type"] = "principled";
            // This albedo includes inter-reflection within the coat.
            const Rgb seen = coated->at(scene_.textures, SurfacePoint{}).diffuse;
            result["slot"]["value"] = rgb_json(seen);
            result["metallic"] = result["clearcoat"] = result["clearcoat_roughness"] = 0;
            result["roughness"] = constant(coated->roughness, "roughness");
            result["ior"] = coated->ior;
            if (has_subsurface(m))
                export_subsurface(coated->subsurface_at(scene_.textures, SurfacePoint{}), seen, result);
            notes_.insert("coated materials are Blender's principled ones, whose layers are not quite ours");
        } else if (const auto* emissive = std::get_if<Emissive>(&m)) {
            result["type"] = "emissive";
            if (emissive->radiance_texture >= 0) fail_unsupported(scene_, "textures of radiance are not exported");
            result["radiance"] = rgb_json(emissive->radiance);
            result["two_sided"] = emissive->two_sided;
        } else {
            result["type"] = "diffuse";
            const auto* diffuse = std::get_if<Diffuse>(&m);
            if (diffuse != nullptr && diffuse->rough())
                fail_unsupported(scene_, "rough diffuse surfaces have no counterpart");
        }
        return result;
    }

    const std::filesystem::path& folder_;
    const Scene& scene_;
    std::set<std::string>& notes_;
};

} // namespace

void fail_unsupported(const Scene& scene, const std::string& what) {
    throw Error(message(scene.path.string(), ": cannot be exported: ", what));
}

json rgb_json(Rgb c) { return {c.r, c.g, c.b}; }

json export_materials(const std::filesystem::path& folder, const Scene& scene, std::set<std::string>& notes) {
    return MaterialExport(folder, scene, notes).all();
}

} // namespace duet::compare
