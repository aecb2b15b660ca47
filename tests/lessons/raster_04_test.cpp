// The library's camera and the reader of meshes agree with lesson raster-04.
#include "common/camera/camera.h"
#include "common/scene/obj/load_obj.h"
#include "raster/lessons/04-camera/mesh.h"
#include "raster/lessons/04-camera/transform.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;

TEST_SUITE("lesson") {

    TEST_CASE(
        "raster-04: the lesson's matrices and the library's camera send a point to the same place, and rays back") {
        std::mt19937 random(4);
        const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
        const auto point = [&](double reach) {
            const double x = uniform(-reach, reach), y = uniform(-reach, reach);
            return Vec3d(x, y, uniform(-reach, reach));
        };
        int seen = 0;
        for (int i = 0; i < 2000; ++i) {
            Camera camera;
            camera.eye = Vec3d(Vec3(point(5))); // floats, so that the lesson has the very same eye
            camera.look_at = Vec3d(Vec3(point(5)));
            camera.up = Vec3d(Vec3(point(1)));
            const Vec3d way = normalize(camera.look_at - camera.eye);
            if (length(cross(camera.up, way)) < 0.1) continue; // badly conditioned in float
            camera.fov_degrees = uniform(10, 120);
            const int width = 100 + i % 300, height = 100 + i % 170;
            const Pinhole pinhole = CameraModel(View{camera, width, height}).pinhole();

            // The ray of a pixel and its points: the library's two directions are inverses of each other.
            const Vec2d pixel(uniform(0, width), uniform(0, height));
            const double w = uniform(0.5, 20);
            const Rayd ray = pinhole.ray(pixel);
            const Vec3d p = ray.at(w / dot(ray.direction, pinhole.forward));
            const Vec3d back = pinhole.project(p);
            REQUIRE(std::abs(back.x - pixel.x) < 1e-8);
            REQUIRE(std::abs(back.y - pixel.y) < 1e-8);
            REQUIRE(std::abs(back.z - w) < 1e-10);

            // The lesson, in float. Coordinates of up to 40 are off by 2^-24 of that for each of some ten roundings; at
            // the distance 0.5 that is at most 1e-4 of the image's height, times f (up to 11.4).
            const auto fov = static_cast<float>(radians(camera.fov_degrees));
            const Mat4 clip_from_world =
                lesson::perspective(fov, static_cast<float>(width) / static_cast<float>(height), 0.1f, 40) *
                lesson::look_at(Vec3(camera.eye), Vec3(camera.look_at), Vec3(camera.up));
            const Vec4 found = lesson::to_image(clip_from_world * Vec4(Vec3(p), 1), width, height);
            const double bound = 1e-4 * height / std::tan(radians(camera.fov_degrees) / 2);
            CAPTURE(i);
            REQUIRE(std::abs(static_cast<double>(found.x) - pixel.x) < bound);
            REQUIRE(std::abs(static_cast<double>(found.y) - pixel.y) < bound);
            REQUIRE(std::abs(static_cast<double>(found.w) - w) < 1e-4);
            ++seen;
        }
        CHECK(seen > 1500);
    }

    TEST_CASE("raster-04: the values that the page computes by hand") {
        const Mat4 lens = lesson::perspective(kPi / 2, 1.5f, 1, 5);
        const Vec4 clip = lens * Vec4(1, 2, -4, 1), found = lesson::to_image(clip, 300, 200);
        CHECK(clip.x == doctest::Approx(2 / 3.0));
        CHECK(clip.y == doctest::Approx(2));
        CHECK(clip.z == doctest::Approx(3.75));
        CHECK(clip.w == 4);
        CHECK(found.x == doctest::Approx(175));
        CHECK(found.y == doctest::Approx(50));
        CHECK(found.z == doctest::Approx(0.9375));
        // The table of depths, and what is told of the far plane.
        const Mat4 far = lesson::perspective(0.6f, 1.5f, 0.1f, 40);
        for (const auto& [distance, depth] :
             {std::pair{0.1f, 0.0}, {0.2f, 0.501}, {1.0f, 0.902}, {10.0f, 0.992}, {40.0f, 1.0}})
            CHECK(std::abs(static_cast<double>(lesson::to_image(far * Vec4(0, 0, -distance, 1), 1, 1).z) - depth) <
                  6e-4);
    }

    TEST_CASE("raster-04: the lesson reads the triangles of an OBJ file that the library reads") {
        const std::string path = DUET_SOURCE_DIR "/models/meshes/amphora.obj";
        const lesson::Mesh found = lesson::read_obj(path);
        const Mesh mesh = load_obj(path).mesh;
        REQUIRE(found.size() == 3 * mesh.triangles.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            const std::size_t v = mesh.triangles[i / 3][i % 3];
            REQUIRE(found[i].p == mesh.positions[v]);
            REQUIRE(length(found[i].n - mesh.normals[v]) < 1e-6f);
            REQUIRE(found[i].uv == mesh.uvs[v]);
        }
        CHECK_THROWS_AS(lesson::read_obj(path + ".missing"), std::exception);
    }
}
