// Lesson 09: shadow maps. Writes amphorae in the sun, what the sun sees of them, and what goes wrong with shadows.
#include "common/image/image_file.h"
#include "common/image/plot.h"
#include "common/system/parameters.h"
#include "raster/lessons/01-lines/figures.h"
#include "raster/lessons/07-textures/texture.h"
#include "raster/lessons/09-shadow-maps/shadow.h"

using namespace duet;
using namespace duet::lesson;

const Vec3 kToSun = normalize(Vec3{0.62f, 0.42f, 0.55f}), kCenter{-0.1f, 0.35f, 0};
constexpr float kRadius = 1.6f; // of the sphere that the map holds
const ImageRgb kPaint = read_image(DUET_MODELS "textures/amphora.png");

/// A floor with a wall behind it, and three amphorae on it. The floor and the wall have a negative uv.x.
Mesh make_scene() {
    Mesh world;
    const auto add_rectangle = [&world](Vec3 corner, Vec3 u, Vec3 v) {
        for (const Vec2 q : {Vec2{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
            world.push_back({corner + u * q.x + v * q.y, normalize(cross(u, v)), {-1, 0}});
    };
    add_rectangle({-5, 0, 5}, {10, 0, 0}, {0, 0, -5.8f}), add_rectangle({-5, 0, -0.8f}, {10, 0, 0}, {0, 3, 0});
    const Mesh amphora = read_obj(DUET_MODELS "meshes/amphora.obj");
    for (const Vec4 q : {Vec4{0.12f, -0.25f, 1, 0.9f}, {-0.68f, 0.25f, 0.8f, 0.2f}, {0.72f, 0.2f, 0.65f, 2}}) {
        const Mat4 turned = rotation(Vec3{0, 1, 0}, q.w); // the place is (x, 0, y), the size z, the angle w
        for (const auto& [p, n, uv] : amphora)
            world.push_back({Vec3{q.x, 0, q.y} + transform_vector(turned, p * q.z), transform_vector(turned, n), uv});
    }
    return world;
}

/// The fraction of the sun's light at p, on a triangle with normal n. A negative bias stands for that from the slope.
auto by_map(const ShadowMap& map, int reach, float bias = -1) {
    return [&map, reach, bias](Vec3 p, Vec3 n) {
        return lit_fraction(map, p, bias < 0 ? slope_bias(map, kToSun, n, reach) : bias, reach);
    };
}
/// The same by a ray toward the sun, tested with all triangles. It begins a tenth of a millimeter above p.
float by_ray(const Mesh& world, Vec3 p, Vec3 n) {
    for (std::size_t i = 0; i < world.size(); i += 3) {
        const Vec3 u = world[i + 1].p - world[i].p, v = world[i + 2].p - world[i].p, o = p + n * 1e-4f - world[i].p;
        const Vec3 normal = cross(kToSun, v), across = cross(o, u);
        const float det = dot(u, normal), a = dot(o, normal) / det, b = dot(kToSun, across) / det;
        if (a >= 0 && b >= 0 && a + b <= 1 && dot(v, across) / det > 0) return 0;
    }
    return 1;
}
/// The scene in the light of the sun and the sky. Surfaces that are turned away from the sun get none of its light.
ImageRgb view(const Mesh& world, float fov, Vec3 target, int height, const auto& lit) {
    Framebuffer image(height * 7 / 5, height, Rgb(0));
    const Mat4 camera = perspective(fov, 1.4f, 0.1f, 30) * look_at({-0.5f, 1.2f, 3}, target, {0, 1, 0});
    draw_triangles(image, in_clip_space(world, camera), [&](const Fragment& f) {
        const Vec3 flat = normalize(cross(f.triangle[1].p - f.triangle[0].p, f.triangle[2].p - f.triangle[0].p));
        const float cosine = dot(f.n, kToSun), sun = cosine > 0 && dot(flat, kToSun) > 0 ? cosine * lit(f.p, flat) : 0;
        const bool odd = (std::lround(f.p.x * 2.5f) + std::lround(f.p.z * 2.5f)) % 2; // tiles are 40 cm wide
        const Rgb stone = Rgb(0.6f, 0.51f, 0.41f) * (f.n.y > 0.5f && odd ? 0.8f : 1.0f);
        const Rgb color = f.uv.x < 0 ? stone : bilinear(kPaint, f.uv);
        return color * (Rgb(1.6f, 1.35f, 1.0f) * sun + Rgb(0.13f, 0.18f, 0.28f) * (1.5f + 0.5f * f.n.y));
    });
    return image.color;
}

/// In percent of the pixels: x are darker than they should be (acne), y are brighter (light leaks).
Vec2d errors(const ImageRgb& found, const ImageRgb& truth) {
    Vec2d wrong;
    for (std::size_t i = 0; i < truth.size(); ++i)
        (average(found[i]) < average(truth[i]) ? wrong.x : wrong.y) += found[i] != truth[i];
    return wrong * (100 / static_cast<double>(truth.size()));
}

int main(int argc, char** argv) {
    int texels = 256, r = 2;
    read_parameters(argc, argv, {{"map size", texels, 16, 1024, "texels"}, {"filter reach", r, 0, 8, "texels"}});
    const Mesh world = make_scene();
    const auto map = [&](const Mat4& m, int side) { return draw_shadow_map(world, m, 2 * kRadius, side); };
    const auto whole = [&](int height, const auto& lit) { return view(world, 0.56f, {-0.14f, 0.36f, 0}, height, lit); };
    const auto close = [&](const auto& lit) { return shrink(view(world, 0.3f, {-0.5f, 0.3f, 0}, 3 * 168, lit), 3); };
    const Mat4 matrix = sun_matrix(kToSun, kCenter, kRadius);
    const ShadowMap fine = map(matrix, 1024), coarse = map(matrix, texels);
    ImageRgb depths(1024, 1024);
    for (std::size_t i = 0; i < depths.size(); ++i) depths[i] = Rgb(sqr(max(1 - 0.8f * fine.depth[i], 0.0f)));
    write_image("evidence.png", beside({shrink(whole(3 * 256, by_map(fine, r)), 3), shrink(depths, 4)}));
    write_image("bias.png", beside({close(by_map(coarse, 0, 0)), close(by_map(coarse, 0, 0.25f))}));
    write_image("edges.png", beside({close(by_map(coarse, 0)), close(by_map(coarse, r)), close(by_map(fine, r))}));
    const ShadowMap small = draw_shadow_map(world, sun_matrix(kToSun, kCenter, 0.75f), 1.5f, 256);
    const auto beyond_dark = [&](Vec3 p, Vec3 n) {
        return max_component(abs(transform_point(small.clip_from_world, p))) < 1 ? by_map(small, 0)(p, n) : 0;
    };
    const Mat4 turned = look_at(kCenter + kToSun * kRadius, kCenter, {0, 1, 0}) * scaling(Vec3{1, 1, -0.5f} / kRadius);
    const Mat4 mirror = inverse_affine(matrix) * scaling(Vec3{1, -1, 1}) * matrix; // upside down in the map
    const auto upside_down = [&](Vec3 p, Vec3 n) { return by_map(fine, 0)(transform_point(mirror, p), n); };
    write_image("wrong.png", beside({close(beyond_dark), close(by_map(map(turned, 1024), 0)), close(upside_down)}));
    const ImageRgb truth = whole(110, [&](Vec3 p, Vec3 n) { return by_ray(world, p, n); });
    Plot plot{"Wrong pixels", "bias in meters", "percent", true, true, {{"acne", {}}, {"light leaks", {}}}};
    for (float bias = 5e-4f; bias < 0.5f; bias *= 1.4f) {
        const Vec2d percent = errors(whole(110, by_map(fine, 0, bias)), truth);
        plot.series[0].points.push_back({bias, percent.x}), plot.series[1].points.push_back({bias, percent.y});
    }
    write_plot("errors.svg", plot);
    const Vec2d percent = errors(whole(110, by_map(fine, 0)), truth);
    std::printf("With the bias from the slope: %.3f %% acne, %.3f %% light leaks\n", percent.x, percent.y);
}
