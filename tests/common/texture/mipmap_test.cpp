// These tests check filtered texture lookups: the mip sizes of an image and which texels a footprint covers.
#include "common/texture/anisotropic_probes.h"
#include "common/texture/mipmap.h"
#include "common/texture/texture.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace duet;

namespace {

ImageRgb random_image(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    ImageRgb image(width, height);
    for (Rgb& pixel : image.pixels()) pixel = {uniform(random), uniform(random), uniform(random)};
    return image;
}

/// Returns the mean over [x0, x1) × [y0, y1), in pixels.
double area_mean(const ImageRgb& image, double x0, double x1, double y0, double y1) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const double w = std::max(0.0, std::min(x + 1.0, x1) - std::max<double>(x, x0));
            const double h = std::max(0.0, std::min(y + 1.0, y1) - std::max<double>(y, y0));
            sum += w * h * static_cast<double>(image(x, y).g);
        }
    return sum / ((x1 - x0) * (y1 - y0));
}

/// Holds the covariance of a probe line's filter in texels: that of the probe positions plus that of a single probe.
struct Covariance {
    double xx, xy, yy;
};
Covariance covariance(const AnisotropicProbes& line) {
    const Vec2d step(line.step);
    const double count = line.count, blend = line.blend, places = (count * count - 1) / 12.0;
    const double finer = std::exp2(2 * static_cast<double>(line.level)), probe = finer * (1 + 3 * blend) / 4;
    return {places * step.x * step.x + probe, places * step.x * step.y, places * step.y * step.y + probe};
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("halved: each pixel is the mean over its area, for any size") {
        for (int width = 1; width <= 9; ++width)
            for (const int height : {1, 2, 5, 8, 13}) {
                const ImageRgb image = random_image(width, height, static_cast<unsigned>(width * 100 + height));
                const ImageRgb half = downsample(image);
                REQUIRE(half.width() == std::max(width / 2, 1));
                REQUIRE(half.height() == std::max(height / 2, 1));
                const double sx = static_cast<double>(width) / half.width(),
                             sy = static_cast<double>(height) / half.height();
                for (int y = 0; y < half.height(); ++y)
                    for (int x = 0; x < half.width(); ++x)
                        CHECK(static_cast<double>(half(x, y).g) ==
                              doctest::Approx(area_mean(image, x * sx, (x + 1) * sx, y * sy, (y + 1) * sy))
                                  .epsilon(1e-6));
            }
    }

    TEST_CASE("smaller versions end with one pixel, the mean of all") {
        const ImageRgb image = random_image(100, 37, 7);
        const std::vector<ImageRgb> levels = make_mip_levels(image);
        REQUIRE(levels.size() == 6); // 50, 25, 12, 6, 3, 1
        REQUIRE(levels.back().size() == 1);
        CHECK(static_cast<double>(levels.back()[0].g) ==
              doctest::Approx(area_mean(image, 0, 100, 0, 37)).epsilon(1e-5));
        CHECK(make_mip_levels(ImageRgb(1, 1)).empty());
    }

    TEST_CASE("probes have the second moments of the pixel's box") {
        std::mt19937 random(3);
        std::uniform_real_distribution<double> uniform(-1, 1), exponent(1, 6);
        for (int i = 0; i < 10000; ++i) {
            const double scale = std::exp2(exponent(random));
            const Vec2d dx{scale * uniform(random), scale * uniform(random)};
            const Vec2d dy{scale * uniform(random), scale * uniform(random)};
            const double area = std::abs(dx.x * dy.y - dx.y * dy.x);
            // The trace is approximately the squared longer axis.
            const double length2 = dx.x * dx.x + dx.y * dx.y + dy.x * dy.x + dy.y * dy.y;
            const AnisotropicProbes line = anisotropic_probes(Vec2(dx), Vec2(dy), kMaxAnisotropy);
            REQUIRE(line.count >= 1);
            REQUIRE(line.count <= kMaxAnisotropy);
            // Test only footprints wider than a probe's minimum width and not longer than the maximum number of
            // probes covers.
            if (area * area / length2 < 3.1 || length2 / area > kMaxAnisotropy - 1) continue;
            const Covariance c = covariance(line);
            const double tolerance = 1e-5 * length2 / 12; // float rounding
            CHECK(std::abs(c.xx - (dx.x * dx.x + dy.x * dy.x) / 12) < tolerance);
            CHECK(std::abs(c.yy - (dx.y * dx.y + dy.y * dy.y) / 12) < tolerance);
            CHECK(std::abs(c.xy - (dx.x * dx.y + dy.x * dy.y) / 12) < tolerance);
        }
    }

    TEST_CASE("probes: magnified, edge-on, and without a footprint") {
        const auto probes = [](Vec2 dx, Vec2 dy, int most = kMaxAnisotropy) {
            return anisotropic_probes(dx, dy, most);
        };
        CHECK(probes({0, 0}, {0, 0}).count == 1);
        CHECK(probes({0, 0}, {0, 0}).blend == 0);
        CHECK(probes({0.5f, 0}, {0, 0.5f}).level == 0);
        CHECK(probes({0.5f, 0}, {0, 0.5f}).blend == 0);
        for (const Vec2 dx : {Vec2(INFINITY, 0), Vec2(NAN, 1), Vec2(1e30f, 1e30f), Vec2(1e15f, 1e15f), Vec2(3e8f, 0)}) {
            const AnisotropicProbes line = probes(dx, {0, 1});
            CHECK(line.level >= 20);
            CHECK((line.count >= 1 && line.count <= kMaxAnisotropy));
            CHECK((std::isfinite(line.step.x) && std::isfinite(line.step.y)));
        }
        CHECK(probes({1e8f, 0}, {0, 1}).count <= kMaxAnisotropy);
        CHECK(probes({40, 0}, {0, 4}, 1).count == 1); // a single trilinear lookup
        CHECK(probes({40, 0}, {0, 4}, 1).level == 4); // the level follows the longer axis
    }

    TEST_CASE("filtered look-ups: constants stay, nothing shows at the seam, wide footprints give the mean") {
        const ImageRgb constant_image(24, 10, Rgb(0.25f, 0.5f, 0.75f));
        TextureSet set{{ImageTexture{0}, ImageTexture{1}}, {constant_image, random_image(30, 17, 5)}};
        build_mipmaps(set);
        std::mt19937 random(9);
        std::uniform_real_distribution<float> uniform(-1, 1);
        for (int i = 0; i < 2000; ++i) {
            SurfacePoint point;
            const float size = std::exp2(8 * uniform(random));
            point.duv_dx = {size * uniform(random), size * uniform(random)};
            point.duv_dy = {size * uniform(random), size * uniform(random)};
            point.uv = {uniform(random), uniform(random)};
            const Rgb constant = evaluate_texture(set, set.textures[0], point);
            CHECK(constant.r == doctest::Approx(0.25f));
            CHECK(constant.b == doctest::Approx(0.75f));
            point.uv.x = -1e-7f;
            const Rgb before = evaluate_texture(set, set.textures[1], point);
            point.uv.x = 1e-7f;
            const Rgb after = evaluate_texture(set, set.textures[1], point);
            CHECK(std::abs(before.g - after.g) < 1e-4f);
            point.duv_dx = {1000, 0};
            point.duv_dy = {0, 1000};
            CHECK(evaluate_texture(set, set.textures[1], point).g == doctest::Approx(set.mip_levels[1].back()[0].g));
        }
    }
}
