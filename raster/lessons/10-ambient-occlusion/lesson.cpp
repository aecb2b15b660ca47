// Lesson 10: ambient occlusion. Writes the corner of a room in the light of the sky, and the same by rays.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/system/parameters.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/10-ambient-occlusion/occlusion.h"

using namespace duet;
using namespace duet::lesson;

/// The corner of a room with plinths, an amphora, a bowl and pears.
Mesh make_scene() {
    Mesh world;
    const std::array<Vec3, 3> e{Vec3{4, 0, 0}, {0, 3, 0}, {0, 0, 4}}; // the edges of the room
    for (std::size_t i = 0; i < 3; ++i)                               // the back wall, the left wall and the floor
        for (const Vec2 q : {Vec2{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
            world.push_back({Vec3{-1.2f, 0, -1} + e[i] * q.x + e[(i + 1) % 3] * q.y, normalize(e[(i + 2) % 3]), {}});
    const std::array<std::string, 6> names{"amphora", "bowl", "pear", "plinth", "plinth", "pear"};
    const std::array<Vec4, 6> places{Vec4{-0.45f, 0, -0.3f, 1.1f},  {0.1f, 0, 0.4f, 1.4f},
                                     {-0.72f, 0, 0.35f, 2.2f},      {0.75f, 0, -0.45f, 0.42f},
                                     {0.75f, 0.42f, -0.45f, 0.22f}, {0.75f, 0.64f, -0.45f, 2}};
    for (std::size_t i = 0; i < names.size(); ++i)
        for (const auto& [p, n, uv] : read_obj(DUET_MODELS "meshes/" + names[i] + ".obj"))
            world.push_back({Vec3{places[i].x, places[i].y, places[i].z} + p * places[i].w, n, uv});
    return world;
}

/// The truth: the fraction of rays from p that meet a triangle within the radius.
float traced(const Mesh& world, Vec3 p, Vec3 n, int count, float radius) {
    std::vector<Vec3> free; // the rays that have met nothing so far
    for (int k = 0; k < count; ++k) free.push_back(hemisphere_direction(n, k, count, 0));
    for (std::size_t i = 0; i < world.size(); i += 3) {
        const Vec3 u = world[i + 1].p - world[i].p, v = world[i + 2].p - world[i].p, o = p - world[i].p;
        const Vec3 gap = max(max(min(min(u, v), Vec3()) - o, o - max(max(u, v), Vec3())), Vec3());
        if (length(gap) > radius || max(max(dot(n, u), dot(n, v)), 0.0f) < dot(n, o) + 1e-4f) continue; // out of reach
        std::erase_if(free, [&](Vec3 d) {
            const Vec3 q = cross(d, v), r = cross(o, u);
            const float det = dot(u, q), a = dot(o, q) / det, b = dot(d, r) / det, t = dot(v, r) / det;
            return a >= 0 && b >= 0 && a + b <= 1 && t > 1e-4f && t < radius;
        });
    }
    return 1 - static_cast<float>(free.size()) / static_cast<float>(count);
}

int main(int argc, char** argv) {
    Search s;
    read_parameters(argc, argv, {{"directions", s.directions, 1, 64}, {"radius", s.radius, 0.02f, 2, "meters"}});
    const Mesh world = make_scene();
    const auto draw = [&](float fov, Vec3 target, int height) {
        const Mat4 camera = perspective(fov, 1.4f, 0.1f, 30) * look_at({0.6f, 1.35f, 2.9f}, target, {0, 1, 0});
        return draw_gbuffer(world, camera, height * 7 / 5, height);
    };
    const GBuffer seen = draw(0.5f, {0.02f, 0.36f, -0.3f}, 480), small = draw(0.5f, {0.02f, 0.36f, -0.3f}, 60);
    const ImageRgb light = sky_light(seen, s);
    ImageRgb with = light, without = light, truth(84, 60);
    for (std::size_t i = 0; i < with.size(); ++i)
        with[i] *= without[i] = lerp(Rgb(0.62f, 0.36f, 0.22f), Rgb(0.62f, 0.66f, 0.72f), 0.5f + 0.5f * seen.n[i].y);
    write_image("evidence.png", beside({shrink(without, 2), shrink(with, 2)}));
    for (std::size_t i = 0; i < 84 * 60; ++i) truth[i] = Rgb(1 - traced(world, small.p[i], small.n[i], 100, s.radius));
    write_image("truth.png", beside({shrink(light, 2), magnify(truth, 4)}));
    Plot plot{"Error", "directions", "root mean square", true, true, {{"as found", {}}, {"blurred", {}}}};
    for (int n = 1; n <= 64; n *= 2)
        for (std::size_t k = 0; k < 2; ++k) {
            const ImageRgb image = sky_light(small, {.directions = n, .blur = k == 0 ? 1 : 4});
            double sum = 0;
            for (std::size_t i = 0; i < truth.size(); ++i) sum += static_cast<double>(sqr(image[i].r - truth[i].r));
            plot.series[k].points.push_back({1.0 * n, std::sqrt(sum / (84 * 60))});
        }
    write_plot("errors.svg", plot);
    const GBuffer close = draw(0.25f, {-0.15f, 0.3f, 0}, 200), coarse = draw(0.25f, {-0.15f, 0.3f, 0}, 50);
    write_image("range.png", beside({sky_light(close, {.range = 1e9f}), sky_light(close, {})}));
    write_image("bias.png", magnify(beside({sky_light(coarse, {.bias = 0}), sky_light(coarse, {.bias = 0.02f})}), 4));
    write_image("pattern.png", beside({sky_light(close, {4, 1}), sky_light(close, {4, 16, 1}), sky_light(close, {4})}));
}
