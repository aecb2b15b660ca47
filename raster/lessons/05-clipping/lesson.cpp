// Lesson 05: clipping. Writes a lane of amphorae that goes on behind the eye, and the same without clipping.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/03-z-buffer/framebuffer.h"
#include "raster/lessons/05-clipping/fragments.h"

using namespace duet;
using namespace duet::lesson;

enum class Clip { kRight, kNone, kWhole };

/// Draws a mesh in the color of each vertex's normal, or in a color for the whole.
void draw(Framebuffer& target, const Mesh& world, const Mat4& clip_from_world, Clip clip, const Rgb* color = nullptr) {
    const int width = target.color.width(), height = target.color.height();
    for (const Triangle& triangle : in_clip_space(world, clip_from_world)) {
        const auto visit = [&](int x, int y, float depth, const Triangle& part, Vec3 w) {
            const Rgb normal = direction_color(part[0].n * w.x + part[1].n * w.y + part[2].n * w.z);
            target.write(x, y, depth, color ? *color : normal * normal);
        };
        if (clip == Clip::kRight) for_each_fragment(triangle, width, height, visit);
        if (clip == Clip::kNone) for_each_fragment_of_part(triangle, width, height, visit);
        if (clip == Clip::kWhole && triangle[0].clip.z >= 0 && triangle[1].clip.z >= 0 && triangle[2].clip.z >= 0)
            for_each_fragment(triangle, width, height, visit);
    }
}

Mesh plank(float x, float z, float length) {
    const float w = 0.38f;
    const Vec3 n{0, 1, 0};
    const MeshVertex a{{x, 0, z}, n, {}}, b{{x + w, 0, z}, n, {}}, c{{x + w, 0, z - length}, n, {}},
        d{{x, 0, z - length}, n, {}};
    return {a, b, c, a, c, d};
}

ImageRgb lane(const Mesh& amphora, const Mat4& camera, Clip clip) {
    Framebuffer large(4 * 395, 4 * 300, Rgb(0.16f, 0.26f, 0.4f));
    for (int i = 0; i < 24; ++i)
        for (int j = 0; j < 8; ++j) {
            const Rgb color = Rgb(0.3f, 0.17f, 0.08f) * (0.6f + 0.15f * static_cast<float>((i * 7 + j * 5) % 6));
            draw(large,
                 plank(-4.8f + 0.4f * static_cast<float>(i),
                       7 - 2.5f * static_cast<float>(j) + 0.8f * static_cast<float>(i * 2 % 3), 2.48f),
                 camera, clip, &color);
        }
    for (int i = 0; i < 18; ++i) {
        Mesh placed = amphora;
        for (MeshVertex& vertex : placed)
            vertex.p += Vec3{i % 2 ? 0.8f : -0.8f, 0, 3.2f - 1.2f * static_cast<float>(i / 2)};
        draw(large, placed, camera, clip);
    }
    return shrink(large.color, 4);
}

int main() {
    const Mesh amphora = read_obj(DUET_MODELS "meshes/amphora.obj");
    const Mat4 view = look_at({0.15f, 0.8f, 1.3f}, {0, 0.35f, -0.6f}, {0, 1, 0});
    const Mat4 camera = perspective(1.25f, 395.0f / 300, 0.05f, 30) * view;
    write_image("evidence.png", beside({lane(amphora, camera, Clip::kRight), lane(amphora, camera, Clip::kNone)}));
    write_image("near.png", beside({lane(amphora, camera, Clip::kWhole),
                                    lane(amphora, perspective(1.25f, 395.0f / 300, 0.8f, 30) * view, Clip::kRight)}));
}
