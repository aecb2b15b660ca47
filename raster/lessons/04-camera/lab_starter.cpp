// Your camera. Write the functions from the top down: the last one uses the three before it.
#include "raster/lessons/04-camera/lab.h"

namespace duet::lab {

Mat4 look_at(Vec3 eye, Vec3 target, Vec3 up) {
    not_attempted(); // Remove this line when you start.
    (void)eye, (void)target, (void)up;
    // Compute the three axes of the camera first. Each is a row of the matrix, and m[row][column] is an entry.
    return Mat4();
}

Mat4 perspective(float fov, float aspect, float near, float far) {
    not_attempted(); // Remove this line when you start.
    (void)fov, (void)aspect, (void)near, (void)far;
    // A new Mat4 has ones on the diagonal. Which entries differ? What is the last row?
    return Mat4();
}

Vec3 to_image(Vec4 clip, int width, int height) {
    not_attempted(); // Remove this line when you start.
    (void)clip, (void)width, (void)height;
    // Divide by w. Then -1 becomes the left edge, and 1 the right one. Which y is the upper edge?
    return {};
}

std::optional<Vec3> project(Vec3 p, const View& view, int width, int height) {
    not_attempted(); // Remove this line when you start.
    (void)view;
    // For now there is no perspective: one meter is 40 pixels. Use the three functions above instead.
    return Vec3{static_cast<float>(width) / 2 + 40 * p.x, static_cast<float>(height) / 2 - 40 * p.y, 0.5f};
}

} // namespace duet::lab
