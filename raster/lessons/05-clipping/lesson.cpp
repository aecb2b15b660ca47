// Lesson 05: clipping. Writes a lane that goes on behind the eye, with and without clipping.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/03-z-buffer/framebuffer.h"
#include "raster/lessons/05-clipping/fragments.h"

using namespace duet;
using namespace duet::lesson;

constexpr int kWidth = 396, kHeight = 300; // their ratio is 1.32

/// Two wrong ways to get the parts of a triangle that are drawn. The right one is clip_near.
std::vector<Triangle> no_clipping(const Triangle& triangle) { return {triangle}; }
std::vector<Triangle> drop_whole(const Triangle& t) {
    return t[0].clip.z < 0 || t[1].clip.z < 0 || t[2].clip.z < 0 ? std::vector<Triangle>() : std::vector{t};
}
using Clip = std::vector<Triangle>(const Triangle&);

/// Draws triangles in one color, or, if that is black, in the colors of their normals.
void draw(Framebuffer& target, const std::vector<Triangle>& triangles, Clip& clip, Rgb color) {
    for (const Triangle& triangle : triangles)
        for (const Triangle& part : clip(triangle))
            for_each_fragment(part, target.color.width(), target.color.height(), [&](int x, int y, float z, Vec3 w) {
                const Rgb normal = direction_color(part[0].n * w.x + part[1].n * w.y + part[2].n * w.z);
                target.write(x, y, z, is_black(color) ? normal * normal : color);
            });
}

/// A floor of planks, and two rows of amphorae on it. They begin behind the eye.
ImageRgb lane(const Mesh& amphora, const Mat4& camera, Clip& clip) {
    Framebuffer large(4 * kWidth, 4 * kHeight, Rgb(0.3f, 0.5f, 0.8f));
    for (int i = 0; i < 24 * 8; ++i) {
        const float x = static_cast<float>(i / 8 - 12) * 0.4f,
                    z = 5.4f - 2.5f * static_cast<float>(i % 8) + static_cast<float>(i / 8 % 3);
        const auto corner = [&](float dx, float dz) { return MeshVertex{{x + dx, 0, z + dz}, {0, 1, 0}, {}}; };
        const MeshVertex a = corner(0, 0), b = corner(0.4f, 0), c = corner(0.4f, -2.5f), d = corner(0, -2.5f);
        const Rgb wood = Rgb(0.3f, 0.16f, 0.07f) * (0.5f + 0.2f * static_cast<float>(i * 11 % 7));
        draw(large, in_clip_space({a, b, c, a, c, d}, camera), clip, wood);
    }
    for (int i = 0; i < 18; ++i) {
        Mesh placed = amphora;
        for (MeshVertex& v : placed) v.p += Vec3{i % 2 ? 0.8f : -0.8f, 0, 3.2f - 1.2f * static_cast<float>(i / 2)};
        draw(large, in_clip_space(placed, camera), clip, Rgb(0));
    }
    return shrink(large.color, 4);
}

/// Four triangles and a plane seen from the side: what is above the plane is in front of it. Whole triangles are gray.
ImageRgb cuts() {
    Framebuffer image(480, 160, Rgb(1));
    const auto corner = [](float x, float y) { return Vertex{{x, y, y, 1}, {}, {}, {}}; };
    for (int i = 0; i < 4; ++i) {
        const float x = -0.77f + 0.5f * static_cast<float>(i), y = 0.52f - 0.31f * static_cast<float>(i);
        const Triangle t{corner(x - 0.15f, y + 0.3f), corner(x + 0.2f, y), corner(x - 0.1f, y - 0.5f)};
        for_each_fragment(t, 480, 160, [&](int px, int py, float, Vec3) { image.color(px, py) = Rgb(0.7f); });
        Rgb color = rainbow(0.1f);
        for (const Triangle& part : clip_near(t)) {
            for_each_fragment(part, 480, 160, [&](int px, int py, float, Vec3) { image.color(px, py) = color; });
            color = rainbow(0.55f); // of the second part
        }
    }
    draw_path(image.color, {{0, 80}, {480, 80}}, 1, Rgb(0));
    return image.color;
}

int main() {
    const Mesh amphora = read_obj(DUET_MODELS "meshes/amphora.obj");
    const Mat4 view = look_at({0.15f, 0.8f, 1.3f}, {0, 0.35f, -0.6f}, {0, 1, 0});
    const Mat4 camera = perspective(1.25f, 1.32f, 0.05f, 30) * view, far = perspective(1.25f, 1.32f, 1.6f, 30) * view;
    write_image("evidence.png", beside({lane(amphora, camera, clip_near), lane(amphora, camera, no_clipping)}));
    write_image("mistakes.png", beside({lane(amphora, camera, drop_whole), lane(amphora, far, clip_near)}));
    write_image("cuts.png", cuts());
    std::vector<Vec2d> behind, before; // points of a floor 1 m below the eye
    for (double w = 4; w > 0.2; w -= 0.05) behind.push_back({-w, 1 / w}), before.push_back({w, -1 / w});
    Plot plot{.title = "Where the floor is", .x_label = "w: meters in front of the eye", .y_label = "y / w"};
    plot.series = {{"behind", behind}, {"in front", before}};
    write_plot("hyperbola.svg", plot);
}
