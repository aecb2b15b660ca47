#include "common/scene/obj/load_mtl.h"

#include "common/scene/json/read_materials.h"
#include "common/scene/obj/obj_check.h"
#include "common/system/error.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <sstream>

namespace duet {

namespace {

/// A colour limited to [0, 1]: exporters write a little more, and some scale to 255, which no surface reflects.
Rgb reflectance(const tinyobj::real_t* c) {
    return {clamp(c[0], 0.0f, 1.0f), clamp(c[1], 0.0f, 1.0f), clamp(c[2], 0.0f, 1.0f)};
}

/// Perceptual roughness of a Phong exponent: alpha² = 2 / (Ns + 2) (Walter et al. 2007, §5.2, after Blinn), roughness =
/// √alpha.
float roughness_of_exponent(float ns) { return std::sqrt(std::sqrt(2.0f / (max(ns, 0.0f) + 2.0f))); }

bool is_glass(const tinyobj::material_t& m) {
    return m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9 || (m.dissolve < 1 && m.ior > 1);
}

Material map_material(const tinyobj::material_t& m, std::int32_t texture) {
    const Rgb kd = reflectance(m.diffuse), ks = reflectance(m.specular), tf = reflectance(m.transmittance);
    const Rgb ke{m.emission[0], m.emission[1], m.emission[2]};
    if (!is_black(ke)) return Emissive{ke, false, {kd, texture}};
    if (is_glass(m)) return Dielectric{m.ior > 1 ? min(m.ior, 4.0f) : 1.5f, {is_black(tf) ? Rgb(1.0f) : tf}};
    if (m.metallic >= 0.5f) return Metal{{kd, texture}, clamp(m.roughness, 0.0f, 1.0f)};
    if ((m.illum == 3 || m.illum == 5) && !is_black(ks))
        return Metal{{ks}, m.roughness > 0 ? min(m.roughness, 1.0f) : roughness_of_exponent(m.shininess)};
    return Diffuse{{kd, texture}};
}

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

} // namespace

void load_mtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials) {
    const std::string text = read_obj_text(path);
    check_mtl(path, text);
    std::istringstream stream(text);
    std::map<std::string, int> ignored_names;
    std::vector<tinyobj::material_t> parsed;
    std::string warnings, errors;
    tinyobj::LoadMtl(&ignored_names, &parsed, &stream, &warnings, &errors);
    for (const tinyobj::material_t& m : parsed) {
        if (trimmed(m.name).empty()) continue; // what tinyobjloader makes of a file's beginning
        for (const float e : m.emission)
            if (!(e >= 0 && e <= kLightRange.high))
                throw Error(message(path.string(), ": the material ", in_quotes(m.name), " has Ke ", e,
                                    ", expected at least 0 and at most 1e12"));
        MtlMaterial entry;
        std::string picture = trimmed(m.diffuse_texname);
        if (!picture.empty()) {
            std::replace(picture.begin(), picture.end(), '\\', '/');
            const tinyobj::texture_option_t& options = m.diffuse_texopt;
            entry.texture = {{beside(path, picture), {options.scale[0], options.scale[1]}}};
        }
        entry.material = map_material(m, picture.empty() ? -1 : 0);
        materials.emplace(trimmed(m.name), std::move(entry));
    }
}

} // namespace duet
