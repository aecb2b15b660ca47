// The library's camera (common/camera/camera.h): Pinhole::project, and its matrix for two simple images.
#include "common/camera/camera.h"
#include "raster/lessons/04-camera/lab.h"

namespace duet::lab {

namespace {

Pinhole pinhole(const View& v, int width, int height) {
    Camera camera;
    camera.eye = Vec3d(v.eye), camera.look_at = Vec3d(v.target), camera.up = Vec3d(v.up);
    camera.fov_degrees = degrees(static_cast<double>(v.fov));
    return CameraModel(duet::View{camera, width, height}).pinhole();
}

} // namespace

Mat4 look_at(Vec3 eye, Vec3 target, Vec3 up) {
    // With a field of view of 90 degrees and 2 × 2 pixels, pixel_x = 1 + x / w and pixel_y = 1 - y / w.
    const Mat4d pixel = pinhole({eye, target, up, kPi / 2, 0.1f, 1}, 2, 2).world_to_pixel;
    Mat4d m;
    for (std::size_t i = 0; i < 4; ++i) {
        m[0][i] = pixel[0][i] - pixel[3][i];
        m[1][i] = pixel[3][i] - pixel[1][i];
        m[2][i] = -pixel[2][i];
    }
    return Mat4(m);
}

Mat4 perspective(float fov, float aspect, float near, float far) {
    const Mat4d pixel = pinhole({{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, fov, near, far}, 2, 2).world_to_pixel;
    Mat4 m;
    m[0][0] = static_cast<float>(pixel[0][0]) / aspect;
    m[1][1] = static_cast<float>(-pixel[1][1]);
    m[2] = {0, 0, far / (near - far), near * far / (near - far)}; // the library has no far plane
    m[3] = {0, 0, -1, 0};
    return m;
}

Vec3 to_image(Vec4 clip, int width, int height) {
    // The point at distance w whose x and y are those of clip, seen by a camera whose field of view makes f = 1.
    const View view{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, kPi / 2, 0.1f, 1};
    const double aspect = static_cast<double>(width) / height;
    const double x = static_cast<double>(clip.x), y = static_cast<double>(clip.y), w = static_cast<double>(clip.w);
    const Vec3d p = pinhole(view, width, height).project({x * aspect, y, -w});
    return {static_cast<float>(p.x), static_cast<float>(p.y), clip.z / clip.w};
}

std::optional<Vec3> project(Vec3 p, const View& view, int width, int height) {
    const Vec3d seen = pinhole(view, width, height).project(Vec3d(p));
    if (seen.z <= 0) return std::nullopt;
    const double near = static_cast<double>(view.near), far = static_cast<double>(view.far);
    return Vec3(Vec3d(seen.x, seen.y, (1 - near / seen.z) / (1 - near / far)));
}

} // namespace duet::lab
