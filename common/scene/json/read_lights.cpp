#include "common/scene/json/read_lights.h"

#include "common/image/image_file.h"
#include "common/scene/json/read_textures.h"
#include "common/scene/json/scene_keys.h"
#include "common/system/error.h"

namespace duet {

namespace {

/// Returns a direction, normalized. The file may give any length except zero.
Vec3d read_direction(const JsonValue& value) {
    const Vec3d v = value.vec3();
    if (v == Vec3d()) value.fail("a direction must not be the zero vector");
    return normalize_scaled(v);
}

Light read_spot(const JsonValue& value) {
    value.check_keys(scene_keys("spot"));
    SpotLight light;
    light.position = Vec3(value.at("position").vec3());
    light.direction = Vec3(read_direction(value.at("direction")));
    light.intensity = value.at("intensity").rgb(kLightRange);
    const double inner = value.number_or("inner_degrees", 20, {0, 180, false});
    const double outer = value.number_or("outer_degrees", 30, {0, 180, true});
    light.cos_inner = static_cast<float>(std::cos(radians(inner)));
    light.cos_outer = static_cast<float>(std::cos(radians(outer)));
    if (!(light.cos_inner > light.cos_outer)) value.fail("\"inner_degrees\" must be below \"outer_degrees\"");
    return light;
}

} // namespace

Light read_light(const JsonValue& value) {
    switch (value.at("type").one_of({"point", "spot", "sun"})) {
    case 0:
        value.check_keys(scene_keys("point"));
        return PointLight{Vec3(value.at("position").vec3()), value.at("intensity").rgb(kLightRange)};
    case 1:
        return read_spot(value);
    default:
        value.check_keys(scene_keys("sun"));
        return SunLight{Vec3(read_direction(value.at("direction"))), value.at("irradiance").rgb(kLightRange)};
    }
}

Environment read_environment(const JsonValue& value, std::vector<std::filesystem::path>& files) {
    switch (value.at("type").one_of({"constant", "sky", "image"})) {
    case 0:
        value.check_keys(scene_keys("constant_environment"));
        return ConstantEnvironment{value.at("radiance").rgb(kLightRange)};
    case 1: {
        value.check_keys(scene_keys("sky_environment"));
        SkyEnvironment sky;
        sky.down = value.rgb_or("down", sky.down, kLightRange);
        sky.up = value.rgb_or("up", sky.up, kLightRange);
        return sky;
    }
    default: {
        value.check_keys(scene_keys("image_environment"));
        const double scale = value.number_or("scale", 1, {0, 1e6, false});
        const double rotation = radians(value.number_or("rotate_degrees", 0));
        const std::filesystem::path file = resolve_path(value.file(), value.at("file").string());
        ImageRgb image;
        try {
            image = read_image(file);
        } catch (const Error& error) {
            value.at("file").fail(error.what());
        }
        for (const Rgb& pixel : image)
            if (!(pixel.r >= 0 && pixel.g >= 0 && pixel.b >= 0 && max_component(pixel) <= kLightRange.high))
                value.at("file").fail(file.string() +
                                      ": holds a radiance that is negative, not finite, or beyond 1e12");
        files.push_back(file);
        return make_image_environment(std::move(image), static_cast<float>(scale), static_cast<float>(rotation));
    }
    }
}

} // namespace duet
