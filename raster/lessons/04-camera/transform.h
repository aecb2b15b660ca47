// From the world to the image: two matrices and a division.
#pragma once

#include "common/vec/matrix.h"

namespace duet::lesson {

/// World space to camera space: the eye at the origin, looking along -z, y up.
inline Mat4 look_at(Vec3 eye, Vec3 target, Vec3 up) {
    const Vec3 back = normalize(eye - target), right = normalize(cross(up, back)), top = cross(back, right);
    Mat4 m;
    m[0] = {right.x, right.y, right.z, -dot(right, eye)};
    m[1] = {top.x, top.y, top.z, -dot(top, eye)};
    m[2] = {back.x, back.y, back.z, -dot(back, eye)};
    return m;
}

/// Camera space to clip space. After the division by w, what is seen has x and y in [-1, 1], and z goes from 0 at
/// distance near to 1 at distance far. aspect is width / height; fov is the vertical angle of view in radians.
inline Mat4 perspective(float fov, float aspect, float near, float far) {
    const float f = 1 / std::tan(fov / 2);
    Mat4 m;
    m[0] = {f / aspect, 0, 0, 0};
    m[1] = {0, f, 0, 0};
    m[2] = {0, 0, far / (near - far), near * far / (near - far)};
    m[3] = {0, 0, -1, 0}; // w becomes the distance in front of the eye
    return m;
}

/// Clip space to the image: x and y in pixels from the upper left corner, z the depth, and in w what the division
/// divided by. w must be positive (the clipping lesson sees to that).
inline Vec4 to_image(Vec4 clip, int width, int height) {
    const float x = (1 + clip.x / clip.w) / 2, y = (1 - clip.y / clip.w) / 2;
    return {x * static_cast<float>(width), y * static_cast<float>(height), clip.z / clip.w, clip.w};
}

} // namespace duet::lesson
