#include "common/scene/default_scene.h"
#include "common/scene/file_cache.h"
#include "common/scene/json/json_reader.h"
#include "common/scene/json/read_camera.h"
#include "common/scene/json/read_lights.h"
#include "common/scene/json/read_materials.h"
#include "common/scene/json/read_media.h"
#include "common/scene/json/read_objects.h"
#include "common/scene/json/scene_keys.h"
#include "common/scene/motion_bounds.h"
#include "common/scene/scene.h"
#include "common/system/error.h"
#include "common/system/file.h"

namespace duet {

namespace {

void read_image_settings(const JsonValue& image, Scene& scene) {
    image.check_keys(scene_keys("image"));
    if (image.has("width")) scene.width = image.at("width").integer(1, kMaxRenderSide);
    if (image.has("height")) scene.height = image.at("height").integer(1, kMaxRenderSide);
    const long long pixels = static_cast<long long>(scene.width) * scene.height;
    if (pixels > kMaxImagePixels)
        image.fail(
            message("found ", pixels, " pixels, expected at most ", kMaxImagePixels, "; --size may ask for more"));
    ViewTransform& view = scene.view_transform;
    view.exposure = static_cast<float>(image.number_or("exposure", 0, {-kMaxExposure, kMaxExposure}));
    if (image.has("tone")) view.tone = static_cast<Tone>(image.at("tone").one_of(kTones.names()));
    view.dither = image.boolean_or("dither", false);
}

Scene read_scene(const std::filesystem::path& path, std::string_view text, FileCache* cache) {
    const JsonNode root = parse_json(path, text);
    const JsonValue file(root, path);
    file.check_keys(scene_keys("scene"));
    for (const std::string_view remark : {"$schema", "description"})
        if (file.has(remark)) file.at(remark).string();

    Scene scene;
    scene.path = path;
    scene.files = {path};
    scene.camera = read_camera(file.at("camera"));
    if (file.has("image")) read_image_settings(file.at("image"), scene);
    ImageCache images(scene, cache);
    NameIndex textures, materials;
    if (file.has("textures")) textures = read_textures(file.at("textures"), scene, images);
    if (file.has("materials")) materials = read_materials(file.at("materials"), textures, scene);
    read_objects(file.at("objects"), materials, images, scene);
    if (file.has("lights"))
        for (const JsonValue& light : file.at("lights").elements()) scene.lights.push_back(read_light(light));
    if (file.has("media")) read_media(file.at("media"), scene, cache);
    if (file.has("environment")) scene.environment = read_environment(file.at("environment"), scene.files);
    return scene;
}

/// The rasterizer computes the positions of polygons in double precision, relative to the eye. The point that the
/// camera looks at is accurate to 1e-3 of its distance if no corner is farther away than this many times that distance.
constexpr double kMaxReach = 1e13;

/// Throws Error if an object of polygons is too large to be seen from where the camera is.
void check_reach(const Scene& scene) {
    const Camera& camera = scene.camera;
    const bool orthographic = camera.projection == Camera::Projection::kOrthographic;
    const double view = orthographic ? camera.height : length(camera.look_at - camera.eye);
    for (const Object& object : scene.objects) {
        const Shape& shape = scene.shapes[object.shape];
        if (std::holds_alternative<Sphere>(shape)) continue;
        const Box3 box = motion_bounds(object, shape);
        if (box.empty()) continue;
        const double reach = length(max(abs(Vec3d(box.low) - camera.eye), abs(Vec3d(box.high) - camera.eye)));
        if (reach > kMaxReach * view)
            throw Error(message(scene.path.string(), ": the object ", quoted_text(object.name), " reaches ", reach,
                                " m from the eye, more than 1e13 times the ", view, " m that the camera ",
                                orthographic ? "shows" : "looks at", ": make it smaller, or look farther"));
    }
}

Scene finished(Scene scene, Transforms transforms = Transforms::kBaked) {
    finish_scene(scene, transforms);
    check_reach(scene);
    return scene;
}

} // namespace

Scene load_scene(const std::filesystem::path& path) { return load_scene(path, UpAxis::kGuessed); }

Scene load_scene(const std::filesystem::path& path, UpAxis up) {
    const std::string extension = lower_case_extension(path);
    if (extension != ".json" && extension != ".obj")
        throw Error(message(path.string(), ": expected a scene file (.json) or a mesh (.obj)"));
    if (extension == ".json" && up != UpAxis::kGuessed)
        throw Error(message(path.string(), ": --up turns a bare mesh (.obj); in a scene file a transform does it"));
    return extension == ".obj" ? finished(default_scene_for_mesh(path, up))
                               : parse_scene(path, read_file(path, kMaxSceneBytes));
}

Scene parse_scene(const std::filesystem::path& path, std::string_view text) {
    return finished(read_scene(path, text, nullptr));
}

Scene parse_scene(const std::filesystem::path& path, std::string_view text, FileCache& cache,
                  Transforms transforms) {
    const auto lock = cache.lock();
    return finished(read_scene(path, text, &cache), transforms);
}

} // namespace duet
