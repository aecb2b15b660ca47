// The library's textures (common/texture/texture.h) and its interpolation in perspective (raster/geometry/planes.h).
#include "common/texture/texel_index.h"
#include "common/texture/texture.h"
#include "raster/geometry/planes.h"
#include "raster/lessons/07-textures/lab.h"

namespace duet::lab {

Vec3 perspective_weights(Vec3 weights, Vec3 w) {
    // This is a triangle with its corners at (0, 0), (1, 0) and (0, 1) of the image: the weights are coordinates.
    const auto planes = raster::triangle_planes<float>({0, w.y, 0}, {0, 0, w.z}, {w.x, w.y, w.z}, {0, 0, 0});
    const auto at = [&](const std::array<float, 3>& plane) {
        return plane[0] * weights.y + plane[1] * weights.z + plane[2];
    };
    const float b = at(planes.e1) / at(planes.sum), c = at(planes.e2) / at(planes.sum);
    return {1 - b - c, b, c};
}

int wrap(int i, int size) {
    const double n = size;
    return static_cast<int>(wrap_repeat((i + 0.5) / n) * n);
}

namespace {

Rgb sample(const ImageRgb& image, Vec2 uv, TextureFilter filter) {
    const TextureSet set{{}, {image}};
    SurfacePoint point{};
    point.uv = uv;
    return evaluate_texture(set, ImageTexture{.image = 0, .scale = {1, 1}, .filter = filter}, point);
}

} // namespace

Rgb nearest(const ImageRgb& image, Vec2 uv) { return sample(image, uv, TextureFilter::kNearest); }
Rgb bilinear(const ImageRgb& image, Vec2 uv) { return sample(image, uv, TextureFilter::kBilinear); }

ImageRgb draw_quad(const std::array<Corner, 4>& corners, const ImageRgb& texture, int width, int height,
                   Rgb background) {
    ImageRgb image(width, height, background);
    for (std::size_t i = 0; i < 2; ++i) {
        const Corner &a = corners[0], &b = corners[i + 1], &c = corners[i + 2];
        const Vec4 pa = lesson::to_image(a.clip, width, height), pb = lesson::to_image(b.clip, width, height),
                   pc = lesson::to_image(c.clip, width, height);
        lesson::for_each_pixel({pa.x, pa.y}, {pb.x, pb.y}, {pc.x, pc.y}, width, height, [&](int x, int y, Vec3 seen) {
            const Vec3 w = perspective_weights(seen, {pa.w, pb.w, pc.w});
            image(x, y) = bilinear(texture, a.uv * w.x + b.uv * w.y + c.uv * w.z);
        });
    }
    return image;
}

} // namespace duet::lab
