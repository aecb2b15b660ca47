// These tests check films in files: they are stored, continued with the same bits, and merged.
#include "raytrace/film/film_checkpoint.h"

#include "common/image/image_file.h"
#include "raytrace/film/merge_films.h"
#include "raytrace/render.h"
#include "tests/raytrace/scene_builder.h"
#include "tests/support/errors.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <thread>

using namespace duet;
using namespace duet::raytrace;
using namespace duet::test;

namespace {

constexpr int kWidth = 40, kHeight = 30;

/// Returns a scene whose floor has a filtered image texture. The filter becomes narrower with every sample.
Scene small_scene() {
    SceneBuilder builder;
    const std::uint32_t grey = builder.material(Diffuse{{Rgb(0.5f, 0.6f, 0.7f)}});
    ImageRgb checks(64, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) checks(x, y) = Rgb(((x ^ y) & 1) != 0 ? 0.9f : 0.1f);
    builder.scene.textures = {{ImageTexture{0}}, {checks}};
    builder.add(quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}), builder.material(Diffuse{{Rgb(1.0f), 0}}));
    builder.add(Sphere{{0, 0, 0}, 1}, grey);
    builder.scene.environment = SkyEnvironment{};
    return builder.finish();
}

Rendering rendered(const Scene& scene, const PathTracerSettings& settings, Control control = {}) {
    return render(prepare(scene, settings), View{scene.camera, kWidth, kHeight}, settings, control);
}

bool bitwise_equal(const Film& a, const Film& b) {
    return std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin(), b.pixels().end(),
                      [](const Film::Pixel& x, const Film::Pixel& y) {
                          for (std::size_t r = 0; r < Film::kReplicates; ++r)
                              for (std::size_t c = 0; c < 3; ++c)
                                  if (std::bit_cast<std::uint64_t>(x.sum[r][c]) !=
                                      std::bit_cast<std::uint64_t>(y.sum[r][c]))
                                      return false;
                          return x.count == y.count && x.invalid == y.invalid;
                      });
}

StoredFilm film_of(const Scene& scene, PathTracerSettings settings, const std::filesystem::path& path, int first,
                   int last) {
    settings.film = path;
    settings.first_sample = static_cast<std::uint32_t>(first);
    settings.samples_per_pixel = last - first;
    rendered(scene, settings);
    return read_film(path);
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the film of the largest image that can be rendered with one is a file that can be read") {
        const ScratchFolder folder;
        write_film(folder / "film.exr", StoredFilm{Film(1, 1), {}, 0});
        const double pixel = 4.0 * static_cast<double>(read_exr(folder / "film.exr").channels.size());
        CHECK(pixel * static_cast<double>(kMaxImagePixels) <= kMaxExrBytes);
    }

    TEST_CASE("a film comes back from its file with every bit, and any viewer sees its means") {
        const ScratchFolder folder;
        StoredFilm kept{Film(3, 2), {{"seed", "7"}, {"sampler", "sobol"}}, 12};
        for (int i = 0; i < 60; ++i) {
            const float value = std::ldexp(1.0f + static_cast<float>(i) * 0x1p-20f, i % 40 - 20);
            kept.film.add(i % 3, i / 3 % 2, static_cast<std::size_t>(i / 6 % 2), Rgb(value, 0.1f * value, 0));
        }
        kept.film.add(1, 1, 0, Rgb(-1.0f));
        write_film(folder / "film.exr", kept);
        const StoredFilm back = read_film(folder / "film.exr");
        CHECK(bitwise_equal(back.film, kept.film));
        CHECK(back.film.invalid(1, 1) == 1);
        CHECK(back.settings.size() == kept.settings.size());
        check_same_image("it", back, kept); // must throw
        CHECK(back.first_sample == 12);
        CHECK(read_image(folder / "film.exr").pixels() == kept.film.image().pixels());
    }

    TEST_CASE("a render that is stopped at any point and goes on from its film has the bits of one in one go") {
        const Scene scene = small_scene();
        for (const double where : {0.0, 0.01, 0.2, 0.4, 0.7, 0.9}) {
            PathTracerSettings settings;
            settings.samples_per_pixel = 40;
            settings.aovs.variance = where != 0.2 && where != 0.7; // with replicates, and without
            const ImageRgb expected = rendered(scene, settings).radiance;
            const ScratchFolder folder;
            settings.film = folder / "film.exr";
            std::atomic<bool> stop = where == 0;
            const Control stopping{&stop, [&](double fraction) { stop = fraction >= where; }};
            const Rendering half = rendered(scene, settings, stopping);
            CHECK(half.statistics.interrupted);
            CHECK(read_film(settings.film).film.image().pixels() == half.radiance.pixels());
            settings.threads = where < 0.5 ? 1 : 2;
            const Rendering whole = rendered(scene, settings);
            CHECK(whole.radiance.pixels() == expected.pixels());
            CHECK(whole.statistics.camera_rays + half.statistics.camera_rays == 40 * kWidth * kHeight);
            CHECK(rendered(scene, settings).statistics.camera_rays == 0); // no samples remain
        }
    }

    TEST_CASE("a film that goes on to more samples has the bits of one in one go") {
        const Scene scene = small_scene();
        const ScratchFolder folder;
        const StoredFilm whole = film_of(scene, {}, folder / "whole.exr", 0, 16);
        for (const int first : {1, 3, 8}) {
            film_of(scene, {}, folder / "part.exr", 0, first);
            CHECK(bitwise_equal(film_of(scene, {}, folder / "part.exr", 0, 16).film, whole.film));
            std::filesystem::remove(folder / "part.exr");
        }
    }

    TEST_CASE("the film is written while the render goes on") {
        const Scene scene = small_scene();
        const ScratchFolder folder;
        PathTracerSettings settings;
        settings.samples_per_pixel = 64;
        settings.film = folder / "film.exr";
        settings.film_interval = 0;
        std::uint32_t seen = 0;
        const Control watching{nullptr, [&](double) {
                                   if (!std::filesystem::exists(settings.film)) return;
                                   const Film film = read_film(settings.film).film; // the file is complete at any time
                                   std::uint32_t most = 0;
                                   for (int y = 0; y < kHeight; ++y)
                                       for (int x = 0; x < kWidth; ++x) most = std::max(most, film.samples_taken(x, y));
                                   CHECK(most >= seen);
                                   seen = most;
                               }};
        rendered(scene, settings, watching);
        CHECK(seen > 0);
        CHECK(read_film(settings.film).film.min_samples_taken() == 64);
    }

    TEST_CASE("threads that never rest together do not keep the film from being written") {
        const ScratchFolder folder;
        const Scene scene = small_scene();
        PathTracerSettings settings;
        settings.film = folder / "film.exr";
        FilmCheckpoint checkpoint(scene, {scene.camera, kWidth, kHeight}, settings);
        std::atomic<bool> saved = false;
        std::atomic<int> ended = 0; // threads that gave up before the film was saved
        std::vector<std::thread> threads;
        for (int i = 0; i < 3; ++i)
            threads.emplace_back([&] {
                for (int k = 0; k < 3000; ++k) {
                    if (saved) return;
                    checkpoint.run([] { std::this_thread::sleep_for(std::chrono::milliseconds(3)); });
                }
                ++ended;
            });
        std::this_thread::sleep_for(std::chrono::milliseconds(20)); // the threads overlap
        checkpoint.save();
        saved = true;
        for (std::thread& thread : threads) thread.join();
        CHECK(ended == 0);
    }

    TEST_CASE("a shard's hits are those of its own first sample") {
        const Scene scene = small_scene();
        PathTracerSettings settings;
        settings.aovs.hit = true;
        settings.first_sample = 8, settings.samples_per_pixel = 8;
        const Rendering shard = rendered(scene, settings);
        settings.samples_per_pixel = 1;
        const Rendering first = rendered(scene, settings);
        int hits = 0;
        for (std::size_t i = 0; i < shard.hit.size(); ++i) {
            CHECK(shard.hit[i].object == first.hit[i].object);
            CHECK(shard.hit[i].t == first.hit[i].t);
            hits += shard.hit[i].valid();
        }
        CHECK(hits > kWidth * kHeight / 4);
    }

    TEST_CASE("shards join to the sums of one run, to 1e-12; films that do not fit are refused") {
        const Scene scene = small_scene();
        const ScratchFolder folder;
        PathTracerSettings settings;
        const auto shard = [&](const char* name, int first, int last) {
            std::filesystem::remove(folder / name);
            return film_of(scene, settings, folder / name, first, last);
        };
        for (const bool replicates : {true, false}) {
            settings.aovs.variance = replicates;
            const StoredFilm one = shard("one.exr", 0, 30);
            const StoredFilm joined =
                merge_films({{"c", shard("c.exr", 16, 30)}, {"a", shard("a.exr", 0, 7)}, {"b", shard("b.exr", 7, 16)}});
            CHECK(joined.first_sample == 0);
            CHECK((joined.film.estimated_relmse() >= 0) == replicates);
            double worst = 0;
            for (std::size_t i = 0; i < one.film.pixels().size(); ++i) {
                const Film::Pixel &x = one.film.pixels()[i], &y = joined.film.pixels()[i];
                CHECK(x.count == y.count);
                for (std::size_t r = 0; r < Film::kReplicates; ++r)
                    for (std::size_t color = 0; color < 3; ++color)
                        worst = std::max(worst, std::abs(x.sum[r][color] - y.sum[r][color]) /
                                                    std::max(x.sum[r][color], 1e-30));
            }
            CHECK(worst <= 1e-12);
        }

        const StoredFilm a = shard("a.exr", 0, 7);
        CHECK(error_of([&] { merge_films({}); }) == Containing("no film"));
        CHECK(error_of([&] {
                  merge_films({{"a", a}, {"again", a}});
              }) == Containing("again: has samples from 0 on, but a has"));
        settings.seed = 1;
        const StoredFilm other = film_of(scene, settings, folder / "other.exr", 40, 50);
        const std::string error = error_of([&] { merge_films({{"a", a}, {"other", other}}); });
        CHECK(error == Containing("other: a film of another image: seed: found 1, expected 0"));
    }

    TEST_CASE("a film of another image, or none at all, is not continued") {
        const Scene scene = small_scene();
        const ScratchFolder folder;
        PathTracerSettings settings;
        settings.samples_per_pixel = 2;
        settings.film = folder / "film.exr";
        rendered(scene, settings);
        const auto error_with = [&](auto change) {
            PathTracerSettings changed = settings;
            change(changed);
            return error_of([&] { rendered(scene, changed); });
        };
        CHECK(error_with([](PathTracerSettings& s) { s.seed = 5; }) == Containing("seed: found 0, expected 5"));
        CHECK(error_with([](PathTracerSettings& s) { s.max_depth = 3; }) == Containing("depth: found 64, expected 3"));
        CHECK(error_with([](PathTracerSettings& s) { s.integrator = Integrator::kNaive; }) ==
              Containing("integrator: found path, expected naive"));
        CHECK(error_with([](PathTracerSettings& s) { s.sampler = SamplerKind::kIndependent; }) ==
              Containing("sampler"));
        CHECK(error_with([](PathTracerSettings& s) { s.first_sample = 2; }) ==
              Containing("samples from 0 on, expected from 2 on"));
        CHECK(error_with([](PathTracerSettings& s) { s.aovs.depth = true; }) == Containing("keeps no depth"));
        Scene moved = scene;
        moved.camera.eye.x += 1;
        CHECK(error_of([&] { rendered(moved, settings); }) == Containing("camera"));

        write_exr(settings.film, kWidth, kHeight, rgb_channels("", ImageRgb(kWidth, kHeight)));
        CHECK(error_with([](PathTracerSettings&) {}) == Containing("no film: found no channel"));
        write_file(settings.film, "not an EXR");
        CHECK(error_with([](PathTracerSettings&) {}) == Containing("film.exr"));
        const View large{scene.camera, kMaxRenderSide, kMaxRenderSide};
        Control control;
        CHECK(error_of([&] { render(prepare(scene, settings), large, settings, control); }) ==
              Containing("film.exr: an image of 16384 x 16384 pixels"));
    }
}
