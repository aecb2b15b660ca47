// Lesson 04: the camera. Writes rows of amphorae from three places, and figures of what the matrices do.
#include "common/image/image_file.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/03-z-buffer/framebuffer.h"
#include "raster/lessons/04-camera/mesh.h"
#include "raster/lessons/04-camera/transform.h"

using namespace duet;
using namespace duet::lesson;

constexpr int kSize = 244, kLarge = 4 * kSize; // pictures are square, and drawn four times too large

/// Draws a mesh in the colors of its normals. clip_from_mesh is the product of all matrices.
void draw_mesh(Framebuffer& target, const Mesh& mesh, const Mat4& clip_from_mesh) {
    for (std::size_t i = 0; i < mesh.size(); i += 3) {
        const auto corner = [&](std::size_t k) {
            return to_picture(clip_from_mesh * Vec4(mesh[k].p, 1), kLarge, kLarge);
        };
        const Vec4 a = corner(i), b = corner(i + 1), c = corner(i + 2);
        for_each_pixel({a.x, a.y}, {b.x, b.y}, {c.x, c.y}, kLarge, kLarge, [&](int x, int y, Vec3 w) {
            const Rgb color = direction_color(mesh[i].n * w.x + mesh[i + 1].n * w.y + mesh[i + 2].n * w.z);
            target.write(x, y, dot(w, Vec3{a.z, b.z, c.z}), color * color); // squared, the colors are deeper
        });
    }
}

/// Where the amphorae stand: 35 places in seven rows of five.
Vec3 place(int i) { return Vec3{static_cast<float>(i % 5 - 2), 0, -static_cast<float>(i / 5)} * 0.8f; }

ImageRgb view(const Mesh& mesh, const Mat4& clip_from_world) {
    Framebuffer large(kLarge, kLarge, Rgb(0.02f));
    for (int i = 0; i < 35; ++i) draw_mesh(large, mesh, clip_from_world * translation(place(i)));
    return shrink(large.color, 4);
}

/// What a matrix makes of camera space, and of the outline of all that the camera sees, from above: z becomes y.
ImageRgb map(const Mesh& mesh, const Mat4& camera_from_world, const Mat4& matrix, Vec3 scale) {
    Mat4 z_to_y = scaling(Vec3{scale.x, 1, 1});
    z_to_y[1] = {0, 0, scale.y, scale.z};
    z_to_y[2] = {0, -0.1f, 0, 0.5f}; // what is higher is nearer
    ImageRgb image = view(mesh, z_to_y * matrix * camera_from_world);
    std::vector<Vec2> outline;
    for (const Vec2 p : {Vec2{-2, 2}, Vec2{2, 2}, Vec2{9, 9}, Vec2{-9, 9}, Vec2{-2, 2}}) {
        const Vec4 q = to_picture(z_to_y * matrix * Vec4(p.x * std::tan(0.35f), 0, -p.y, 1), kSize, kSize);
        outline.push_back({q.x, q.y});
    }
    draw_path(image, outline, 1, Rgb(1));
    return image;
}

Mat4 camera(Vec3 eye, Vec3 to, float fov) { return perspective(fov, 1, 0.1f, 40) * look_at(eye, to, {0, 1, 0}); }

int main() {
    const Mesh mesh = read_obj(DUET_MODELS "meshes/amphora.obj");
    Mat4 front = camera({0, 1.5f, 3.4f}, {0, 0.3f, -1.5f}, 0.7f), above = camera({5, 5, 3}, {0, 0.3f, -2.2f}, 0.7f);
    const Mat4 low = camera({0.4f, 0.25f, 0.7f}, {0.4f, 0.5f, -1}, 1.6f);
    write_image("evidence.png", beside({view(mesh, front), view(mesh, above), view(mesh, low)}));
    const Mat4 eye = look_at({0.8f, 0.4f, 3}, {0, 0.4f, -2.4f}, {0, 1, 0});
    write_image("spaces.png", beside({map(mesh, eye, inverse_affine(eye), {0.2f, -0.2f, -0.35f}),
                                      map(mesh, eye, Mat4(), {0.2f, -0.2f, -0.95f}),
                                      map(mesh, eye, perspective(0.7f, 1, 2, 9), {0.93f, 1.8f, -0.9f})}));
    const Mat4 close = camera({0, 0.45f, 1}, {0, 0.45f, 0}, 1.2f), far = camera({0, 0.45f, 15}, {0, 0.45f, 0}, 0.085f);
    write_image("distance.png", beside({view(mesh, close), view(mesh, far)}));
    front[3] = {0, 0, 0, 1}; // now w is 1, and the division changes nothing
    write_image("wrong.png", beside({view(mesh, front), view(mesh, scaling(Vec3{-1, 1, 1}) * above)}));
}
