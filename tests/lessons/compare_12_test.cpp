// Lesson compare-12: its two ways see the same triangles, its measures and its camera are the library's, and its page
// has the lines of code that there are.
#include "common/camera/camera.h"
#include "compare/lessons/12-both-ways/both.h"
#include "compare/metrics/error_metrics.h"

#include <doctest/doctest.h>

#include <random>
#include <set>

using namespace duet;

namespace {

class Numbers {
    std::mt19937 random_{12};

public:
    float operator()(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
};

/// A view of the amphora from a random place.
lesson::View random_view(Numbers& random) {
    const float angle = random(0, 2 * kPi), distance = random(1.4f, 4);
    return {.eye = {distance * std::sin(angle), random(0.05f, 1.6f), distance * std::cos(angle)},
            .look_at = {random(-0.1f, 0.1f), random(0.3f, 0.6f), random(-0.1f, 0.1f)},
            .up = {random(-0.3f, 0.3f), 1, random(-0.3f, 0.3f)},
            .fov_degrees = random(20, 45)};
}

/// The lines of all headers of a room's lessons that both.h includes, without blank lines and comments.
int count_lines(const std::string& file, const std::string& room, std::set<std::string>& counted) {
    std::ifstream in(DUET_SOURCE_DIR "/" + file);
    REQUIRE(in.good());
    int lines = 0;
    for (std::string line; std::getline(in, line);) {
        const std::size_t text = line.find_first_not_of(" \t");
        lines += text != std::string::npos && line.compare(text, 2, "//") != 0;
        const std::string include = "#include \"" + room + "/";
        if (!line.starts_with(include)) continue;
        const std::string name = line.substr(10, line.find('"', 10) - 10);
        if (counted.insert(name).second) lines += count_lines(name, room, counted);
    }
    return lines;
}
int count_included(const std::string& room) {
    std::set<std::string> all, none;
    const std::string file = "compare/lessons/12-both-ways/both.h";
    return count_lines(file, room, all) - count_lines(file, "nothing", none);
}

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("compare-12: a pixel where the two ways see different triangles has its center at an edge") {
        constexpr int kWidth = 80, kHeight = 60;
        Numbers random;
        const lesson::Mesh world = lesson::read_obj(DUET_SOURCE_DIR "/models/meshes/amphora.obj");
        std::vector<lesson::Object> objects;
        for (std::size_t i = 0; i < world.size(); i += 3)
            objects.push_back(lesson::triangle_object(world[i].p, world[i + 1].p, world[i + 2].p, i / 3));
        const lesson::Bvh tree = lesson::build(objects);
        const auto index = [](const lesson::Hit& at) { return Rgb(static_cast<float>(at.index + 1)); };
        int covered = 0, different = 0;
        for (int i = 0; i < 12; ++i) {
            const lesson::View view = random_view(random);
            const lesson::Camera camera(view, kWidth, kHeight);
            const ImageRgb drawn = lesson::rasterize(world, view, kWidth, kHeight, index);
            const ImageRgb traced = lesson::trace(tree, view, kWidth, kHeight, index);
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x) {
                    covered += traced(x, y).r > 0;
                    if (drawn(x, y) == traced(x, y)) continue;
                    ++different;
                    // Corners move by up to 1/512 pixel, so some ray within 1/128 sees what was drawn.
                    bool explained = false;
                    for (const float dy : {-1.0f, 0.0f, 1.0f})
                        for (const float dx : {-1.0f, 0.0f, 1.0f}) {
                            const Vec2 p{static_cast<float>(x) + 0.5f + dx / 128,
                                         static_cast<float>(y) + 0.5f + dy / 128};
                            const auto hit = lesson::closest_hit(tree, camera.ray(p.x, p.y, Vec2(0, 0)));
                            explained = explained || (hit ? index(*hit) : Rgb(0)) == drawn(x, y);
                        }
                    CAPTURE(i);
                    CAPTURE(x);
                    CAPTURE(y);
                    CHECK(explained);
                }
        }
        CHECK(covered > 5000);            // the amphora is in the image
        CHECK(100 * different < covered); // fewer than one pixel in a hundred
    }

    TEST_CASE("compare-12: the library projects the lesson's rays to the centers of their pixels") {
        Numbers random;
        for (int i = 0; i < 300; ++i) {
            const int width = static_cast<int>(random(8, 300)), height = static_cast<int>(random(8, 300));
            const lesson::View view = random_view(random);
            duet::Camera camera;
            camera.eye = Vec3d(view.eye), camera.look_at = Vec3d(view.look_at), camera.up = Vec3d(view.up);
            camera.fov_degrees = view.fov_degrees;
            const Pinhole library = CameraModel({camera, width, height}).pinhole();
            const float x = random(0, static_cast<float>(width)), y = random(0, static_cast<float>(height));
            const Ray ray = lesson::Camera(view, width, height).ray(x, y, Vec2(0, 0));
            const Vec3d place = library.project(Vec3d(ray.at(random(0.5f, 5))));
            CHECK(std::abs(place.x - static_cast<double>(x)) < 2e-3);
            CHECK(std::abs(place.y - static_cast<double>(y)) < 2e-3);
            CHECK(length(library.ray({static_cast<double>(x), static_cast<double>(y)}).direction -
                         Vec3d(ray.direction)) < 1e-5);
        }
    }

    TEST_CASE("compare-12: the library's errors are the lesson's") {
        Numbers random;
        for (int i = 0; i < 20; ++i) {
            ImageRgb a(17, 9), b(17, 9);
            for (ImageRgb* image : {&a, &b})
                for (Rgb& pixel : image->pixels()) pixel = {random(0, 2), random(0, 1), random(0, 0.1f)};
            const Vec3d lesson = lesson::errors(a, b);
            const compare::ErrorMetrics library = compare::error_metrics(a, b);
            CHECK(lesson.x == doctest::Approx(average(library.mean_signed_error)).epsilon(1e-9));
            CHECK(lesson.y == doctest::Approx(library.mse).epsilon(1e-9));
            CHECK(lesson.z == doctest::Approx(library.relmse).epsilon(1e-9));
        }
    }

    TEST_CASE("compare-12: a difference is orange where the image is brighter, and blue where it is darker") {
        const ImageRgb gray(1, 1, Rgb(0.5f));
        const auto color = [&](float value) {
            return lesson::signed_difference(ImageRgb(1, 1, Rgb(value)), gray, 0.25f)[0];
        };
        CHECK(color(0.5f).r == color(0.5f).b);
        CHECK(color(0.75f).r > color(0.75f).b);
        CHECK(color(0.25f).r < color(0.25f).b);
        CHECK(color(0.75f) == color(1)); // full color from the range on
        CHECK(color(0.7f) != color(0.75f));
    }

    TEST_CASE("compare-12: the page has the lines of code that there are") {
        std::ifstream page(DUET_SOURCE_DIR "/compare/lessons/12-both-ways/README.md");
        std::stringstream text;
        text << page.rdbuf();
        const std::string raster = std::to_string(count_included("raster")),
                          rays = std::to_string(count_included("raytrace"));
        CAPTURE(raster);
        CAPTURE(rays);
        CHECK(text.str().find("have " + raster + " lines") != std::string::npos);
        CHECK(text.str().find("have " + rays + " lines") != std::string::npos);
    }
}
