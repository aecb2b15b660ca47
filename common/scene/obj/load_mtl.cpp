#include "common/scene/obj/load_mtl.h"

#include "common/scene/json/read_materials.h"
#include "common/scene/obj/obj_check.h"
#include "common/scene/obj/obj_text.h"
#include "common/system/error.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <istream>

namespace duet {

namespace {

/// Returns a color clamped to [0, 1]. Some exporters write slightly larger values, and some scale to 255, but no
/// surface reflects more than 1.
Rgb reflectance(const tinyobj::real_t* c) {
    return {clamp(c[0], 0.0f, 1.0f), clamp(c[1], 0.0f, 1.0f), clamp(c[2], 0.0f, 1.0f)};
}

/// Returns the perceptual roughness √alpha of a Phong exponent Ns, with alpha² = 2 / (Ns + 2) (Walter et al. 2007,
/// §5.2, after Blinn).
float roughness_of_exponent(float ns) { return std::sqrt(std::sqrt(2.0f / (max(ns, 0.0f) + 2.0f))); }

bool is_glass(const tinyobj::material_t& m) {
    return m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9 || (m.dissolve < 1 && m.ior > 1);
}

/// TextureList collects the images that a material's lines name, in the order in which they are added.
class TextureList {
public:
    explicit TextureList(const std::filesystem::path& mtl) : mtl_(&mtl) {}

    /// Adds an image and returns its index, or −1 where none is named.
    std::int32_t add(const std::string& name, const tinyobj::texture_option_t& options,
                     ChannelSelection selection = {}) {
        std::string file_name = trimmed(name);
        if (file_name.empty()) return -1;
        std::replace(file_name.begin(), file_name.end(), '\\', '/');
        list_.push_back({resolve_path(*mtl_, file_name), {options.scale[0], options.scale[1]}, selection});
        return static_cast<std::int32_t>(list_.size()) - 1;
    }
    std::vector<ObjTexture> list() && { return std::move(list_); }

private:
    const std::filesystem::path* mtl_;
    std::vector<ObjTexture> list_;
};

constexpr ChannelSelection kGrayData{ChannelSelection::Values::kData, ChannelSelection::Channel::kRed};

/// Returns a number clamped to [0, 1] as a slot, times the texture where one is named. With a texture, a number of 0
/// counts as not given and becomes 1.
ScalarSlot scalar_slot(float number, const std::string& name, const tinyobj::texture_option_t& options,
                       TextureList& textures) {
    const std::int32_t map = textures.add(name, options, kGrayData);
    const float clamped = clamp(number, 0.0f, 1.0f);
    return map >= 0 ? ScalarSlot{clamped > 0 ? clamped : 1.0f, map} : ScalarSlot{clamped};
}

ScalarSlot roughness_of(const tinyobj::material_t& m, TextureList& textures) {
    return scalar_slot(m.roughness, m.roughness_texname, m.roughness_texopt, textures);
}

/// uses_pbr_extension returns whether the material uses the PBR extension. Default values do not count: a default
/// roughness Pr of 0 would make every surface look varnished.
bool is_metallic(const tinyobj::material_t& m) { return m.metallic > 0 || !m.metallic_texname.empty(); }
bool uses_pbr_extension(const tinyobj::material_t& m) {
    return is_metallic(m) || m.roughness > 0 || !m.roughness_texname.empty() || m.clearcoat_thickness > 0;
}

Principled principled_material(const tinyobj::material_t& m, const RgbSlot& color, TextureList& textures) {
    Principled result;
    result.base_color = color;
    result.metallic = scalar_slot(m.metallic, m.metallic_texname, m.metallic_texopt, textures);
    result.roughness = roughness_of(m, textures);
    if (m.ior > 1) result.ior = min(m.ior, 4.0f);
    result.clearcoat = clamp(m.clearcoat_thickness, 0.0f, 1.0f);
    result.clearcoat_roughness = clamp(m.clearcoat_roughness, 0.0f, 1.0f);
    return result;
}

Material map_material(const tinyobj::material_t& m, TextureList& textures) {
    const Rgb kd = reflectance(m.diffuse), ks = reflectance(m.specular), tf = reflectance(m.transmittance);
    const Rgb ke{m.emission[0], m.emission[1], m.emission[2]};
    const auto diffuse = [&]() -> RgbSlot { return {kd, textures.add(m.diffuse_texname, m.diffuse_texopt)}; };
    const std::int32_t map_ke = textures.add(m.emissive_texname, m.emissive_texopt);
    if (!is_black(ke) || map_ke >= 0) return Emissive{is_black(ke) ? Rgb(1.0f) : ke, false, diffuse(), map_ke};
    if (is_glass(m)) return Dielectric{m.ior > 1 ? min(m.ior, 4.0f) : 1.5f, {is_black(tf) ? Rgb(1.0f) : tf}};
    if (!is_metallic(m) && (m.illum == 3 || m.illum == 5) && !is_black(ks)) {
        const RgbSlot specular{ks, textures.add(m.specular_texname, m.specular_texopt)};
        const ScalarSlot rough = roughness_of(m, textures);
        return Metal{specular,
                     rough.constant() && rough.value == 0 ? ScalarSlot{roughness_of_exponent(m.shininess)} : rough};
    }
    if (uses_pbr_extension(m)) return principled_material(m, diffuse(), textures);
    return Diffuse{diffuse()};
}

/// MTL files do not define the unit of bump heights, so a height of 1 is assumed to be this many meters.
constexpr float kMetersPerBumpUnit = 0.01f;

SurfaceMaps map_surface(const tinyobj::material_t& m, const Material& material, TextureList& textures) {
    SurfaceMaps maps;
    maps.normal = textures.add(m.normal_texname, m.normal_texopt, {ChannelSelection::Values::kData});
    maps.bump = textures.add(m.bump_texname, m.bump_texopt, kGrayData);
    maps.bump_scale = kMetersPerBumpUnit * m.bump_texopt.bump_multiplier;
    if (std::holds_alternative<Emissive>(material)) return maps; // emitters have no opacity map
    const std::int32_t map_d = textures.add(m.alpha_texname, m.alpha_texopt,
                                            {ChannelSelection::Values::kData, ChannelSelection::Channel::kOpacity});
    const float d = std::holds_alternative<Dielectric>(material) ? 1.0f : clamp(m.dissolve, 0.0f, 1.0f);
    maps.opacity = {map_d >= 0 && d == 0 ? 1.0f : d, map_d};
    return maps;
}

} // namespace

void load_mtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials) {
    ObjText text(path);
    std::istream stream(&text);
    stream.exceptions(std::ios::badbit);
    check_mtl(path, stream);
    stream.clear();
    text.rewind();
    std::map<std::string, int> ignored_names;
    std::vector<tinyobj::material_t> parsed;
    std::string warnings, errors;
    tinyobj::LoadMtl(&ignored_names, &parsed, &stream, &warnings, &errors);
    for (const tinyobj::material_t& m : parsed) {
        if (trimmed(m.name).empty()) continue; // tinyobjloader's unnamed entry for the start of a file
        for (const float e : m.emission)
            if (!(e >= 0 && e <= kLightRange.high))
                throw Error(message(path.string(), ": the material ", quoted_text(m.name), " has Ke ", e,
                                    ", expected at least 0 and at most 1e12"));
        MtlMaterial entry{};
        TextureList textures(path);
        entry.material = map_material(m, textures);
        entry.maps = map_surface(m, entry.material, textures);
        entry.textures = std::move(textures).list();
        materials.emplace(trimmed(m.name), std::move(entry));
    }
}

} // namespace duet
