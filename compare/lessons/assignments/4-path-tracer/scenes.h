// The lights and rooms of which the examiner asks for images.
#pragma once

#include "compare/lessons/assignments/4-path-tracer/lab.h"

#include <vector>

namespace duet::grading {

using lab::Quad;
using lab::Scene;

/// A level light of side 2·half at height h above the origin, shining down with radiance 1.
inline Quad ceiling_light(float half, float h) {
    return {{-half, h, -half}, {2 * half, 0, 0}, {0, 0, 2 * half}, Rgb(0), Rgb(1)};
}

/// A room of six walls that look inward, [-1, 1]³; each shines with `emission` and reflects `albedo`.
inline Scene closed_room(float albedo, float emission) {
    Scene scene;
    const auto wall = [&](Vec3 corner, Vec3 u, Vec3 v) {
        scene.lights.push_back(static_cast<int>(scene.quads.size()));
        scene.quads.push_back({corner, u, v, Rgb(albedo), Rgb(emission)});
    };
    wall({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}); // floor, normal +y
    wall({-1, 1, -1}, {2, 0, 0}, {0, 0, 2});  // ceiling
    wall({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}); // back, normal +z
    wall({-1, -1, 1}, {0, 2, 0}, {2, 0, 0});  // front
    wall({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}); // left, normal +x
    wall({1, -1, -1}, {0, 0, 2}, {0, 2, 0});  // right
    return scene;
}

/// A room that is open in front, with a red and a green wall, a block, and two lights of very different size.
inline Scene colored_room() {
    Scene scene;
    const auto add = [&](Vec3 corner, Vec3 u, Vec3 v, Rgb albedo, Rgb emission = Rgb(0)) {
        if (max_component(emission) > 0) scene.lights.push_back(static_cast<int>(scene.quads.size()));
        scene.quads.push_back({corner, u, v, albedo, emission});
    };
    const Rgb white(0.7f), red(0.63f, 0.07f, 0.05f), green(0.14f, 0.45f, 0.09f);
    add({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, white);
    add({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, white);
    add({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, white);
    add({-1, 0, -1}, {0, 2, 0}, {0, 0, 2}, red);
    add({1, 0, -1}, {0, 0, 2}, {0, 2, 0}, green);
    add({-0.6f, 0.7f, -0.6f}, {0, 0, 0.6f}, {0.6f, 0, 0.2f}, white); // the top of a block …
    add({-0.6f, 0, 0}, {0.6f, 0, 0.2f}, {0, 0.7f, 0}, white);        // … its front
    add({0, 0, 0.2f}, {0, 0, -0.6f}, {0, 0.7f, 0}, white);           // … and its right side
    add({-0.25f, 1.98f, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f}, Rgb(0), Rgb(8, 7, 6));
    add({0.55f, 0.02f, -0.95f}, {0.4f, 0, 0}, {0, 1.0f, 0}, Rgb(0),
        Rgb(0.8f, 1.2f, 2)); // a large one close to the back wall
    return scene;
}

/// Rays from the camera before colored_room() through the pixels, row by row.
inline std::vector<Ray> camera_rays(int width, int height) {
    std::vector<Ray> rays;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double px = (x + 0.5) / width * 2 - 1, py = 1 - (y + 0.5) / height * 2;
            rays.push_back({{0, 1, 4.2f}, normalize(Vec3(Vec3d(px * 0.36, py * 0.36, -1)))});
        }
    return rays;
}

} // namespace duet::grading
