// The library's places on a sphere (common/geometry/sphere.h), its images and checkerboards (common/texture/texture.h).
// Its noise has gradients of its own, so what this lab's contract says of noise is here as it is said there.
#include "common/geometry/sphere.h"
#include "common/texture/texture.h"
#include "raytrace/lessons/09-textures/lab.h"

namespace duet::lab {

Vec2 sphere_uv(Vec3 n) { return duet::sphere_uv(n); }

Rgb image_color(const ImageRgb& image, Vec2 uv) {
    const TextureSet set{{}, {image}};
    SurfacePoint point{};
    point.uv = {uv.x, clamp(uv.y, 0.0f, kOneMinusEpsilon)}; // the library repeats both
    return evaluate_texture(set, ImageTexture{.image = 0, .scale = {1, 1}, .filter = TextureFilter::kNearest}, point);
}

bool checker(Vec3 p) {
    SurfacePoint point{};
    point.p_object = p;
    return evaluate_texture({}, CheckerTexture{.even = Rgb(0), .odd = Rgb(1), .scale = 1, .solid = true}, point).r > 0;
}

float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

float gradient_noise(Vec3 p) {
    const Vec3 base{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    float sum = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3T<int> c = Vec3T<int>(base) + Vec3T<int>(i & 1, i >> 1 & 1, i >> 2);
        const Vec3 d = p - Vec3(c), near = Vec3(1, 1, 1) - abs(d);
        sum += fade(near.x) * fade(near.y) * fade(near.z) * dot(gradient(c.x, c.y, c.z), d);
    }
    return sum;
}

float turbulence(Vec3 p, int octaves) {
    return octaves == 0 ? 0 : abs(gradient_noise(p)) + turbulence(p * 2.0f, octaves - 1) / 2;
}

} // namespace duet::lab
