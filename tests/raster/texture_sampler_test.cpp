// These tests check that batched texture lookups give the same bits as single lookups.
#include "raster/shader/texture_sampler.h"

#include "common/texture/mipmap.h"
#include "raster/raster_scene.h"
#include "tests/raster/varied_scene.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

using namespace duet;
using namespace duet::raster;
using namespace duet::test;

namespace {

TextureSet random_texture(int width, int height, const ImageTexture& texture) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    ImageRgb image(width, height);
    for (Rgb& pixel : image.pixels()) pixel = {uniform(random), uniform(random), uniform(random)};
    TextureSet set{.textures = {texture}, .images = {image}};
    build_mipmaps(set);
    return set;
}

/// Returns positions in and around the image, with footprints of all lengths, shapes and directions, including zero
/// and NaN.
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

bool bitwise_equal(Rgb a, Rgb b) { // any two NaNs are equal
    const auto same = [](float x, float y) {
        return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y) || (x != x && y != y);
    };
    return same(a.r, b.r) && same(a.g, b.g) && same(a.b, b.b);
}

/// Returns how many lookups differ in any bit.
int differences(const TextureSet& set) {
    const ImageTexture& texture = std::get<ImageTexture>(set.textures[0]);
    const TextureSampler texels(set.images[0], set.mip_levels[0]);
    std::mt19937 random(11);
    int differ = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        std::array<SurfacePoint, Floats::size> points;
        for (SurfacePoint& p : points) p = random_point(random);
        const auto side_by_side = [&](Vec2 SurfacePoint::*which) {
            PacketOf<float> x, y;
            for (std::size_t i = 0; i < points.size(); ++i) x[i] = (points[i].*which).x, y[i] = (points[i].*which).y;
            return Vec2T<Floats>(load(x, 0), load(y, 0));
        };
        const auto lanes = static_cast<std::uint32_t>(random()) & ((1u << Floats::size) - 1);
        const RgbT<Floats> many = texels.sample(texture, {.uv = side_by_side(&SurfacePoint::uv),
                                                          .duv_dx = side_by_side(&SurfacePoint::duv_dx),
                                                          .duv_dy = side_by_side(&SurfacePoint::duv_dy),
                                                          .lanes = lanes});
        RgbT<PacketOf<float>> found;
        store(found.r, 0, many.r), store(found.g, 0, many.g), store(found.b, 0, many.b);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Rgb expected = (lanes >> i & 1) != 0 ? evaluate_texture(set, set.textures[0], points[i]) : Rgb();
            differ += !bitwise_equal({found.r[i], found.g[i], found.b[i]}, expected);
        }
    }
    return differ;
}
int differences(int width, int height, const ImageTexture& texture) {
    return differences(random_texture(width, height, texture));
}

/// Returns a torus with one texture that repeats twice around it. Some triangles have no area in the texture. If
/// `together` is false it has two materials, though they are equal.
Scene textured_scene(const ImageTexture& texture, bool with_coordinates, bool together) {
    Scene scene;
    Mesh mesh = smooth_torus(48, 24);
    for (std::size_t i = 0; with_coordinates && i < mesh.positions.size(); ++i)
        mesh.uvs.push_back(i < 100 ? Vec2(0.3f, 0.7f)
                                   : Vec2(static_cast<float>(i / 24) / 24, static_cast<float>(i % 24) / 12));
    scene.textures = random_texture(61, 40, texture);
    add(scene, std::move(mesh), Mat4(), Diffuse{{Rgb(0.9f, 0.8f, 0.7f), 0}});
    if (!together) scene.objects[0].materials.push_back(scene.objects[0].materials[0]);
    finish_scene(scene);
    return scene;
}

/// Returns base colors that are sampled in batches or one by one.
ImageRgb base_colors(const ImageTexture& texture, bool with_coordinates, bool together) {
    const Scene scene = textured_scene(texture, with_coordinates, together);
    RasterSettings settings;
    settings.shading = Shading::kAlbedo;
    const RasterScene prepared = prepare(scene, settings);
    REQUIRE(prepared.data().objects[0].uniform_texture.has_value() == together);
    Control control;
    return raster::render(prepared, perspective(), settings, control).radiance;
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

    TEST_CASE("texels: infinite ones reach those places alone that they lie at") {
        for (const TextureFilter filter : {TextureFilter::kTrilinear, TextureFilter::kAnisotropic}) {
            TextureSet set = random_texture(37, 101, {.image = 0, .scale = {1, 1}, .filter = filter});
            std::mt19937 random(5);
            for (int i = 0; i < 300; ++i)
                set.images.edit(0)[random() % set.images[0].size()].g = std::numeric_limits<float>::infinity();
            build_mipmaps(set);
            CHECK(differences(set) == 0);
        }
    }

    TEST_CASE("base colors of a packet: the same bits together and one by one") {
        for (const TextureFilter filter : {TextureFilter::kTrilinear, TextureFilter::kAnisotropic})
            for (const bool with_coordinates : {true, false}) {
                const ImageTexture texture{.image = 0, .scale = {1.7f, -0.6f}, .filter = filter};
                const ImageRgb together = base_colors(texture, with_coordinates, true);
                const ImageRgb alone = base_colors(texture, with_coordinates, false);
                int differ = 0, seen = 0;
                for (std::size_t i = 0; i < together.size(); ++i) {
                    differ += !bitwise_equal(together[i], alone[i]);
                    seen += !is_black(together[i]);
                }
                CHECK(differ == 0);
                CHECK(seen > 10'000);
            }
    }

    TEST_CASE("texels: of what is not filtered there are none") {
        CHECK(texture_samplers(random_texture(8, 8, {.filter = TextureFilter::kBilinear})).at(0).empty());
        CHECK(texture_samplers(random_texture(1, 1, {})).at(0).empty());
        const TextureSet set = random_texture(8, 4, {});
        CHECK(!texture_samplers(set).at(0).empty());
    }
}
