// The camera by its three axes and by similar triangles.
#include "raster/lessons/04-camera/lab.h"

#include <cmath>

namespace duet::lab {

Mat4 look_at(Vec3 eye, Vec3 target, Vec3 up) {
    const Vec3 z = normalize(eye - target);
    const Vec3 x = normalize(cross(up, z));
    const Vec3 y = cross(z, x);
    Mat4 turn;
    turn[0] = {x.x, x.y, x.z, 0};
    turn[1] = {y.x, y.y, y.z, 0};
    turn[2] = {z.x, z.y, z.z, 0};
    Mat4 move = translation(-eye);
    return turn * move;
}

Mat4 perspective(float fov, float aspect, float near, float far) {
    const float f = 1 / std::tan(fov / 2);
    Mat4 m;
    m[0][0] = f / aspect;
    m[1][1] = f;
    m[2][2] = far / (near - far);
    m[2][3] = near * far / (near - far);
    m[3][2] = -1;
    m[3][3] = 0;
    return m;
}

Vec3 to_image(Vec4 clip, int width, int height) {
    const float x = clip.x / clip.w;
    const float y = clip.y / clip.w;
    const float z = clip.z / clip.w;
    const float column = (x + 1) / 2 * static_cast<float>(width);
    const float row = (1 - y) / 2 * static_cast<float>(height);
    return {column, row, z};
}

std::optional<Vec3> project(Vec3 p, const View& view, int width, int height) {
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    const Mat4 camera = look_at(view.eye, view.target, view.up);
    const Mat4 lens = perspective(view.fov, aspect, view.near, view.far);
    const Vec4 clip = lens * camera * Vec4(p, 1);
    if (clip.w <= 0) return std::nullopt;
    return to_image(clip, width, height);
}

} // namespace duet::lab
