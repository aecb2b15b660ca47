// Lesson 04: the camera. Writes rows of amphorae from three places, and figures of what the matrices do.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/system/parameters.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/03-z-buffer/framebuffer.h"
#include "raster/lessons/04-camera/mesh.h"
#include "raster/lessons/04-camera/transform.h"

using namespace duet;
using namespace duet::lesson;

constexpr int kWidth = 240, kHeight = 160, kScale = 3, kLargeWidth = kScale * kWidth, kLargeHeight = kScale * kHeight;

/// Draws a mesh in the colors of its normals. m is the product of all matrices: clip space from the mesh's space.
void draw_mesh(Framebuffer& target, const Mesh& mesh, const Mat4& m) {
    for (std::size_t i = 0; i < mesh.size(); i += 3) {
        const auto corner = [&](std::size_t k) { return to_image(m * Vec4(mesh[k].p, 1), kLargeWidth, kLargeHeight); };
        const Vec4 a = corner(i), b = corner(i + 1), c = corner(i + 2);
        for_each_pixel({a.x, a.y}, {b.x, b.y}, {c.x, c.y}, kLargeWidth, kLargeHeight, [&](int x, int y, Vec3 w) {
            const Rgb color = direction_color(mesh[i].n * w.x + mesh[i + 1].n * w.y + mesh[i + 2].n * w.z);
            target.write(x, y, dot(w, Vec3{a.z, b.z, c.z}), color * color); // squared, the colors are deeper
        });
    }
}

/// 34 amphorae in seven rows of five. One place of the front row is empty, so that right and left can be told apart.
ImageRgb view(const Mesh& mesh, const Mat4& clip_from_world, bool wrong_order = false) {
    Framebuffer large(kLargeWidth, kLargeHeight, Rgb(0.02f));
    for (int i = 0; i < 35; ++i) {
        const Mat4 place = translation(Vec3{static_cast<float>(i % 5 - 2), 0, -static_cast<float>(i / 5)} * 0.8f);
        if (i != 4) draw_mesh(large, mesh, wrong_order ? place * clip_from_world : clip_from_world * place);
    }
    return shrink(large.color, kScale);
}

/// What a matrix makes of camera space, and of the outline of all that the camera sees, from above: z becomes y.
ImageRgb map(const Mesh& mesh, const Mat4& camera_from_world, const Mat4& matrix, Vec3 scale) {
    Mat4 z_to_y;
    z_to_y.m = {{{scale.x, 0, 0, 0}, {0, 0, scale.y, scale.z}, {0, -0.1f, 0, 0.5f}, {0, 0, 0, 1}}};
    ImageRgb image = view(mesh, z_to_y * matrix * camera_from_world);
    const auto seen = [&](float x, float distance) {
        const Vec4 p = to_image(z_to_y * matrix * Vec4(x, 0, -distance, 1), kWidth, kHeight);
        return Vec2{p.x, p.y};
    };
    draw_path(image, {seen(-0.77f, 2), seen(0.77f, 2), seen(3.45f, 9), seen(-3.45f, 9), seen(-0.77f, 2)}, 1, Rgb(1));
    return image;
}

Mat4 camera(Vec3 eye, Vec3 to, float fov) { return perspective(fov, 1.5f, 0.1f, 40) * look_at(eye, to, {0, 1, 0}); }

int main(int argc, char** argv) {
    const Mesh mesh = read_obj(DUET_MODELS "meshes/amphora.obj");
    float fov = 0.6f, y = 1.6f, z = 3.6f;
    read_parameters(argc, argv, {{"field of view", fov, 0.1f, 2.2f, "radians"}, {"eye height", y, 0.3f, 8, "meters"},
                                 {"eye distance", z, 1.5f, 10, "meters"}});
    Mat4 front = camera({0, y, z}, {0, 0.1f, -1.5f}, fov);
    write_image("evidence.png", beside({view(mesh, front), view(mesh, camera({5, 5, 3}, {0, 0.2f, -2.2f}, 0.6f)),
                                        view(mesh, camera({0.4f, 0.25f, 0.9f}, {0.4f, 0.42f, -1}, 1.2f))}));
    const Mat4 eye = look_at({0.8f, 0.4f, 3}, {0, 0.4f, -2.4f}, {0, 1, 0});
    write_image("spaces.png", beside({map(mesh, eye, inverse_affine(eye), {0.157f, -0.235f, -0.64f}),
                                      map(mesh, eye, Mat4(), {0.157f, -0.235f, -1.29f}),
                                      map(mesh, eye, perspective(0.5f, 1.5f, 2, 9), {0.93f, 1.8f, -0.9f})}));
    Plot plot{.title = "Two similar triangles", .x_label = "meters in front of the eye", .y_label = "meters up"};
    plot.series = {{"line of sight", {{0, 0}, {4, 2}}}, {"image", {{1, 0}, {1, 0.5}}}, {"object", {{4, 0}, {4, 2}}}};
    write_image("mirrored.png", view(mesh, scaling(Vec3{-1, 1, 1}) * front)); // as if the camera's x pointed left
    write_image("order.png", view(mesh, front, true));
    write_image("transposed.png", view(mesh, transpose(front)));
    write_image("aspect.png", view(mesh, scaling(Vec3{1.5f, 1, 1}) * front)); // as if the aspect were 1
    front[3] = {0, 0, 0, 1}; // now w is 1, and the division changes nothing
    write_image("undivided.png", view(mesh, front));
    write_plot("similar.svg", plot);
}
