#include "common/texture/texture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace duet;

namespace {

// Each texel has a different color: (column, row from the bottom, 1).
ImageRgb numbered_image(int width, int height) {
    ImageRgb image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image(x, height - 1 - y) = Rgb(static_cast<float>(x), static_cast<float>(y), 1);
    return image;
}

Rgb look_up(const TextureSet& set, Vec2 uv) {
    SurfacePoint point{};
    point.uv = uv;
    return evaluate_texture(set, set.textures[0], point);
}

Rgb look_up(const ImageRgb& image, bool bilinear, Vec2 uv, Vec2 scale = {1, 1}) {
    return look_up({{ImageTexture{0, scale, bilinear ? TextureFilter::kBilinear : TextureFilter::kNearest}}, {image}},
                   uv);
}

Rgb at_uv(const Texture& texture, Vec2 uv) {
    SurfacePoint point{};
    point.uv = uv;
    return evaluate_texture({}, texture, point);
}

Rgb at_object(const Texture& texture, Vec3 p) {
    SurfacePoint point{};
    point.p_object = p;
    return evaluate_texture({}, texture, point);
}

constexpr float kFar[] = {1e7f, -1e7f, 1e30f, -1e30f, 3.4e38f, -3.4e38f, 1e-30f, -1e-30f, 1e-45f, -1e-45f, 0.0f, -0.0f};

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("image: (0, 0) is the lower left corner") {
        ImageRgb image(2, 2);
        image(0, 0) = Rgb(1); // upper left in the file
        image(0, 1) = Rgb(2); // lower left
        image(1, 1) = Rgb(3); // lower right
        CHECK(look_up(image, false, {0.1f, 0.1f}) == Rgb(2));
        CHECK(look_up(image, false, {0.9f, 0.1f}) == Rgb(3));
        CHECK(look_up(image, false, {0.1f, 0.9f}) == Rgb(1));
        CHECK(look_up(image, true, {0.25f, 0.25f}) == Rgb(2));
    }

    TEST_CASE("image: bilinear is exact at texel centers, nearest on all of a texel, in each period") {
        const ImageRgb image = numbered_image(8, 4);
        for (int period = -3; period <= 3; ++period)
            for (int y = 0; y < 4; ++y)
                for (int x = 0; x < 8; ++x) {
                    const auto place = [&](float dx, float dy) {
                        return Vec2{static_cast<float>(period) + (static_cast<float>(x) + dx) / 8,
                                    static_cast<float>(-2 * period) + (static_cast<float>(y) + dy) / 4};
                    };
                    const Rgb texel(static_cast<float>(x), static_cast<float>(y), 1);
                    CHECK(look_up(image, true, place(0.5f, 0.5f)) == texel);
                    for (const float d : {0.0f, 0.25f, 0.5f, 0.9375f})
                        CHECK(look_up(image, false, place(d, 0.9375f - d)) == texel);
                }
    }

    TEST_CASE("image: bilinear interpolates between centers, and across the seam") {
        const ImageRgb image = numbered_image(8, 4);
        CHECK(look_up(image, true, {3.25f / 8, 2.0f / 4}) == Rgb(2.75f, 1.5f, 1));
        // Between the last column and the first, the value is their average at the border, on both sides and in each
        // period.
        for (const float u : {-2.0f, -1.0f, 0.0f, 1.0f, 5.0f})
            CHECK(look_up(image, true, {u, 0.625f}) == Rgb(3.5f, 2, 1));
        for (const float v : {-2.0f, -1.0f, 0.0f, 1.0f, 5.0f})
            CHECK(look_up(image, true, {0.3125f, v}) == Rgb(2, 1.5f, 1));
        CHECK(look_up(image, true, {1.0f / 32, 0.125f}) == Rgb(0.25f * 7, 0, 1));
        CHECK(look_up(image, true, {-1.0f / 32, 0.125f}) == Rgb(0.75f * 7, 0, 1));
        // Just beside a border, the value must be close to the border's value, not one period off.
        for (const float u : {-1e-9f, 1e-9f, -1e-30f, std::nextafter(1.0f, 0.0f), std::nextafter(1.0f, 2.0f)})
            CHECK(look_up(image, true, {u, 0.625f}).r == doctest::Approx(3.5f).epsilon(1e-5));
        CHECK(look_up(image, false, {-1e-9f, 0.1f}).r == 7.0f);
        CHECK(look_up(image, false, {std::nextafter(1.0f, 0.0f), 0.1f}).r == 7.0f);
    }

    TEST_CASE("image: float finds places to within 2^-23 of a period, where uv are at most 1") {
        constexpr int kWidth = 3000, kHeight = 700;
        const TextureSet set{{ImageTexture{0, {1, 1}, TextureFilter::kBilinear}}, {numbered_image(kWidth, kHeight)}};
        std::mt19937 random(17);
        std::uniform_real_distribution<float> uniform(-1, 1);
        double worst = 0; // in periods, over each error separately
        for (int i = 0; i < 20000; ++i) {
            const Vec2 uv{uniform(random), uniform(random)};
            const Rgb found = look_up(set, uv);
            const auto error = [&](float coordinate, float texel, int count) {
                const double t = static_cast<double>(coordinate), place = (t - std::floor(t)) * count - 0.5;
                const bool at_seam = place < 0 || place > count - 1;
                return at_seam ? 0 : std::abs(static_cast<double>(texel) - place) / count;
            };
            worst = std::max({worst, error(uv.x, found.r, kWidth), error(uv.y, found.g, kHeight)});
        }
        CHECK(worst < 0x1p-23);
        CHECK(worst > 0x1p-26); // the arithmetic is in float
    }

    TEST_CASE("image: scale repeats the image") {
        const ImageRgb image = numbered_image(8, 4);
        CHECK(look_up(image, false, {0.30f, 0.55f}, {3, 2}) == look_up(image, false, {0.90f, 0.10f}));
        CHECK(look_up(image, true, {0.5f, 0.5f}, {-1, 1}).r == doctest::Approx(3.5f));
        CHECK(look_up(image, false, {0.1f, 0.1f}, {-1, 1}).r == 7.0f);
    }

    TEST_CASE("image: one texel, and uv of any size, give texels of the image") {
        const ImageRgb one(1, 1, Rgb(0.25f, 0.5f, 4)), image = numbered_image(7, 5);
        constexpr float infinity = std::numeric_limits<float>::infinity(),
                        nan = std::numeric_limits<float>::quiet_NaN();
        std::vector<float> places(std::begin(kFar), std::end(kFar));
        places.insert(places.end(), {infinity, -infinity, nan});
        for (const bool bilinear : {false, true})
            for (const float u : places)
                for (const float v : places) {
                    CHECK(look_up(one, bilinear, {u, v}) == Rgb(0.25f, 0.5f, 4));
                    const Rgb colour = look_up(image, bilinear, {u, v}, {1e30f, -3});
                    CHECK((colour.r >= 0 && colour.r <= 6 && colour.g >= 0 && colour.g <= 4));
                    CHECK(colour.b == doctest::Approx(1));
                }
    }

    TEST_CASE("checker over uv: squares of side 1/scale") {
        const CheckerTexture checker{Rgb(1), Rgb(0), 4, false};
        for (int j = -9; j < 9; ++j)
            for (int i = -9; i < 9; ++i) {
                const float expected = (i + j) % 2 == 0 ? 1.0f : 0.0f;
                for (const float d : {0.0f, 0.5f, 0.999f}) {
                    CAPTURE(i);
                    CAPTURE(j);
                    CHECK(at_uv(checker, {(static_cast<float>(i) + d) / 4, (static_cast<float>(j) + 0.5f) / 4}).r ==
                          expected);
                }
            }
        for (const float u : kFar)
            for (const float v : kFar) CHECK((at_uv(checker, {u, v}) == Rgb(1) || at_uv(checker, {u, v}) == Rgb(0)));
    }

    TEST_CASE("checker in space: cubes of side 1/scale, and one color on a face along their border") {
        const CheckerTexture checker{Rgb(1), Rgb(0), 2, true};
        for (int k = -3; k < 3; ++k)
            for (int j = -3; j < 3; ++j)
                for (int i = -3; i < 3; ++i) {
                    const Vec3 centre{static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f,
                                      static_cast<float>(k) + 0.5f};
                    CHECK(at_object(checker, centre * 0.5f).r == ((i + j + k) % 2 == 0 ? 1.0f : 0.0f));
                }
        for (const float y : {-1.0f, 0.0f, 2.5f})
            for (const float rounding : {-1e-6f, 0.0f, 1e-6f})
                CHECK(at_object(checker, {0.3f, y + rounding, 0.3f}) == at_object(checker, {0.3f, y + 0.1f, 0.3f}));
        for (const float x : kFar) CHECK(is_finite(at_object(checker, {x, -x, 1})));
    }

    TEST_CASE("noise: colors between low and high, of any size of point, all octaves") {
        std::mt19937 random(3);
        std::uniform_real_distribution<float> place(-50, 50);
        for (const bool marble : {false, true})
            for (const int octaves : {1, 4, 16}) {
                const NoiseTexture noise{Rgb(0.1f, 0.2f, 5), Rgb(0.9f, 0.2f, 3), 4, octaves, marble};
                const auto check = [&](Rgb colour) {
                    CHECK((colour.r >= 0.0999999f && colour.r <= 0.9000001f));
                    CHECK(colour.g == doctest::Approx(0.2f));
                    CHECK((colour.b >= 2.999999f && colour.b <= 5.000001f));
                };
                float least = 1, most = 0;
                for (int i = 0; i < 2000; ++i) {
                    const Rgb colour = at_object(noise, {place(random), place(random), place(random)});
                    check(colour);
                    least = std::min(least, colour.r);
                    most = std::max(most, colour.r);
                }
                CHECK(least < 0.3f); // most of the range is covered
                CHECK(most > 0.7f);
                for (const float x : kFar)
                    for (const float y : kFar) check(at_object(noise, {x, y, x}));
            }
    }

    TEST_CASE("noise: scale is the number of cycles a meter") {
        const NoiseTexture coarse{Rgb(0), Rgb(1), 1, 3, false}, fine{Rgb(0), Rgb(1), 8, 3, false};
        for (const float x : {0.1f, 3.7f, -12.3f})
            CHECK(at_object(coarse, {x, 2 * x, 0}) == at_object(fine, {x / 8, x / 4, 0}));
    }

    TEST_CASE("a slot is its value, or the texture times it") {
        const TextureSet set{{CheckerTexture{Rgb(0.5f), Rgb(0.25f), 1, false}}, {}};
        SurfacePoint point{};
        point.uv = {0.5f, 0.5f};
        CHECK(evaluate(set, RgbSlot{Rgb(1, 2, 3), -1}, point) == Rgb(1, 2, 3));
        CHECK(evaluate(set, RgbSlot{Rgb(1, 2, 4), 0}, point) == Rgb(0.5f, 1, 2));
    }
}
