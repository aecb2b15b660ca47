// Lesson 09: textures. Writes a globe and a marble sphere on a checkerboard, and what goes wrong with textures.
#include "common/image/image_file.h"
#include "common/system/parameters.h"
#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/05-diffuse/diffuse.h"
#include "raytrace/lessons/07-camera/camera.h"
#include "raytrace/lessons/09-textures/textures.h"
#include <functional>

using namespace duet;
using namespace duet::lesson;
using Texture = std::function<Rgb(Vec2 uv, Vec3 p)>; // the color at (u, v) of a sphere's map; p is from the center
struct Scene {
    std::vector<Sphere> spheres;
    std::vector<Texture> textures; // one a sphere
};
Rgb path_color(const Scene& scene, const Ray& ray, int bounces, Random& random) { // all spheres are matte
    const std::optional<Hit> hit = closest_hit(scene.spheres, ray);
    if (!hit || bounces == 0) return hit ? Rgb(0) : sky_color(ray.direction);
    const Sphere& sphere = scene.spheres[hit->index];
    const Rgb color = scene.textures[hit->index](sphere_uv(hit->n), hit->p - sphere.center);
    const Ray next{offset_point(sphere, *hit), random_diffuse_direction(hit->n, random)};
    return color * path_color(scene, next, bounces - 1, random);
}
void draw(const std::string& file, const Scene& scene, const View& view, int width, int height, int samples) {
    const Camera camera(view, width, height);
    const auto color = [&](float x, float y, Random& r) { return path_color(scene, camera.ray(x, y, r), 20, r); };
    write_image(file, average_samples(width, height, samples, color));
}
void draw_row(const std::string& file, const std::vector<Texture>& textures) { // spheres of radius 1
    Scene scene{{}, textures};
    for (float x = 0; scene.spheres.size() < textures.size(); x += 2.2f) scene.spheres.push_back({{x, 0, 0}, 1});
    const float middle = scene.spheres.back().center.x / 2;
    const View view{.eye = {middle, 16, 40}, .look_at = {middle, 0, 0}, .fov_degrees = 2.95f};
    draw(file, scene, view, 90 * static_cast<int>(textures.size()), 90, 25);
}

Rgb planet(Vec3 p) { // sea, land, ice and clouds
    const float height = fractal_noise(p * 1.3f + Vec3(7, 1, 4), 6) - 0.06f;
    Rgb color = lerp(Rgb(0.01f, 0.03f, 0.18f), Rgb(0.03f, 0.35f, 0.5f), clamp(1 + 6 * height, 0.0f, 1.0f));
    if (height > 0) color = lerp(Rgb(0.06f, 0.22f, 0.04f), Rgb(0.5f, 0.32f, 0.14f), clamp(3 * height, 0.0f, 1.0f));
    if (std::abs(p.y) + 0.2f * fractal_noise(p * 3.0f, 4) > 0.9f) color = Rgb(0.85f, 0.9f, 0.95f);
    return lerp(color, Rgb(0.95f), clamp(4 * fractal_noise(p * 2.5f - Vec3(9, 9, 9), 5) - 0.8f, 0.0f, 0.9f));
}
Rgb squares(Vec3 p) { return checker(p) ? Rgb(0.1f, 0.12f, 0.15f) : Rgb(0.75f, 0.72f, 0.65f); }
Rgb letters(Vec2 uv) { // a map with 8 columns and 4 rows of the letter F
    const int x = static_cast<int>(uv.x * 8 * 6) % 6, y = static_cast<int>(uv.y * 4 * 7) % 7;
    const bool ink = "             #     #     ###   #     ####  "[6 * y + x] == '#'; // 7 rows, the lowest first
    return ink ? Rgb(0.05f, 0.03f, 0.1f) : Rgb(uv.y, 0.5f, 1 - 0.8f * uv.y);
}

int main(int argc, char** argv) {
    float scale = 4, swirl = 10;
    read_parameters(argc, argv, {{"noise scale", scale, 0.5f, 20}, {"swirl", swirl, 0, 40}});
    const auto color = [](float x, float y, Random&) { return planet(sphere_normal({x / 320, 1 - y / 160})); };
    write_image("planet.png", average_samples(320, 160, 4, color));
    StoredImage file = read_stored_image("planet.png");
    const ImageRgb map = to_linear(file); // the light that the numbers of the file stand for
    file.encoding = StoredImage::Encoding::kLinear;
    const ImageRgb pale = to_linear(file); // the numbers themselves
    const auto image = [](const ImageRgb& pixels) { return [&](Vec2 uv, Vec3) { return image_color(pixels, uv); }; };
    const auto stone = [=](const auto& noise) { // a texture from noise; the shift is any
        const Rgb dark(0.1f, 0.12f, 0.14f), light(0.9f, 0.88f, 0.8f);
        return [=](Vec2, Vec3 p) { return lerp(dark, light, 0.5f + 0.5f * noise(p * scale + Vec3(2.7f, 0, 1.4f))); };
    };
    const auto marble = [=](Vec3 p) { return std::sin(1.2f * p.y + swirl * std::abs(fractal_noise(p * 0.3f, 5))); };
    const auto tiles = [](Vec2, Vec3 p) { return squares({p.x, 0, p.z}); };
    const Scene scene{{{{0, -301, 0}, 300}, {{-0.55f, 0, 0}, 1}, {{1.45f, -0.3f, 0.5f}, 0.7f}},
                      {tiles, image(map), stone(marble)}};
    draw("evidence.png", scene, {.eye = {0, 1, 8}, .look_at = {0, -0.15f, 0}, .fov_degrees = 19}, 320, 180, 64);
    draw_row("noise.png", {stone(gradient_noise), stone([](Vec3 p) { return fractal_noise(p, 6); }), stone(marble)});
    const auto slope = [](const auto& noise) { // how steeply noise rises along x
        return [=](Vec3 p) { return 50 * (noise(p) - noise(p - Vec3{0.01f, 0, 0})); };
    };
    const auto linear = [](Vec3 p) { return lattice_noise(p, corner_slope, [](float t) { return t; }); };
    draw_row("fade.png", {stone(slope(linear)), stone(slope(gradient_noise))});
    const auto mirrored = [](Vec2 uv, Vec3) { return letters({1 - uv.x, uv.y}); };
    const auto upside_down = [](Vec2 uv, Vec3) { return letters({uv.x, 1 - uv.y}); };
    draw_row("letters.png", {[](Vec2 uv, Vec3) { return letters(uv); }, mirrored, upside_down});
    const auto flat = [](Vec2 uv, Vec3) { return planet({4 * uv.x + (uv.x < 0.5f ? 4.0f : 0), 2 * uv.y - 1, 2}); };
    draw_row("globes.png", {image(map), image(pale), flat});
    const auto cut_off = [](Vec2, Vec3 p) { return squares(Vec3(Vec3T<int>(p * 4.0f))); }; // as int does it
    draw_row("zero.png", {[](Vec2, Vec3 p) { return squares(p * 4.0f); }, cut_off});
}
