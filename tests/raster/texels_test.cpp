// Textures looked up side by side against the same looked up one by one: the same bits.
#include "raster/texels.h"

#include "common/texture/pyramid.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace duet;
using namespace duet::raster;

namespace {

TextureSet random_texture(int width, int height, const ImageTexture& texture) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    ImageRgb image(width, height);
    for (Rgb& pixel : image.pixels()) pixel = {uniform(random), uniform(random), uniform(random)};
    TextureSet set{.textures = {texture}, .images = {image}};
    build_pyramids(set);
    return set;
}

/// Places in and about the picture; steps of all lengths, shapes and directions, among them none and some that are no numbers.
SurfacePoint random_point(std::mt19937& random) {
    std::uniform_real_distribution<float> place(-2, 3), sign(-1, 1), size(-14, 3);
    SurfacePoint point;
    point.uv = {place(random), place(random)};
    const auto step = [&] { return sign(random) * std::exp2(size(random)); };
    point.duv_dx = {step(), step()}, point.duv_dy = {step(), step()};
    switch (random() % 16) {
    case 0:
        point.duv_dx = point.duv_dy = {};
        break;
    case 1:
        point.duv_dy = point.duv_dx * 0.001f;
        break;
    case 2:
        point.duv_dx.x = std::numeric_limits<float>::infinity();
        break;
    case 3:
        point.duv_dy.y = point.uv.x = std::numeric_limits<float>::quiet_NaN();
        break;
    default:
        break;
    }
    return point;
}

/// How many of 16,000 look-ups differ in any bit.
int differences(int width, int height, const ImageTexture& texture) {
    const TextureSet set = random_texture(width, height, texture);
    const Texels texels(set.images[0], set.smaller[0]);
    std::mt19937 random(11);
    int differ = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        std::array<SurfacePoint, Floats::size> points;
        TexturePlaces places;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const SurfacePoint& p = points[i] = random_point(random);
            for (std::size_t axis = 0; axis < 2; ++axis) {
                places.uv[axis][i] = axis == 0 ? p.uv.x : p.uv.y;
                places.duv_dx[axis][i] = axis == 0 ? p.duv_dx.x : p.duv_dx.y;
                places.duv_dy[axis][i] = axis == 0 ? p.duv_dy.x : p.duv_dy.y;
            }
        }
        const RgbT<Floats> many = texels.look_up(texture, places);
        RgbT<StripOf<float>> found;
        store(found.r, 0, many.r), store(found.g, 0, many.g), store(found.b, 0, many.b);
        for (std::size_t i = 0; i < points.size(); ++i)
            differ += Rgb(found.r[i], found.g[i], found.b[i]) != evaluate_texture(set, set.textures[0], points[i]);
    }
    return differ;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("texels: a texture looked up at many places at once is the same as at each alone, bit for bit") {
        for (const TextureFilter filter : {TextureFilter::kTrilinear, TextureFilter::kAnisotropic}) {
            CHECK(differences(64, 64, {.image = 0, .scale = {1, 1}, .filter = filter}) == 0);
            CHECK(differences(37, 101, {.image = 0, .scale = {1.7f, -0.3f}, .filter = filter}) == 0);
            CHECK(differences(2, 1, {.image = 0, .scale = {1, 1}, .filter = filter}) == 0);
        }
    }

    TEST_CASE("texels: what is not filtered is not packed") {
        CHECK(pack_texels(random_texture(8, 8, {.filter = TextureFilter::kBilinear})).at(0).empty());
        CHECK(pack_texels(random_texture(1, 1, {})).at(0).empty());
        const std::vector<Texels> packed = pack_texels(random_texture(8, 4, {}));
        CHECK(packed.at(0).memory_bytes() == 16 * (8 * 4 + 4 * 2 + 2 * 1 + 1));
    }
}
