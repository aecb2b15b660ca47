#include "compare/frames/frame_scene.h"

#include "common/image/image_file.h"
#include "common/scene/obj/load_obj.h"

#include <algorithm>

namespace duet::compare {

const char* name(FrameView view) { return view == FrameView::kWhole ? "whole" : "close"; }

Scene frame_scene(const std::filesystem::path& mesh, const std::filesystem::path& texture) {
    ObjFile file = load_obj(mesh, {MeshNormals::kAuto, false});
    Scene scene;
    scene.path = mesh;
    scene.files = file.files;
    scene.shapes.push_back(std::move(file.mesh));
    scene.materials = {Diffuse{{Rgb(0.7f, 0.65f, 0.6f)}}};
    scene.material_names = {"surface"};
    if (!texture.empty()) {
        scene.files.push_back(texture);
        scene.textures.images = {read_image(texture)};
        scene.textures.textures = {ImageTexture{}};
        scene.materials = {Diffuse{RgbSlot{Rgb(1.0f), 0}}};
    }
    Object object;
    object.name = mesh.stem().string();
    object.materials = {0};
    scene.objects = {object};
    scene.lights = {SunLight{Vec3(normalize(Vec3d(0.5, -1, -0.8))), Rgb(3.0f, 2.9f, 2.7f)}};
    scene.environment = ConstantEnvironment{Rgb(0.1f, 0.11f, 0.13f)};
    finish_scene(scene);
    return scene;
}

View frame_view(const Scene& scene, FrameView view, ImageSize size) {
    const Vec3d back = normalize(Vec3d(0.4, 0.3, 1)); // direction from the mesh to the eye
    const Vec3d right = normalize(cross(Vec3d(0, 1, 0), back)), up = cross(back, right);
    Camera camera;
    camera.fov_degrees = 30;
    camera.look_at = Vec3d(scene.bounds.center());
    const double tan_y = std::tan(radians(camera.fov_degrees / 2)), tan_x = tan_y * size.width / size.height;
    double distance = 0; // smallest distance that fits the whole mesh: |x| ≤ (distance − z)·tan for each vertex
    for (const Vec3 p : std::get<Mesh>(scene.shapes[0]).positions) {
        const Vec3d d = Vec3d(p) - camera.look_at;
        distance = max(distance, dot(d, back) + max(abs(dot(d, right)) / tan_x, abs(dot(d, up)) / tan_y));
    }
    camera.eye = camera.look_at + back * (1.02 * distance);
    camera.near = 1e-2 * distance;
    constexpr double kCloser = 2.4; // magnification by a smaller field of view, so that the eye stays outside
    if (view == FrameView::kClose) camera.fov_degrees = degrees(2 * std::atan(tan_y / kCloser));
    return {camera, size.width, size.height};
}

} // namespace duet::compare
