// Lesson 07: textures. Writes painted amphorae on a checkered floor, and what goes wrong with textures.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/image/srgb.h"
#include "common/system/parameters.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/07-textures/pipeline.h"
#include "raster/lessons/07-textures/texture.h"

using namespace duet;
using namespace duet::lesson;

using Sample = Rgb(const ImageRgb& image, Vec2 uv); // a way to get a color from a texture
struct Object {
    std::vector<Triangle> triangles;
    const ImageRgb& texture;
};

/// Draws objects into an image of that width, with n × n samples per pixel.
ImageRgb view(const std::vector<Object>& objects, Vec3 eye, Sample* sample, int n = 4, int width = 320) {
    Framebuffer large(n * width, n * width * 23 / 32, Rgb(0.25f, 0.45f, 0.7f));
    for (const Object& object : objects)
        draw_triangles(large, object.triangles, [&](const Fragment& f) {
            const Rgb color = sample(object.texture, f.uv);
            const Vec3 to_light = normalize(Vec3{-2, 4, 3} - f.p), to_eye = normalize(eye - f.p);
            return color * 0.15f + blinn_phong(f.n, to_light, to_eye, {color, 0.15f, 50});
        });
    return shrink(large.color, n);
}
Mat4 camera(Vec3 eye, Vec3 target, float fov) {
    return perspective(fov, 32 / 23.0f, 0.1f, 100) * look_at(eye, target, {0, 1, 0});
}

int main(int argc, char** argv) {
    float fov = 0.62f, detail = 0.035f;
    read_parameters(argc, argv, {{"field of view", fov, 0.1f, 1.5f, "radians"},
                                 {"field of view of the detail", detail, 0.005f, 0.2f, "radians"}});
    ImageRgb paint = read_image(DUET_MODELS "textures/amphora.png"), tiles(64, 64);
    for (int i = 0; i < 64 * 64; ++i)
        tiles(i % 64, i / 64) = i / 32 % 2 == i / 64 / 32 ? Rgb(0.7f, 0.65f, 0.55f) : Rgb(0.12f, 0.2f, 0.22f);
    const auto corner = [](float x, float z) { return MeshVertex{{x, 0, z}, {0, 1, 0}, Vec2{x, -z} * 2.0f}; };
    const auto square = [&](float s, float z) {
        const MeshVertex a = corner(-s, z), b = corner(s, z), c = corner(s, z - 2 * s), d = corner(-s, z - 2 * s);
        return Mesh{a, b, c, a, c, d};
    };
    const Mesh amphora = read_obj(DUET_MODELS "meshes/amphora.obj");
    const Vec3 eye{0.3f, 0.9f, 2.1f};
    const Mat4 front = camera(eye, {0.02f, 0.4f, 0}, fov);
    std::vector<Object> scene{{place_mesh(square(20, 3), Mat4(), front), tiles}};
    for (const Vec3 p : {Vec3{0, 0, 0}, {-0.75f, 0, -1}, {0.75f, 0, -1.6f}, {0.25f, 0, -2.6f}})
        scene.push_back({place_mesh(amphora, translation(p), front), paint});
    write_image("evidence.png", view(scene, eye, bilinear<Rgb>, 4, 416));

    Object floor{place_mesh(square(1.2f, 0.6f), Mat4(), camera({0.3f, 1.5f, 2.1f}, {0.05f, 0, -0.55f}, 0.72f)), tiles};
    const ImageRgb right = view({floor}, eye, bilinear<Rgb>, 4, 256);
    const auto cut = [](const ImageRgb& i, Vec2 uv) { return texel(i, 32 * int(uv.x * 2), 32 * int(uv.y * 2)); };
    write_image("negative.png", view({floor}, eye, cut, 4, 256));
    for (Triangle& t : floor.triangles)
        for (Vertex& v : t) v.clip = v.clip * (1 / v.clip.w); // w is 1 now: the pipeline has forgotten the distance
    write_image("affine.png", beside({view({floor}, eye, bilinear<Rgb>, 4, 256), right}));
    const std::vector<Object> near{{place_mesh(amphora, Mat4(), camera(eye, {0.03f, 0.41f, 0.2f}, detail)), paint}};
    write_image("filter.png", beside({view(near, eye, nearest<Rgb>), view(near, eye, bilinear<Rgb>)}));
    const std::vector<Object> plain{scene[0]}, vases{scene.begin() + 1, scene.end()};
    const ImageRgb one_sample = view(plain, eye, bilinear<Rgb>, 1, 240);
    write_image("distance.png", beside({one_sample, view(plain, eye, bilinear<Rgb>, 4, 240)}));
    const auto flipped = [](const ImageRgb& image, Vec2 uv) { return bilinear(image, {uv.x, 1 - uv.y}); };
    const ImageRgb upside_down = view(vases, eye, flipped, 4, 256);
    for (Rgb& c : paint.pixels()) c = {srgb_encode(c.r), srgb_encode(c.g), srgb_encode(c.b)}; // as the file has them
    write_image("wrong.png", beside({upside_down, view(vases, eye, bilinear<Rgb>, 4, 256)}));
    Plot plot{.title = "An edge in perspective", .x_label = "fraction in the image", .y_label = "fraction on the edge"};
    for (const double w : {1.0, 3.0, 10.0}) {
        plot.series.push_back({"w from 1 to " + std::to_string(int(w)), {}});
        for (double s = 0; s <= 50; ++s) plot.series.back().points.push_back({s / 50, s / w / (50 - s + s / w)});
    }
    write_plot("perspective.svg", plot);
}
