// These tests check the denoiser: it reduces noise, keeps what is no noise, and survives any film.
#include "raytrace/denoise/denoise.h"

#include "common/image/bitwise_equal.h"
#include "common/system/error.h"
#include "raytrace/denoise/features.h"
#include "raytrace/render.h"
#include "tests/raytrace/scene_builder.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

using namespace duet;
using namespace duet::raytrace;

namespace {

using Colors = std::function<Rgb(int x, int y)>;

// Returns features that are the same everywhere, except for the albedo.
Planes features_of(int width, int height, const Colors& albedo) {
    Planes features(width, height, kFeatures);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            for (std::size_t c = 0; c < 3; ++c) *features.at(c, x, y) = albedo(x, y)[c];
            *features.at(5, x, y) = 1; // normal z
            *features.at(6, x, y) = 1; // inverse depth
        }
    features.extend_to_border();
    return features;
}

// Returns a film of `samples` samples per pixel. Each is the color times a random number of mean 1 and of standard
// deviation `deviation`, evenly distributed.
Film noisy_film(int width, int height, int samples, float deviation, const Colors& color, unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> uniform(-std::sqrt(3.0f), std::sqrt(3.0f));
    Film film(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int i = 0; i < samples; ++i) {
                Rgb sample = color(x, y);
                for (std::size_t c = 0; c < 3; ++c) sample[c] *= std::max(0.0f, 1 + deviation * uniform(engine));
                film.add(x, y, static_cast<std::size_t>(i % 2), sample);
            }
    return film;
}

// Returns the mean squared error over the pixels that `counts` accepts.
double mse(
    const ImageRgb& image, const Colors& truth,
    const std::function<bool(int x, int y)>& counts = [](int, int) { return true; }) {
    double sum = 0, count = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            if (!counts(x, y)) continue;
            const Rgbd difference = Rgbd(image(x, y)) - Rgbd(truth(x, y));
            sum += average(difference * difference);
            ++count;
        }
    return sum / count;
}

bool all_valid(const ImageRgb& image) {
    for (const Rgb& color : image)
        if (!is_valid_radiance(color)) return false;
    return true;
}

Scene room() {
    SceneBuilder builder;
    const std::uint32_t gray = builder.material(Diffuse{{Rgb(0.5f, 0.6f, 0.7f)}});
    builder.add(quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}), gray);
    builder.add(Sphere{{-0.7f, 0, 0}, 1}, builder.material(Diffuse{{Rgb(0.9f, 0.3f, 0.2f)}}));
    builder.add(quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), builder.material(Emissive{Rgb(4.0f)}));
    return builder.finish();
}

Rendering render_room(const PathTracerSettings& settings) {
    const Scene scene = room();
    Control control;
    return render(prepare(scene, settings), View{scene.camera, 48, 40}, settings, control);
}

const Colors kGray = [](int, int) { return Rgb(0.5f); };

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("an image without noise is returned with the same bits, whatever it shows") {
        std::mt19937 engine(5);
        std::uniform_real_distribution<float> exponent(-20, 20);
        Image<Rgb> random(61, 45);
        for (Rgb& color : random.pixels()) color = Rgb(std::exp2(exponent(engine)), 0.3f, std::exp2(exponent(engine)));
        for (const Colors& color : {kGray, Colors([&](int x, int y) { return random(x, y); }), Colors([](int x, int y) {
                                        return Rgb(0.1f + 1e-4f * static_cast<float>(x + y));
                                    })}) {
            const Film film = noisy_film(61, 45, 4, 0, color, 1);
            // The features lead astray: they change where the color does not.
            const Planes features =
                features_of(61, 45, [](int x, int y) { return Rgb(x / 7 % 2 == y / 5 % 2 ? 0.9f : 0); });
            CHECK(bitwise_equal(denoise(film, features, 0), film.image()));
        }
    }

    TEST_CASE("the bits do not depend on the number of threads") {
        const Film film = noisy_film(150, 260, 6, 0.8f, kGray, 2);
        const Planes features = features_of(150, 260, [](int x, int) { return Rgb(static_cast<float>(x) / 150); });
        const ImageRgb one = denoise(film, features, 1);
        CHECK(bitwise_equal(denoise(film, features, 2), one));
        CHECK(bitwise_equal(denoise(film, features, 5), one));
        CHECK_FALSE(bitwise_equal(film.image(), one));
    }

    TEST_CASE("pixels without a sample in one half, dropped samples and unequal numbers of samples") {
        Film film(40, 30);
        std::mt19937 engine(3);
        std::uniform_real_distribution<float> uniform(0, 1);
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x) {
                const int samples = x < 5 ? 0 : x < 10 ? 1 : 2 + (x * 7 + y * 3) % 9;
                for (int i = 0; i < samples; ++i) {
                    film.add(x, y, static_cast<std::size_t>(i % 2), Rgb(uniform(engine)));
                    film.add(x, y, static_cast<std::size_t>(i % 2), Rgb(std::numeric_limits<float>::quiet_NaN()));
                }
            }
        const ImageRgb noisy = film.image(), denoised = denoise(film, features_of(40, 30, kGray), 0);
        CHECK(all_valid(denoised));
        std::size_t filtered = 0;
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x)
                if (x < 10)
                    CHECK(denoised(x, y) == noisy(x, y));
                else
                    filtered += denoised(x, y) == noisy(x, y) ? 0 : 1;
        CHECK(filtered > 800); // of 900
        // Unknown pixels are black or noise, and change nothing for their neighbors.
        const auto near_unknown = [](int x, int) { return x >= 10 && x < 13; };
        CHECK(mse(denoised, kGray, near_unknown) < mse(noisy, kGray, near_unknown) / 8);
    }

    TEST_CASE("any size") {
        for (const auto& size : {std::pair{1, 1}, {1, 7}, {9, 1}, {33, 17}, {3, 130}}) {
            const int width = size.first, height = size.second;
            CAPTURE(width);
            CAPTURE(height);
            const Film film = noisy_film(width, height, 4, 0.5f, kGray, 4);
            const ImageRgb denoised = denoise(film, features_of(width, height, kGray), 0);
            CHECK(denoised.width() == width);
            CHECK(denoised.height() == height);
            CHECK(all_valid(denoised));
        }
    }

    TEST_CASE("the result is finite and not negative for any radiance and any features") {
        std::mt19937 engine(6);
        std::uniform_real_distribution<float> exponent(-126, 127);
        std::bernoulli_distribution black(0.3);
        for (int round = 0; round < 4; ++round) {
            Film film(50, 40);
            for (int y = 0; y < 40; ++y)
                for (int x = 0; x < 50; ++x)
                    for (std::size_t i = 0; i < 4; ++i) {
                        Rgb sample;
                        for (std::size_t c = 0; c < 3; ++c)
                            sample[c] =
                                black(engine) ? 0 : std::exp2(round < 2 ? exponent(engine) / 8 : exponent(engine));
                        film.add(x, y, i % 2, sample);
                    }
            const Planes features = features_of(50, 40, [&](int, int) {
                return round % 2 == 0 ? Rgb(0.5f) : Rgb(std::exp2(exponent(engine) / 16), 0, exponent(engine));
            });
            CHECK(all_valid(denoise(film, features, 0)));
        }
    }

    TEST_CASE("a firefly is spread no farther than its other half allows") {
        Film film = noisy_film(64, 64, 8, 0.3f, kGray, 7);
        film.add(32, 32, 0, Rgb(1e5f));
        const ImageRgb denoised = denoise(film, features_of(64, 64, kGray), 0);
        double sum = 0;
        for (int y = 22; y < 43; ++y)
            for (int x = 22; x < 43; ++x) sum += denoised(x, y).r;
        CHECK(sum / (21 * 21) < 0.6); // spread over these pixels, it would add 25
        CHECK(denoised(32, 32).r < 2);
    }

    TEST_CASE("a bright pixel that both halves contain stays") {
        const Colors color = [](int x, int y) { return x == 20 && y == 20 ? Rgb(50.0f) : Rgb(0.5f); };
        const Film film = noisy_film(40, 40, 64, 0.2f, color, 8);
        const ImageRgb denoised = denoise(film, features_of(40, 40, kGray), 0);
        CHECK(denoised(20, 20).r == doctest::Approx(50).epsilon(0.1));
        CHECK(denoised(22, 20).r == doctest::Approx(0.5).epsilon(0.2));
    }

    TEST_CASE("render keeps the undenoised image, and refuses one sample") {
        PathTracerSettings settings;
        settings.samples_per_pixel = 8;
        settings.aovs.variance = true; // two replicates, as the denoiser needs
        const Rendering plain = render_room(settings);
        CHECK(plain.denoised.empty());
        settings.aovs.variance = false;
        settings.denoise = true;
        const Rendering denoised = render_room(settings);
        CHECK(bitwise_equal(denoised.radiance, plain.radiance));
        CHECK_FALSE(bitwise_equal(denoised.denoised, denoised.radiance));
        CHECK(all_valid(denoised.denoised));
        settings.samples_per_pixel = 1;
        CHECK_THROWS_AS(render_room(settings), Error);
    }

    TEST_CASE("every integrator and sampler can be denoised") {
        for (const Integrator integrator :
             {Integrator::kPath, Integrator::kNaive, Integrator::kBidirectional, Integrator::kVcm, Integrator::kPhotons,
              Integrator::kMetropolis, Integrator::kWhitted, Integrator::kDirect, Integrator::kUnshadowed,
              Integrator::kLights, Integrator::kEnvironment, Integrator::kReflection,
              Integrator::kNormal, Integrator::kAlbedo})
            for (const SamplerKind sampler : {SamplerKind::kSobol, SamplerKind::kStratified, SamplerKind::kBlueNoise,
                                              SamplerKind::kIndependent, SamplerKind::kCenter}) {
                if (integrator == Integrator::kMetropolis && sampler == SamplerKind::kCenter) continue; // refused
                CAPTURE(integrator_name(integrator));
                CAPTURE(sampler_name(sampler));
                PathTracerSettings settings;
                settings.integrator = integrator;
                settings.sampler = sampler;
                settings.samples_per_pixel = 2;
                settings.denoise = true;
                CHECK(all_valid(render_room(settings).denoised));
            }
    }

    TEST_CASE("a continued film, an adaptive one and a shard are denoised") {
        const test::ScratchFolder scratch;
        PathTracerSettings settings;
        settings.denoise = true;
        settings.samples_per_pixel = 32;
        const ImageRgb whole = render_room(settings).denoised;
        settings.film = scratch / "film.exr";
        settings.samples_per_pixel = 16;
        render_room(settings);
        settings.samples_per_pixel = 32;
        CHECK(bitwise_equal(render_room(settings).denoised, whole));
        settings.film.clear();
        settings.first_sample = 5;
        CHECK(all_valid(render_room(settings).denoised));
        settings.first_sample = 0;
        settings.adaptive = true;
        CHECK(all_valid(render_room(settings).denoised));
    }

} // TEST_SUITE

TEST_SUITE("statistical") {

    // Each test has one seed, so that it fails only after a change. The comments give the mean and the standard
    // deviation of its ratio over 60 other seeds. Bounds are more than four standard deviations off, which a change
    // that keeps the quality exceeds with odds below 1 in 10,000.

    TEST_CASE("noise on an even surface is reduced") { // by 221 ± 35
        const Film film = noisy_film(64, 64, 8, 0.5f, kGray, 10);
        const ImageRgb denoised = denoise(film, features_of(64, 64, kGray), 0);
        CHECK(mse(denoised, kGray) < mse(film.image(), kGray) / 60);
    }

    TEST_CASE("edges that the albedo shows stay sharp") { // 18.0 ± 1.8, and 9.7 ± 1.0
        const Colors color = [](int x, int y) {
            return x / 3 % 2 == y / 8 % 2 ? Rgb(0.8f, 0.2f, 0.1f) : Rgb(0.1f, 0.3f, 0.9f);
        };
        const Film film = noisy_film(64, 64, 8, 0.5f, color, 11);
        const ImageRgb denoised = denoise(film, features_of(64, 64, color), 0);
        CHECK(mse(denoised, color) < mse(film.image(), color) / 8);
        const ImageRgb astray = denoise(film, features_of(64, 64, kGray), 0);
        CHECK(mse(astray, color) > 2 * mse(denoised, color)); // without features, less noise can be removed
    }

    TEST_CASE("detail that no feature shows is not blurred more than noise is reduced") { // 0.984 ± 0.001
        const Colors color = [](int x, int y) {
            return Rgb(0.5f + 0.4f * std::sin(1.3f * static_cast<float>(x * y % 23)));
        };
        const Film film = noisy_film(64, 64, 64, 0.5f, color, 12);
        const ImageRgb denoised = denoise(film, features_of(64, 64, kGray), 0);
        CHECK(mse(denoised, color) < mse(film.image(), color));
    }

    // The exponential noise has many dark samples and a few bright ones. If weights depended on the noise of what they
    // weigh, the bright ones would count less: with weights from the same half, the ratio is 0.9908 ± 0.0007.
    TEST_CASE("skewed noise does not darken the image") { // 1.0018 ± 0.0006 of the brightness
        std::mt19937 engine(13);
        std::exponential_distribution<float> exponential(1);
        Film film(128, 128);
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 128; ++x)
                for (std::size_t i = 0; i < 8; ++i) film.add(x, y, i % 2, Rgb(0.5f * exponential(engine)));
        const ImageRgb noisy = film.image(), denoised = denoise(film, features_of(128, 128, kGray), 0);
        double before = 0, after = 0;
        for (std::size_t i = 0; i < noisy.size(); ++i) {
            before += static_cast<double>(noisy[i].r);
            after += static_cast<double>(denoised[i].r);
        }
        CHECK(after / before > 0.996);
        CHECK(after / before < 1.006);
    }

    TEST_CASE("a dark image is denoised as a bright one is") {
        const auto gain = [](float exposure) { // without features, so that the colors alone show the edges
            const Colors color = [&](int x, int y) { return Rgb(x / 16 % 2 == y / 16 % 2 ? 0.9f : 0.1f) * exposure; };
            const Film film = noisy_film(64, 64, 16, 0.5f, color, 14);
            return mse(film.image(), color) / mse(denoise(film, features_of(64, 64, kGray), 0), color);
        };
        const double bright = gain(1);
        CHECK(bright > 4);
        CHECK(gain(std::exp2(-24.0f)) > 0.5 * bright);
        CHECK(gain(std::exp2(16.0f)) > 0.5 * bright);
    }

    TEST_CASE("a rendering's error falls") { // by 2.0 to 4.2 with eight seeds: the edge of the light has most of it
        PathTracerSettings settings;
        settings.samples_per_pixel = 4096;
        const ImageRgb reference = render_room(settings).radiance;
        settings.samples_per_pixel = 8;
        settings.denoise = true;
        settings.seed = 1;
        const Rendering rendering = render_room(settings);
        const Colors truth = [&](int x, int y) { return reference(x, y); };
        CHECK(mse(rendering.denoised, truth) < mse(rendering.radiance, truth) / 1.3);
    }

} // TEST_SUITE
