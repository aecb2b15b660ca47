#include "common/scene/default_scene.h"

#include "common/scene/build_scene.h"
#include "common/scene/obj/add_obj_materials.h"
#include "common/system/error.h"

namespace duet {

namespace {

constexpr double kMargin = 1.12;    ///< ratio of the image's size to the mesh's size in it
constexpr double kGroundExtent = 60; ///< half the ground's side length, in radii of the mesh

/// The sun shines from the camera's left and steeply, so that the shading reveals the shape and the shadow is short.
const Vec3d kSunDirection = normalize(Vec3d(0.75, -1.5, -0.45));

/// Returns the rotation that turns an axis of the file to y. It only exchanges coordinates, so it is exact.
Mat4 turned_up(UpAxis up) {
    Mat4 m;
    if (up == UpAxis::kX) m[0] = {0, -1, 0, 0}, m[1] = {1, 0, 0, 0};
    if (up == UpAxis::kZ) m[1] = {0, 0, 1, 0}, m[2] = {0, -1, 0, 0};
    return m;
}

/// Returns the area of the mesh's underside along an axis (0 to 2), as a fraction of the area of its bounds seen along
/// that axis. The underside consists of the triangles that lie in the lowest 2 % of the mesh.
double flat_base(const Mesh& mesh, const Box3d& box, std::size_t axis) {
    const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
    const Vec3d size = box.diagonal();
    const double limit = box.low[axis] + 0.02 * size[axis];
    double area = 0;
    for (const auto& triangle : mesh.triangles) {
        const Vec3d p(mesh.positions[triangle[0]]), q(mesh.positions[triangle[1]]), r(mesh.positions[triangle[2]]);
        if (max(max(p[axis], q[axis]), r[axis]) > limit) continue;
        area += 0.5 * abs((q[a] - p[a]) * (r[b] - p[b]) - (q[b] - p[b]) * (r[a] - p[a]));
    }
    return area > 0 ? area / (size[a] * size[b]) : 0;
}

UpAxis guessed_up(const Mesh& mesh, const Box3d& box) {
    constexpr double kFlat = 0.1; // a base covers this fraction of the bounds at least
    return flat_base(mesh, box, 2) >= kFlat && flat_base(mesh, box, 1) < kFlat ? UpAxis::kZ : UpAxis::kY;
}

Box3d bounds_of(const std::vector<Vec3d>& points) {
    Box3d box;
    for (const Vec3d p : points) box.extend(p);
    return box;
}

/// Returns a camera that looks at the points from the front, right and above, at the smallest distance from which all
/// of them are in the image with a margin of kMargin.
Camera frame(const std::vector<Vec3d>& points, int width, int height) {
    Camera camera;
    camera.fov_degrees = 35;
    camera.look_at = bounds_of(points).center();
    const Vec3d back = normalize(Vec3d(0.55, 0.3, 1)); // direction from the mesh to the eye
    const Vec3d right = normalize(cross(Vec3d(0, 1, 0), back)), up = cross(back, right);
    const double tan_y = std::tan(radians(camera.fov_degrees / 2)) / kMargin;
    const double tan_x = tan_y * width / height;
    double distance = 0; // smallest distance with |x| ≤ (distance − z)·tan for each point
    for (const Vec3d p : points) {
        const Vec3d d = p - camera.look_at;
        distance = max(distance, dot(d, back) + max(abs(dot(d, right)) / tan_x, abs(dot(d, up)) / tan_y));
    }
    camera.eye = camera.look_at + back * distance;
    camera.near = 1e-4 * distance;
    return camera;
}

} // namespace

Scene default_scene_for_mesh(const std::filesystem::path& path, UpAxis up) {
    ObjFile obj = load_obj(path, {MeshNormals::kAuto, true});
    Scene scene;
    scene.path = path;
    scene.files = obj.files;
    ImageCache images(scene);
    Object object;
    object.name = path.stem().string();
    object.materials = add_obj_materials(path, obj, images, scene);

    std::vector<Vec3d> points(obj.mesh.positions.begin(), obj.mesh.positions.end());
    const Box3d file_box = bounds_of(points);
    const double radius = 0.5 * length(file_box.diagonal());
    if (!(radius > 1e-6 * max_component(max(abs(file_box.low), abs(file_box.high)))) || radius < 1e-15 || radius > 1e15)
        throw Error(path.string() + ": the mesh is too small or too large to be framed by a camera");
    object.place(turned_up(up == UpAxis::kGuessed ? guessed_up(obj.mesh, file_box) : up));

    for (Vec3d& p : points) p = transform_point(Mat4d(object.to_world), p);
    const Box3d box = bounds_of(points);
    // A gap below the mesh avoids z-fighting between a flat underside and the ground.
    const double ground = box.low.y - 1e-3 * radius, half_side = kGroundExtent * radius;
    for (std::size_t i = 0, count = points.size(); i < count; ++i) // the shadow on the ground must be visible, too
        points.push_back(points[i] + kSunDirection * ((points[i].y - ground) / -kSunDirection.y));
    scene.camera = frame(points, scene.width, scene.height);

    const Vec3d center = box.center();
    Object floor;
    floor.name = "ground";
    floor.shape = 1;
    floor.materials = {add_material(scene, "ground", Diffuse{{Rgb(0.3f)}})}; // darker than the sky at the horizon
    scene.shapes.push_back(std::move(obj.mesh));
    // Two sides of the ground are parallel to the image's horizontal axis, so that its far edge is level.
    const Vec3d forward = scene.camera.look_at - scene.camera.eye;
    const Vec3d away = half_side * normalize(Vec3d(forward.x, 0, forward.z)), right = cross(away, Vec3d(0, 1, 0));
    const Vec3d middle(center.x, ground, center.z);
    scene.shapes.push_back(QuadList{{Quad{Vec3(middle - right - away), Vec3(2.0 * right), Vec3(2.0 * away)}}});
    scene.objects = {std::move(object), std::move(floor)};
    scene.lights.push_back(SunLight{Vec3(kSunDirection), Rgb(3.1f, 2.75f, 2.3f)});
    scene.environment = SkyEnvironment{Rgb(0.62f, 0.6f, 0.56f), Rgb(0.28f, 0.4f, 0.62f)};
    return scene;
}

} // namespace duet
