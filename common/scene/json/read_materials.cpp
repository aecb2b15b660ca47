#include "common/scene/json/read_materials.h"

#include "common/scene/json/scene_keys.h"
#include "common/system/error.h"
#include "common/system/suggestion.h"

#include <cmath>

namespace duet {

namespace {

RgbSlot read_slot(const JsonValue& owner, std::string_view key, const RgbSlot& fallback, const NameIndex& textures) {
    if (!owner.has(key)) return fallback;
    const JsonValue value = owner.at(key);
    if (value.is(JsonNode::Kind::kObject)) {
        value.check_keys(scene_keys("texture_slot"));
        return {value.rgb_or("tint", Rgb(1.0f)),
                static_cast<std::int32_t>(look_up(value.at("texture"), textures, "texture"))};
    }
    if (!value.is(JsonNode::Kind::kNumber) && !value.is(JsonNode::Kind::kArray))
        value.expected("a number, an array of 3 numbers, or {\"texture\": name}");
    return {value.rgb()};
}

std::int32_t read_texture_name(const JsonValue& name, const NameIndex& textures) {
    return static_cast<std::int32_t>(look_up(name, textures, "texture"));
}

ScalarSlot read_scalar(const JsonValue& owner, std::string_view key, const ScalarSlot& fallback,
                       const NameIndex& textures) {
    if (!owner.has(key)) return fallback;
    const JsonValue value = owner.at(key);
    if (value.is(JsonNode::Kind::kNumber)) return static_cast<float>(value.number(kUnit));
    if (!value.is(JsonNode::Kind::kObject)) value.expected("a number or {\"texture\": name}");
    value.check_keys(scene_keys("scalar_slot"));
    return {static_cast<float>(value.number_or("scale", 1, kUnit)), read_texture_name(value.at("texture"), textures)};
}

/// Reads a map of the form {"texture": name, "scale": number}. Both outputs keep their values where the key is
/// missing.
void read_map(const JsonValue& owner, std::string_view key, const NameIndex& textures, std::int32_t& texture,
              float& scale) {
    if (!owner.has(key)) return;
    const JsonValue value = owner.at(key);
    value.check_keys(scene_keys("map"));
    texture = read_texture_name(value.at("texture"), textures);
    scale = static_cast<float>(value.number_or("scale", scale));
}

SurfaceMaps read_maps(const JsonValue& value, const NameIndex& textures) {
    SurfaceMaps maps;
    read_map(value, "normal", textures, maps.normal, maps.normal_scale);
    read_map(value, "bump", textures, maps.bump, maps.bump_scale);
    maps.opacity = read_scalar(value, "opacity", maps.opacity, textures);
    maps.cutoff = static_cast<float>(value.number_or("cutoff", maps.cutoff, kUnit));
    return maps;
}

constexpr JsonRange kIor{1, 4, false};

float read_ior(const JsonValue& owner, float fallback) {
    return static_cast<float>(owner.number_or("ior", fallback, kIor));
}

/// Throws Error because `name` is none of the known names.
[[noreturn]] void fail_unknown(const JsonValue& name, std::string_view what,
                               const std::vector<std::string_view>& known) {
    name.fail(message("unknown ", what, " ", quoted_text(name.string()), suggestion_or_list(name.string(), known)));
}

Conductor read_conductor(const JsonValue& owner) {
    const JsonValue name = owner.at("conductor");
    if (owner.has("reflectance")) name.fail("expected no reflectance beside it: a conductor has its own");
    if (const auto found = find_conductor(name.string())) return *found;
    fail_unknown(name, "conductor", {conductor_names().begin(), conductor_names().end()});
}

const MeasuredSolid& read_measured_solid(const JsonValue& owner) {
    const JsonValue name = owner.at("measured");
    for (const char* key : {"albedo", "mean_free_path"})
        if (owner.has(key)) name.fail(message("expected no ", key, " beside it: what is measured has its own"));
    if (const MeasuredSolid* found = find_measured_solid(name.string())) return *found;
    std::vector<std::string_view> known;
    for (const MeasuredSolid& solid : measured_solids()) known.push_back(solid.name);
    fail_unknown(name, "solid", known);
}

/// Distances of a nanometer or more keep absorption coefficients finite.
constexpr JsonRange kAbsorptionDistance{1e-9, 1e18, false};

/// Reads {"color": …, "distance": …}, the transmittance of white light after a distance in meters. Returns the
/// absorption coefficients of the Beer-Lambert law in 1/m.
Rgb read_absorption(const JsonValue& value) {
    value.check_keys(scene_keys("absorption"));
    const Rgb color = value.at("color").rgb();
    // No finite coefficient gives a transmittance of exactly 0, so it is clamped.
    const Rgb transmittance(max(color.r, 1e-6f), max(color.g, 1e-6f), max(color.b, 1e-6f));
    const auto distance = static_cast<float>(value.at("distance").number(kAbsorptionDistance));
    return Rgb(-std::log(transmittance.r), -std::log(transmittance.g), -std::log(transmittance.b)) / distance;
}

Dielectric read_dielectric(const JsonValue& value, const NameIndex& textures) {
    value.check_keys(scene_keys("dielectric"));
    Dielectric material;
    material.ior = read_ior(value, material.ior);
    material.tint = read_slot(value, "tint", material.tint, textures);
    material.roughness = read_scalar(value, "roughness", material.roughness, textures);
    material.thin = value.boolean_or("thin", material.thin);
    if (value.has("absorption")) material.absorption = read_absorption(value.at("absorption"));
    if (value.has("priority")) material.priority = value.at("priority").integer(0, 100);
    for (const char* key : {"roughness", "absorption", "priority"})
        if (material.thin && value.has(key))
            value.at(key).fail("a thin dielectric has none: it is smooth, and has no inside");
    return material;
}

Coated read_subsurface(const JsonValue& value, const NameIndex& textures) {
    value.check_keys(scene_keys("subsurface"));
    Coated material;
    if (value.has("measured")) {
        const MeasuredSolid& solid = read_measured_solid(value);
        const auto scale = static_cast<float>(value.number_or("scale", 1, {0, 1e12, true}));
        material.albedo = {solid.albedo()};
        material.mean_free_path = solid.mean_free_path() * scale;
        material.ior = solid.ior;
    } else {
        if (value.has("scale")) value.at("scale").fail("expected no scale without a measured solid");
        material.albedo = read_slot(value, "albedo", {Rgb(0.8f)}, textures);
        material.mean_free_path = value.at("mean_free_path").rgb(kLightRange);
        material.ior = 1.4f;
    }
    material.ior = read_ior(value, material.ior);
    material.roughness = read_scalar(value, "roughness", 0.3f, textures);
    return material;
}

Principled read_principled(const JsonValue& value, const NameIndex& textures) {
    value.check_keys(scene_keys("principled"));
    Principled material;
    material.base_color = read_slot(value, "base_color", material.base_color, textures);
    material.metallic = read_scalar(value, "metallic", material.metallic, textures);
    material.roughness = read_scalar(value, "roughness", material.roughness, textures);
    material.ior = read_ior(value, material.ior);
    material.clearcoat = read_scalar(value, "clearcoat", material.clearcoat, textures);
    material.clearcoat_roughness = read_scalar(value, "clearcoat_roughness", material.clearcoat_roughness, textures);
    material.subsurface = read_scalar(value, "subsurface", material.subsurface, textures);
    if (value.has("mean_free_path")) material.mean_free_path = value.at("mean_free_path").rgb(kLightRange);
    if (value.has("subsurface") != value.has("mean_free_path"))
        value.fail("found only one of subsurface and mean_free_path, expected both or none");
    return material;
}

Material read_material(const JsonValue& value, const NameIndex& textures) {
    switch (value.at("type").one_of(
        {"diffuse", "metal", "dielectric", "principled", "coated", "subsurface", "emissive"})) {
    case 0: {
        value.check_keys(scene_keys("diffuse"));
        Diffuse material;
        material.albedo = read_slot(value, "albedo", material.albedo, textures);
        material.roughness = read_scalar(value, "roughness", material.roughness, textures);
        return material;
    }
    case 1: {
        value.check_keys(scene_keys("metal"));
        Metal material;
        if (value.has("conductor")) {
            material.conductor = read_conductor(value);
            material.reflectance = {material.conductor.f0};
        } else {
            material.reflectance = read_slot(value, "reflectance", material.reflectance, textures);
        }
        material.roughness = read_scalar(value, "roughness", material.roughness, textures);
        return material;
    }
    case 2:
        return read_dielectric(value, textures);
    case 3:
        return read_principled(value, textures);
    case 4: {
        value.check_keys(scene_keys("coated"));
        Coated material;
        material.albedo = read_slot(value, "albedo", material.albedo, textures);
        material.roughness = read_scalar(value, "roughness", material.roughness, textures);
        material.ior = read_ior(value, material.ior);
        return material;
    }
    case 5:
        return read_subsurface(value, textures);
    default: {
        value.check_keys(scene_keys("emissive"));
        Emissive material;
        material.radiance = value.at("radiance").rgb(kLightRange);
        if (value.has("radiance_texture"))
            material.radiance_texture = read_texture_name(value.at("radiance_texture"), textures);
        material.two_sided = value.boolean_or("two_sided", material.two_sided);
        material.albedo = read_slot(value, "albedo", material.albedo, textures);
        return material;
    }
    }
}

} // namespace

NameIndex read_materials(const JsonValue& materials, const NameIndex& textures, Scene& scene) {
    NameIndex index;
    for (const auto& [name, value] : materials.members()) {
        index[name] = static_cast<std::uint32_t>(scene.materials.size());
        scene.materials.push_back(read_material(value, textures));
        scene.maps.push_back(read_maps(value, textures));
        scene.material_names.push_back(name);
    }
    return index;
}

} // namespace duet
