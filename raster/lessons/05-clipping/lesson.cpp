// Lesson 05: clipping. Writes a lane that goes on behind the eye, with and without clipping.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/system/parameters.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/03-z-buffer/framebuffer.h"
#include "raster/lessons/05-clipping/fragments.h"

using namespace duet;
using namespace duet::lesson;

/// Three wrong ways to get the parts of a triangle that are drawn. The right one is clip_near.
std::vector<Triangle> no_clipping(const Triangle& t) { return {t}; }
std::vector<Triangle> drop_whole(const Triangle& t) {
    return t[0].clip.z < 0 || t[1].clip.z < 0 || t[2].clip.z < 0 ? std::vector<Triangle>() : std::vector{t};
}
std::vector<Triangle> divide_first(const Triangle& t) {
    const auto divided = [](Vertex v) { return Vertex{v.clip * (1 / v.clip.w), v.p, v.n, v.uv}; };
    return clip_near({divided(t[0]), divided(t[1]), divided(t[2])});
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
    Framebuffer large(3 * 330, 3 * 250, Rgb(0.3f, 0.5f, 0.8f));
    for (int i = 0; i < 24 * 8; ++i) {
        const float wear = 0.0005f * static_cast<float>(i * 11 % 7), x = 0.4f * static_cast<float>(i / 8 - 12),
                    z = 0.5f * static_cast<float>(i / 8 % 3 * 2 - i % 8 * 5 + 11);
        const auto corner = [&](float dx, float dz) { return MeshVertex{{x + dx, wear, z + dz}, {}, {}}; };
        const MeshVertex a = corner(0, 0), b = corner(0.4f, 0), c = corner(0.4f, -2.5f), d = corner(0, -2.5f);
        draw(large, in_clip_space({a, b, c, a, c, d}, camera), clip, Rgb(0.3f, 0.16f, 0.07f) * (0.5f + 400 * wear));
    }
    for (int i = 0; i < 18; ++i) {
        const Mat4 place = translation(Vec3{i % 2 ? 0.8f : -0.8f, 0, 3.2f - 1.2f * static_cast<float>(i / 2)});
        draw(large, in_clip_space(amphora, camera * place), clip, Rgb(0));
    }
    return shrink(large.color, 3);
}

/// Four triangles and a plane seen from the side: what is above the plane is in front of it. Whole triangles are gray.
ImageRgb cuts() {
    ImageRgb image(480, 160, Rgb(1));
    const auto paint = [&](const Triangle& t, Rgb color) {
        for_each_fragment(t, 480, 160, [&](int x, int y, float, Vec3) { image(x, y) = color; });
    };
    const auto corner = [](float x, float y) { return Vertex{{x, y, y, 1}, {}, {}, {}}; };
    for (int i = 0; i < 4; ++i) {
        const float x = -0.77f + 0.5f * static_cast<float>(i), y = 0.52f - 0.31f * static_cast<float>(i);
        const Triangle t{corner(x - 0.15f, y + 0.3f), corner(x + 0.2f, y), corner(x - 0.1f, y - 0.5f)};
        paint(t, Rgb(0.7f));
        const std::vector<Triangle> parts = clip_near(t);
        for (std::size_t k = 0; k < parts.size(); ++k) paint(parts[k], rainbow(k == 0 ? 0.1f : 0.55f));
    }
    draw_path(image, {{0, 80}, {480, 80}}, 1, Rgb(0));
    return image;
}

int main(int argc, char** argv) {
    const Mesh amphora = read_obj(DUET_MODELS "meshes/amphora.obj");
    float fov = 1.25f, near = 0.05f, y = 0.8f;
    read_parameters(argc, argv, {{"field of view", fov, 0.3f, 2.4f, "radians"},
                                 {"near plane", near, 0.01f, 3, "meters"}, {"eye height", y, 0.2f, 3, "meters"}});
    const Mat4 view = look_at({0.15f, y, 1.3f}, {0, 0.35f, -0.6f}, {0, 1, 0});
    const Mat4 camera = perspective(fov, 1.32f, near, 30) * view, far = perspective(fov, 1.32f, 1.6f, 30) * view;
    write_image("evidence.png", beside({lane(amphora, camera, clip_near), lane(amphora, camera, no_clipping)}));
    write_image("mistakes.png", beside({lane(amphora, camera, drop_whole), lane(amphora, far, clip_near)}));
    write_image("divided.png", lane(amphora, camera, divide_first));
    write_image("cuts.png", cuts());
    std::vector<Vec2d> behind, before; // points of a floor 1 m below the eye
    for (double w = 4; w > 0.2; w -= 0.05) behind.push_back({-w, 1 / w}), before.push_back({w, -1 / w});
    Plot plot{.title = "Where the floor is", .x_label = "w: meters in front of the eye", .y_label = "y / w"};
    plot.series = {{"behind", behind}, {"in front", before}};
    write_plot("hyperbola.svg", plot);
}
