// Lesson 06: shading. Writes an amphora and a ring in flat, Gouraud and Phong shading, and what goes wrong.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/system/parameters.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/03-z-buffer/framebuffer.h"
#include "raster/lessons/05-clipping/fragments.h"
#include "raster/lessons/06-shading/shading.h"

using namespace duet;
using namespace duet::lesson;

constexpr int kWidth = 210, kHeight = 240;
const Vec3 kEye{0, 1.25f, 3}, kLight{-2, 3, 2.5f}; // in meters, y up
const Mat4 kCamera = perspective(0.43f, 0.875f, 0.1f, 20) * look_at(kEye, {0, 0.38f, 0}, {0, 1, 0});

/// How a triangle gets its colors. The last two are mistakes.
enum class Shading { kFlat, kGouraud, kPhong, kUnnormalized, kTurnedLight };

/// The color of a point of the world: the light from the light source, and a little light that is everywhere.
Rgb lit(Vec3 p, Vec3 n, const Surface& surface, float sign = 1) {
    return surface.diffuse * 0.04f + blinn_phong(n, normalize(kLight - p) * sign, normalize(kEye - p), surface);
}

void draw(Framebuffer& target, const std::vector<Triangle>& triangles, Shading shading, const Surface& surface) {
    for (const Triangle& triangle : triangles) {
        const Vertex &a = triangle[0], &b = triangle[1], &c = triangle[2];
        const Vec3 facet = normalize(cross(b.p - a.p, c.p - a.p));
        const Rgb flat = lit((a.p + b.p + c.p) / 3.0f, facet, surface);
        const Rgb at_a = lit(a.p, a.n, surface), at_b = lit(b.p, b.n, surface), at_c = lit(c.p, c.n, surface);
        const auto color = [&](Vec3 w) {
            if (shading == Shading::kFlat) return flat;
            if (shading == Shading::kGouraud) return at_a * w.x + at_b * w.y + at_c * w.z;
            const Vec3 p = a.p * w.x + b.p * w.y + c.p * w.z, n = a.n * w.x + b.n * w.y + c.n * w.z;
            if (shading == Shading::kUnnormalized) return lit(p, n, surface);
            return lit(p, normalize(n), surface, shading == Shading::kTurnedLight ? -1.0f : 1.0f);
        };
        for_each_fragment(triangle, target.color.width(), target.color.height(),
                          [&](int x, int y, float z, Vec3 w) { target.write(x, y, z, color(w)); });
    }
}

/// A mesh of columns × rows cells, two triangles each. vertex(u, v) is the vertex at u and v from 0 to 1.
template <typename F> Mesh grid(int columns, int rows, const F& vertex) {
    Mesh mesh;
    for (int i = 0; i < columns * rows; ++i) {
        const float du = 1.0f / static_cast<float>(columns), dv = 1.0f / static_cast<float>(rows);
        const float u = static_cast<float>(i % columns) * du, v = static_cast<float>(i / columns) * dv;
        const MeshVertex a = vertex(u, v), b = vertex(u + du, v), c = vertex(u + du, v + dv), d = vertex(u, v + dv);
        mesh.insert(mesh.end(), {a, b, c, a, c, d});
    }
    return mesh;
}

/// A direction by its angles: once around the y axis as u goes from 0 to 1, and y up as v goes from 0 to 1/4.
Vec3 direction(float u, float v) {
    const float around = 2 * kPi * u, up = 2 * kPi * v;
    return {std::sin(around) * std::cos(up), std::sin(up), std::cos(around) * std::cos(up)};
}
MeshVertex ring(float u, float v) { // a torus: a tube that runs around the y axis
    return {direction(u, 0) * 0.42f + direction(u, v) * 0.09f + Vec3{0, 0.09f, 0}, direction(u, v), {u, v}};
}
MeshVertex sphere(float u, float v) {
    const Vec3 n = direction(u, v / 2 - 0.25f);
    return {n * 0.5f, n, {u, v}};
}
MeshVertex plate(float u, float v) { return {Vec3{u - 0.5f, 0, 0.5f - v} * 0.9f, {0, 1, 0}, {u, v}}; }

struct Object {
    std::vector<Triangle> triangles;
    Surface surface;
};
ImageRgb view(const std::vector<Object>& objects, Shading shading = Shading::kPhong) {
    Framebuffer large(4 * kWidth, 4 * kHeight, Rgb(0.02f, 0.024f, 0.035f));
    for (const Object& object : objects) draw(large, object.triangles, shading, object.surface);
    return shrink(large.color, 4);
}

int main(int argc, char** argv) {
    Surface clay{{0.6f, 0.2f, 0.08f}, 0.7f, 60}, glaze{{0.04f, 0.32f, 0.4f}, 0.8f, 60};
    read_parameters(argc, argv, {{"specular", clay.specular, 0, 2}, {"shininess", clay.shininess, 1, 500}});
    const auto amphora = place_mesh(read_obj(DUET_MODELS "meshes/amphora.obj"), Mat4(), kCamera);
    const std::vector<Object> scene{{amphora, clay}, {place_mesh(grid(16, 8, ring), Mat4(), kCamera), glaze}};
    write_image("evidence.png", beside({view(scene, Shading::kFlat), view(scene, Shading::kGouraud), view(scene)}));
    write_image("turned.png", view(scene, Shading::kTurnedLight));
    const auto part = [&](Surface surface) { return view({{amphora, surface}}); };
    write_image("parts.png", beside({part({clay.diffuse, 0, 60}), part({Rgb(0), clay.specular, 60}), part(clay)}));

    const Mat4 up = translation(Vec3{0, 0.4f, 0}), flattened = up * scaling(Vec3{1, 0.3f, 1});
    const std::vector<Object> coarse{{place_mesh(grid(10, 6, sphere), up, kCamera), glaze}};
    write_image("unnormalized.png", beside({view(coarse), view(coarse, Shading::kUnnormalized)}));
    const Mesh ball = grid(48, 24, sphere);
    const auto right = place_mesh(ball, flattened, kCamera);
    auto wrong = right;
    for (std::size_t i = 0; i < ball.size(); ++i)
        wrong[i / 3][i % 3].n = normalize(transform_vector(flattened, ball[i].n)); // by the matrix of the points
    write_image("stretched.png", beside({view({{right, clay}}), view({{wrong, clay}})}));
    const Mat4 tilt = up * rotation(Vec3{0, 1, 0}, -0.3f) * rotation(Vec3{1, 0, 0}, 1.05f);
    const auto panel = [&](int n, Shading shading) {
        return view({{place_mesh(grid(n, n, plate), tilt, kCamera), {glaze.diffuse, 0.8f, 250}}}, shading);
    };
    const ImageRgb few = panel(1, Shading::kGouraud), many = panel(8, Shading::kGouraud);
    write_image("plate.png", beside({few, many, panel(1, Shading::kPhong)}));

    Plot plot{.title = "The highlight", .x_label = "angle between n and h, in degrees", .y_label = "cosine to the m"};
    for (const int m : {4, 16, 64, 256}) {
        plot.series.push_back({"m = " + std::to_string(m), {}});
        for (double a = 0; a <= 60; a += 1.5)
            plot.series.back().points.push_back({a, std::pow(std::cos(a * kPi / 180), m)});
    }
    write_plot("highlight.svg", plot);
}
