#include "common/scene/json/read_lights.h"

#include "common/image/image_file.h"
#include "common/scene/json/read_materials.h"
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

void check_orientation(const JsonValue& value, const Camera& camera) {
    const Vec3d view = camera.look_at - camera.eye;
    if (!(length(view) > 1e-9 * max_component(abs(camera.eye))) || length(view) < 1e-18)
        value.at("look_at").fail("must not be where the eye is");
    const double up_length = length(camera.up);
    if (!(up_length > 0)) value.at("up").fail("must not be the zero vector");
    if (!(length(cross(view / length(view), camera.up / up_length)) > 1e-6))
        value.fail("\"up\" must not be parallel to the direction of view");
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

Camera read_camera(const JsonValue& value) {
    if (!value.is(JsonNode::Kind::kObject)) value.expected("an object");
    Camera camera;
    if (value.has("projection") && value.at("projection").one_of({"perspective", "orthographic"}) == 1)
        camera.projection = Camera::Projection::kOrthographic;
    const bool perspective = camera.projection == Camera::Projection::kPerspective;
    value.check_keys(scene_keys(perspective ? "perspective" : "orthographic"));
    camera.eye = value.at("eye").vec3();
    camera.look_at = value.at("look_at").vec3();
    if (value.has("up")) camera.up = value.at("up").vec3();
    check_orientation(value, camera);
    camera.near = value.number_or("near", camera.near, kNotNegative);
    if (perspective) {
        camera.fov_degrees = value.number_or("fov_degrees", camera.fov_degrees, {0.001, 179, false});
        camera.aperture_radius = value.number_or("aperture_radius", camera.aperture_radius, kNotNegative);
        camera.focus_distance = value.number_or("focus_distance", camera.focus_distance, kNotNegative);
    } else {
        camera.height = value.number_or("height", camera.height, kPositive);
    }
    if (value.has("shutter")) {
        const std::vector<double> shutter = value.at("shutter").numbers(2, kUnit);
        if (shutter[0] > shutter[1]) value.at("shutter").fail("the shutter closes before it opens");
        camera.shutter_open = shutter[0];
        camera.shutter_close = shutter[1];
    }
    return camera;
}

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
