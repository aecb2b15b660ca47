#include "compare/bench/reference.h"

#include "common/image/image_file.h"
#include "common/scene/scene_hash.h"
#include "common/system/file.h"
#include "compare/bench/bias_check.h"
#include "compare/bench/render_reference.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

using namespace duet;
using namespace duet::compare;
using duet::test::ScratchFolder;

namespace {

namespace fs = std::filesystem;

/// Writes a scene that uses every kind of file: a mesh, an MTL with its image, a texture, an environment.
fs::path write_scene(const fs::path& folder) {
    fs::create_directories(folder);
    for (const char* const image : {"kd.ppm", "texture.ppm", "sky.pfm"})
        write_image(folder / image, ImageRgb(4, 2, Rgb(0.5f)));
    write_file(folder / "m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd kd.ppm\n");
    write_file(folder / "m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    write_file(folder / "scene.json", R"({"camera": {"eye": [0, 0, 3], "look_at": [0, 0, 0]},
        "textures": {"t": {"type": "image", "file": "texture.ppm"}},
        "materials": {"t": {"type": "diffuse", "albedo": {"texture": "t"}}},
        "objects": [{"type": "mesh", "file": "m.obj"},
                    {"type": "sphere", "center": [0, 0, 0], "radius": 0.5, "material": "t"}],
        "environment": {"type": "image", "file": "sky.pfm"}})");
    return folder / "scene.json";
}

/// Returns independent normal noise of known variance around a mean. The variance is estimated with one degree of
/// freedom, as Film does.
Reference noisy(int size, double mean, double deviation, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, deviation);
    Reference r{ImageRgb(size, size), ImageRgb(size, size)};
    for (std::size_t i = 0; i < r.mean.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const double a = mean + normal(random), b = mean + normal(random);
            r.mean[i][c] = static_cast<float>((a + b) / 2);
            r.variance[i][c] = static_cast<float>((a - b) * (a - b) / 4);
        }
    return r;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a scene names all its files, and its hash changes with each of them") {
        const ScratchFolder scratch;
        const fs::path path = write_scene(scratch / "a");
        const Scene scene = load_scene(path);
        std::vector<std::string> names;
        for (const fs::path& file : scene.files) names.push_back(file.filename().string());
        std::sort(names.begin(), names.end());
        CHECK(names == std::vector<std::string>{"kd.ppm", "m.mtl", "m.obj", "scene.json", "sky.pfm", "texture.ppm"});

        const std::string hash = hash_scene_files(scene);
        CHECK(hash.size() == 16);
        CHECK(hash_scene_files(load_scene(write_scene(scratch / "elsewhere"))) == hash);
        for (const fs::path& file : scene.files) {
            const std::string bytes = read_file(file);
            write_file(file, bytes + "\n");
            CHECK_MESSAGE(hash_scene_files(scene) != hash, file.string());
            write_file(file, bytes);
        }
        CHECK(hash_scene_files(scene) == hash);
    }

    TEST_CASE("a bare mesh names its files, too") {
        const ScratchFolder scratch;
        write_scene(scratch.path());
        CHECK(load_scene(scratch / "m.obj").files.size() == 3);
    }

    TEST_CASE("references are found again under their key only, and a damaged file is no reference") {
        const ScratchFolder scratch;
        const ReferenceCache cache(scratch / "deep" / "cache");
        const ReferenceKey key{"0123456789abcdef", "path", 1, 8, 8, 64, 256};
        CHECK_FALSE(cache.find("s", key));
        const Reference stored = noisy(8, 0.5, 0.1, 3);
        cache.store("s", key, stored);
        const auto found = cache.find("s", key);
        REQUIRE(found);
        CHECK(std::equal(found->mean.begin(), found->mean.end(), stored.mean.begin()));
        CHECK(std::equal(found->variance.begin(), found->variance.end(), stored.variance.begin()));

        std::vector<ReferenceKey> others(8, key);
        others[0].scene_hash[15] = '0';
        others[1].estimator = "naive";
        others[2].version = 2;
        others[3].width = 9;
        others[4].height = 9;
        others[5].depth = 63;
        others[6].spp = 255;
        others[7].program = "Blender 3.4.1";
        for (const ReferenceKey& other : others) {
            CHECK_FALSE(cache.find("s", other));
            // The cache rejects the file even if its name has the other key.
            fs::copy_file(cache.path("s", key), cache.path("s", other));
            CHECK_FALSE(cache.find("s", other));
        }
        write_file(cache.path("s", key), read_file(cache.path("s", key)).substr(0, 300));
        CHECK_FALSE(cache.find("s", key));
    }

    TEST_CASE("references lie where the system keeps caches") {
        ::setenv("XDG_CACHE_HOME", "/somewhere", 1);
        CHECK(default_reference_folder() == fs::path("/somewhere/duet/references"));
        ::unsetenv("XDG_CACHE_HOME");
        ::setenv("HOME", "/home/x", 1);
        CHECK(default_reference_folder() == fs::path("/home/x/.cache/duet/references"));
    }

    TEST_CASE("a stopped render leaves no reference behind, and the next goes on from there, to the same bits") {
        const ScratchFolder scratch;
        const Scene scene = load_scene(write_scene(scratch / "scene"));
        const View view{scene.camera, 24, 24};
        const auto files = [&](const fs::path& folder) {
            return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
        };
        std::atomic<bool> stop{false};
        Control stopped{&stop, [&](double fraction) { stop = stop || fraction > 0.4; }};
        const ReferenceSettings settings{scratch / "cache", 64, 2, 1}, other{scratch / "other", 64, 2, 1};
        const CachedReference none = reference_by("path", scene, view, settings, stopped);
        CHECK_FALSE(none);
        CHECK_FALSE(fs::exists(none.file));
        CHECK(files(scratch / "cache") == 1); // the film
        Control free;
        const CachedReference first = reference_by("path", scene, view, settings, free);
        const CachedReference second = reference_by("path", scene, view, settings, free);
        const CachedReference at_once = reference_by("path", scene, view, other, free);
        REQUIRE(first);
        CHECK(first.rendered);
        CHECK_FALSE(second.rendered);
        CHECK(files(scratch / "cache") == 1); // the reference
        CHECK(std::equal(first.reference.mean.begin(), first.reference.mean.end(), second.reference.mean.begin()));
        CHECK(std::equal(first.reference.mean.begin(), first.reference.mean.end(), at_once.reference.mean.begin()));
    }
}

TEST_SUITE("statistical") {

    // Each check gives a false alarm once in 1000 times. More than 3 alarms in 200 checks have odds of 5e-5.
    TEST_CASE("equal means are consistent") {
        int alarms = 0;
        for (unsigned seed = 0; seed < 200; ++seed)
            alarms += !check_bias(noisy(64, 0.5, 0.2, 2 * seed), noisy(64, 0.5, 0.1, 2 * seed + 1)).consistent();
        CHECK(alarms <= 3);
    }

    // The check claims to find a bias of this size with 99 % power. Fewer than 94 of 100 found have odds of 1e-4.
    TEST_CASE("a planted bias is found: of the whole, as small as promised, and of one block") {
        int found = 0;
        for (unsigned seed = 0; seed < 100; ++seed) {
            const Reference b = noisy(64, 0.5, 0.1, 2 * seed + 1);
            const double bias = check_bias(noisy(64, 0.5, 0.2, 2 * seed), b).detectable;
            found += !check_bias(noisy(64, 0.5 * (1 + bias), 0.2, 2 * seed + 1000), b).consistent();
        }
        CHECK(found >= 94);

        Reference a = noisy(64, 0.5, 0.2, 5);
        const Reference b = noisy(64, 0.5, 0.1, 6);
        for (int y = 8; y < 16; ++y)
            for (int x = 24; x < 32; ++x) a.mean(x, y).g += 0.2f;
        const BiasCheck check = check_bias(a, b);
        CHECK_FALSE(check.consistent());
        CHECK(check.block_x == 24);
        CHECK(check.block_y == 8);
        CHECK(check.block_size == 8);
        CHECK(check.channel == 1);
        CHECK(check.worst_z > 4);
    }

    TEST_CASE("a few fireflies are no evidence: their variance has few degrees of freedom") {
        Reference a = noisy(64, 0.5, 0.01, 7);
        const Reference b = noisy(64, 0.5, 0.01, 8);
        a.mean(20, 20) = Rgb(50.0f); // one replicate contains a sample of a hundred times the mean
        a.variance(20, 20) = Rgb(49.5f * 49.5f);
        CHECK(check_bias(a, b).consistent());
    }

    TEST_CASE("no noise at all: equal is consistent, different is not") {
        const Reference a{ImageRgb(16, 16, Rgb(0.5f)), ImageRgb(16, 16)};
        const Reference b{ImageRgb(16, 16, Rgb(0.51f)), ImageRgb(16, 16)};
        CHECK(check_bias(a, a).consistent());
        CHECK_FALSE(check_bias(a, b).consistent());
        CHECK_THROWS_AS(check_bias(a, {ImageRgb(16, 15), ImageRgb(16, 15)}), Error);
    }
}
