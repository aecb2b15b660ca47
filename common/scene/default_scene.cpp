#include "common/scene/default_scene.h"

#include "common/scene/obj/add_obj_materials.h"
#include "common/system/error.h"

namespace duet {

namespace {

constexpr double kMargin = 1.12;    ///< ratio of the image's size to the mesh's size in it
constexpr double kGroundExtent = 60; ///< half the ground's side length, in radii of the mesh

/// Returns a camera that looks at the mesh from the front, right and above, at the smallest distance from which the
/// whole mesh is in the image with a margin of kMargin.
Camera frame(const Mesh& mesh, const Box3d& box, int width, int height) {
    Camera camera;
    camera.fov_degrees = 35;
    camera.look_at = box.center();
    const Vec3d back = normalize(Vec3d(0.55, 0.42, 1)); // direction from the mesh to the eye
    const Vec3d right = normalize(cross(Vec3d(0, 1, 0), back)), up = cross(back, right);
    const double tan_y = std::tan(radians(camera.fov_degrees / 2)) / kMargin;
    const double tan_x = tan_y * width / height;
    double distance = 0; // smallest distance with |x| ≤ (distance − z)·tan for each vertex
    for (const Vec3 p : mesh.positions) {
        const Vec3d d = Vec3d(p) - camera.look_at;
        distance = max(distance, dot(d, back) + max(abs(dot(d, right)) / tan_x, abs(dot(d, up)) / tan_y));
    }
    camera.eye = camera.look_at + back * distance;
    camera.near = 1e-4 * distance;
    return camera;
}

} // namespace

Scene default_scene_for_mesh(const std::filesystem::path& path) {
    ObjFile obj = load_obj(path, {MeshNormals::kAuto, true});
    Scene scene;
    scene.path = path;
    scene.files = obj.files;
    ImageCache images(scene);
    Object object;
    object.name = path.stem().string();
    object.materials = add_obj_materials(path, obj, images, scene);

    Box3d box;
    for (const Vec3 p : obj.mesh.positions) box.extend(Vec3d(p));
    const double radius = 0.5 * length(box.diagonal());
    if (!(radius > 1e-6 * max_component(max(abs(box.low), abs(box.high)))) || radius < 1e-15 || radius > 1e15)
        throw Error(path.string() + ": the mesh is too small or too large to be framed by a camera");
    scene.camera = frame(obj.mesh, box, scene.width, scene.height);

    // A gap below the mesh avoids z-fighting between a flat underside and the ground.
    const double ground = box.low.y - 1e-3 * radius, half_side = kGroundExtent * radius;
    const Vec3d center = box.center();
    Object floor;
    floor.name = "ground";
    floor.shape = 1;
    floor.materials = {static_cast<std::uint32_t>(scene.materials.size())};
    scene.materials.push_back(Diffuse{{Rgb(0.5f)}});
    scene.material_names.push_back("ground");
    scene.shapes.push_back(std::move(obj.mesh));
    scene.shapes.push_back(QuadList{{Quad{Vec3(Vec3d(center.x - half_side, ground, center.z + half_side)),
                                          Vec3(Vec3d(2 * half_side, 0, 0)), Vec3(Vec3d(0, 0, -2 * half_side))}}});
    scene.objects = {std::move(object), std::move(floor)};
    // The sun shines from the camera's left, so that the shading reveals the shape. Sun and sky together light open
    // ground to about half of white.
    scene.lights.push_back(SunLight{Vec3(normalize(Vec3d(1, -1.15, -0.45))), Rgb(2.7f, 2.5f, 2.2f)});
    scene.environment = SkyEnvironment{Rgb(0.5f, 0.47f, 0.43f), Rgb(0.26f, 0.31f, 0.4f)};
    return scene;
}

} // namespace duet
