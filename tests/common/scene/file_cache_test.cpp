// These tests check the cache of meshes and images: the same scene, and no file that has changed since.
#include "common/scene/file_cache.h"

#include "common/system/error.h"
#include "common/system/file.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <thread>

using namespace duet;
using duet::test::ScratchFolder;

namespace {

std::string triangle(double height) { return message("v 0 0 0\nv 1 0 0\nv 0 ", height, " 0\nf 1 2 3\n"); }

float height_of(const Scene& scene) { return scene.bounds.high.y; }

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a scene has the same content with and without a cache, also the second time") {
        const std::filesystem::path path = std::filesystem::path(DUET_SOURCE_DIR) / "models" / "amphora.json";
        const std::string text = read_file(path);
        FileCache cache;
        const Scene expected = load_scene(path);
        REQUIRE_FALSE(expected.textures.images.empty());
        for (int time = 0; time < 2; ++time) {
            const Scene scene = parse_scene(path, text, cache);
            CHECK(scene.files == expected.files);
            CHECK(scene.material_names == expected.material_names);
            CHECK((scene.bounds.low == expected.bounds.low && scene.bounds.high == expected.bounds.high));
            REQUIRE(scene.textures.images.size() == expected.textures.images.size());
            CHECK(scene.textures.images.front().pixels() == expected.textures.images.front().pixels());
        }
    }

    TEST_CASE("scenes that keep all transforms share their meshes, and a bake changes none of them") {
        const ScratchFolder folder;
        const std::filesystem::path path = folder.path() / "scene.json";
        write_file(folder.path() / "mesh.obj", triangle(2));
        const auto text = [](double x) {
            return message(R"({"camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0]},
        "materials": {"white": {"type": "diffuse", "albedo": 0.7}}, "objects": [{"type": "mesh", "file": "mesh.obj",
        "material": "white", "transform": [{"translate": [)", x, ", 0, 0]}]}]}");
        };
        std::filesystem::last_write_time(folder.path() / "mesh.obj",
                                         std::filesystem::file_time_type::clock::now() - std::chrono::seconds(2));
        FileCache cache;
        const Scene one = parse_scene(path, text(1), cache, Transforms::kKept);
        const Scene baked = parse_scene(path, text(2), cache);
        const Scene three = parse_scene(path, text(3), cache, Transforms::kKept);
        CHECK(&one.shapes[0] == &three.shapes[0]);
        CHECK(&one.shapes[0] != &baked.shapes[0]);
        CHECK_FALSE(std::get<Mesh>(one.shapes[0]).closed.value());
        CHECK(std::get<Mesh>(one.shapes[0]).positions.front() == Vec3{0, 0, 0});
        CHECK(std::get<Mesh>(baked.shapes[0]).positions.front() == Vec3{2, 0, 0});
        CHECK(baked.objects[0].identity);
        CHECK_FALSE(three.objects[0].identity);
        CHECK(three.bounds.low.x == doctest::Approx(3));
    }

    TEST_CASE("a mesh that has changed, or is gone, is read anew") {
        const ScratchFolder folder;
        const std::filesystem::path path = folder.path() / "scene.json", mesh = folder.path() / "mesh.obj";
        const std::string text = R"({"camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0]},
        "materials": {"white": {"type": "diffuse", "albedo": 0.7}},
        "objects": [{"type": "mesh", "file": "mesh.obj", "material": "white"}]})";
        FileCache cache;
        CHECK_THROWS_AS(parse_scene(path, text, cache), Error);
        write_file(mesh, triangle(2));
        CHECK(height_of(parse_scene(path, text, cache)) == doctest::Approx(2));
        write_file(mesh, triangle(3));
        std::filesystem::last_write_time(mesh, std::filesystem::last_write_time(mesh) + std::chrono::seconds(2));
        CHECK(height_of(parse_scene(path, text, cache)) == doctest::Approx(3));
        std::filesystem::remove(mesh);
        CHECK_THROWS_AS(parse_scene(path, text, cache), Error);
    }

    TEST_CASE("a cloud is the same while a scene uses it, and is not kept afterwards") {
        const auto text = [](int resolution) {
            return message(R"({"camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}, "objects": [], "media": [)",
                           R"({"type": "cloud", "low": [0, 0, 0], "high": [1, 1, 1], "scattering": 1, "resolution": )",
                           resolution, "}]}");
        };
        FileCache cache;
        const Scene first = parse_scene("scene.json", text(8), cache),
                    second = parse_scene("scene.json", text(8), cache);
        CHECK(second.media[0].density == first.media[0].density);
        const Scene other = parse_scene("scene.json", text(9), cache);
        CHECK(other.media[0].density != first.media[0].density);
        std::weak_ptr<const DensityGrid> gone = other.media[0].density;
        CHECK(gone.use_count() == 1);
    }

    TEST_CASE("what has not changed is not read again, and what was written meanwhile is") {
        const ScratchFolder folder;
        const std::filesystem::path file = folder.path() / "file";
        int reads = 0;
        const auto read = [&] {
            ++reads;
            return FileCache::Read<int>{reads, {file}};
        };
        const auto write = [&] {
            write_file(file, "x");
            ++reads;
            return FileCache::Read<int>{reads, {file}};
        };
        write_file(file, "x");
        std::this_thread::sleep_for(std::chrono::milliseconds(50)); // files just written are not kept
        FileCache cache;
        CHECK(*cache.get<int>("a", read) == 1);
        CHECK(*cache.get<int>("a", read) == 1);
        CHECK(*cache.get<int>("b", read) == 2);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        CHECK(*cache.get<int>("c", write) == 3);
        CHECK(*cache.get<int>("c", read) == 4);
        CHECK(*cache.get<int>("a", read) == 5); // its file was written
    }
}
