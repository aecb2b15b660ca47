#include "common/scene/json/read_camera.h"

#include "common/scene/json/scene_keys.h"

namespace duet {

namespace {

void check_orientation(const JsonValue& value, const Camera& camera) {
    const Vec3d view = camera.look_at - camera.eye;
    if (!(length(view) > 1e-9 * max_component(abs(camera.eye))) || length(view) < 1e-18)
        value.at("look_at").fail("must not be where the eye is");
    const double up_length = length(camera.up);
    if (!(up_length > 0)) value.at("up").fail("must not be the zero vector");
    if (!(length(cross(view / length(view), camera.up / up_length)) > 1e-6))
        value.fail("\"up\" must not be parallel to the direction of view");
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

} // namespace duet
