#include "common/scene/json/scene_keys.h"

#include "common/system/error.h"

#include <algorithm>

namespace duet {

const std::vector<JsonKeys>& scene_keys() {
    static const std::vector<JsonKeys> all = {
        {"scene",
         {"camera", "objects"},
         {"$schema", "description", "image", "textures", "materials", "lights", "environment", "media"}},
        {"perspective",
         {"eye", "look_at"},
         {"projection", "up", "fov_degrees", "near", "aperture_radius", "focus_distance", "shutter"}},
        {"orthographic", {"projection", "eye", "look_at"}, {"up", "height", "near", "shutter"}},
        {"image", {}, {"width", "height", "exposure", "tone", "dither"}},

        {"image_texture", {"type", "file"}, {"scale", "filter", "values", "channel"}},
        {"checker_texture", {"type"}, {"even", "odd", "scale", "solid"}},
        {"noise_texture", {"type"}, {"low", "high", "scale", "octaves", "marble"}},
        {"texture_slot", {"texture"}, {"tint"}},
        {"scalar_slot", {"texture"}, {"scale"}},
        {"map", {"texture"}, {"scale"}},

        {"diffuse", {"type"}, {"albedo", "roughness", "normal", "bump", "opacity", "cutoff"}},
        {"metal", {"type"}, {"reflectance", "conductor", "roughness", "normal", "bump", "opacity", "cutoff"}},
        {"dielectric",
         {"type"},
         {"ior", "tint", "roughness", "thin", "absorption", "priority", "normal", "bump", "opacity", "cutoff"}},
        {"absorption", {"color", "distance"}, {}},
        {"principled",
         {"type"},
         {"base_color", "metallic", "roughness", "ior", "clearcoat", "clearcoat_roughness", "subsurface",
          "mean_free_path", "normal", "bump", "opacity", "cutoff"}},
        {"coated", {"type"}, {"albedo", "roughness", "ior", "normal", "bump", "opacity", "cutoff"}},
        {"subsurface",
         {"type"},
         {"albedo", "mean_free_path", "measured", "scale", "roughness", "ior", "normal", "bump", "opacity", "cutoff"}},
        {"emissive", {"type", "radiance"}, {"radiance_texture", "two_sided", "albedo", "normal", "bump"}},

        {"quad", {"type", "corner", "u", "v", "material"}, {"name", "transform", "transform_end"}},
        {"sphere", {"type", "center", "radius", "material"}, {"name", "transform", "transform_end"}},
        {"box", {"type", "low", "high", "material"}, {"name", "transform", "transform_end"}},
        {"mesh", {"type", "file"}, {"name", "material", "normals", "transform", "transform_end"}},
        {"group", {"type", "objects"}, {"name", "hidden", "transform", "transform_end"}},
        {"instance", {"type", "of"}, {"name", "transform", "transform_end"}},

        {"translate", {"translate"}, {}},
        {"scale", {"scale"}, {}},
        {"rotate", {"rotate_degrees", "axis"}, {}},
        {"matrix", {"matrix"}, {}},

        {"point", {"type", "position", "intensity"}, {}},
        {"spot", {"type", "position", "direction", "intensity"}, {"inner_degrees", "outer_degrees"}},
        {"sun", {"type", "direction", "irradiance"}, {}},

        {"constant_environment", {"type", "radiance"}, {}},
        {"sky_environment", {"type"}, {"down", "up"}},
        {"image_environment", {"type", "file"}, {"scale", "rotate_degrees"}},

        {"fog", {"type"}, {"low", "high", "scattering", "absorption", "radiance", "asymmetry"}},
        {"cloud",
         {"type", "low", "high"},
         {"scattering", "absorption", "radiance", "asymmetry", "scale", "octaves", "coverage", "softness",
          "resolution"}},
        {"smoke", {"type", "low", "high", "file", "resolution"}, {"scattering", "absorption", "radiance", "asymmetry"}},
    };
    return all;
}

const JsonKeys& scene_keys(std::string_view kind) {
    const std::vector<JsonKeys>& all = scene_keys();
    const auto found = std::find_if(all.begin(), all.end(), [&](const JsonKeys& keys) { return keys.kind == kind; });
    DUET_CHECK(found != all.end());
    return *found;
}

} // namespace duet
