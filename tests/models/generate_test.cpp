// These tests check that the generator writes the files in the repository, and that its components work.
#include "models/generate.h"

#include "common/image/image_file.h"
#include "common/image/srgb.h"
#include "common/system/file.h"
#include "models/format_number.h"
#include "models/image.h"
#include "models/implicit.h"
#include "models/random.h"

#include <doctest/doctest.h>

#include <set>

using namespace duet;
using namespace duet::models;

namespace {

/// Returns a folder for the files that the tests write.
std::filesystem::path scratch() {
    const std::filesystem::path folder = std::filesystem::path(DUET_BINARY_DIR) / "tests/scratch/models";
    std::filesystem::create_directories(folder);
    return folder;
}

/// Returns vertices − edges + triangles of a closed mesh: 2 for each sphere, 0 for a torus.
std::ptrdiff_t euler_characteristic(const MeshBuilder& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(t[k].position, t[(k + 1) % 3].position));
    return std::ssize(mesh.positions) - std::ssize(edges) + std::ssize(mesh.triangles);
}

double volume(const MeshBuilder& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles)
        sum +=
            dot(mesh.positions[t[0].position], cross(mesh.positions[t[1].position], mesh.positions[t[2].position])) / 6;
    return sum;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("the committed models are what the generator writes, byte for byte") {
        for (const Model& model : all_models()) {
            if (model.kind != Model::Kind::kCommitted) continue;
            generate_model(model, scratch());
            for (const std::string& file : model.files) {
                CAPTURE(file);
                const std::string committed = read_file(std::filesystem::path(DUET_SOURCE_DIR) / "models" / file);
                const bool equal = read_file(scratch() / file) == committed;
                CHECK_MESSAGE(equal, "models/" << file << " is stale: run `generate models " << model.name << "`");
                CHECK(committed.size() < 1'000'000);
            }
        }
    }

    TEST_CASE("numbers are written in plain decimals") {
        CHECK(format_number(0.25, 5) == "0.25");
        CHECK(format_number(-3, 5) == "-3");
        CHECK(format_number(-0.0000001, 5) == "0");
        CHECK(format_number(100, 0) == "100");
        CHECK(format_number(1.0 / 3.0, 4) == "0.3333");
        CHECK(format_number(12345678.5, 3) == "12345678.5");
    }

    TEST_CASE("a polygonized ball is a ball") {
        constexpr double kRadius = 0.7, kCell = 0.1;
        const Implicit ball{[](Vec3d p) { return length(p) - kRadius; }, {-1, -1, -1}, {1, 1, 1}};
        const MeshBuilder mesh = polygonize(ball, kCell);
        CHECK(euler_characteristic(mesh) == 2);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            REQUIRE(length(mesh.positions[i]) == doctest::Approx(kRadius).epsilon(1e-3));
            REQUIRE(dot(mesh.normals[i], normalize(mesh.positions[i])) > 0.9999);
        }
        // The grid cells are a seventh of the radius, so the polyhedron has less than 1 % less volume than the
        // sphere.
        const double exact = 4.0 / 3.0 * kPiDouble * std::pow(kRadius, 3);
        CHECK(volume(mesh) < exact);
        CHECK(volume(mesh) > 0.99 * exact);
    }

    TEST_CASE("a polygonized torus keeps its hole, two balls stay two") {
        const Implicit torus{
            [](Vec3d p) { return std::hypot(std::hypot(p.x, p.z) - 0.6, p.y) - 0.25; }, {-1, -1, -1}, {1, 1, 1}};
        CHECK(euler_characteristic(polygonize(torus, 0.08)) == 0);
        const Implicit balls{
            [](Vec3d p) { return length(Vec3d(std::abs(p.x) - 0.5, p.y, p.z)) - 0.45; }, {-1, -1, -1}, {1, 1, 1}};
        CHECK(euler_characteristic(polygonize(balls, 0.04)) == 4);
    }

    TEST_CASE("PNG images read back as written: noise, repeats, and runs of every length") {
        Random random(7);
        for (const int width : {1, 7, 300, 1000}) {
            Image<Rgb8> image(width, 97);
            for (int y = 0; y < image.height(); ++y) {
                for (int x = 0; x < width; ++x) {
                    const auto noise = [&] { return static_cast<std::uint8_t>(random.uniform(0, 256)); };
                    if (y < 30)
                        image(x, y) = {noise(), noise(), noise()};
                    else if (y < 60)
                        image(x, y) = image((x + y) % width, y - 30); // repeats at some distance
                    else if (y < 80)
                        image(x, y) = x < 13 * (y - 60) ? Rgb8{9, 9, 9} : Rgb8{200, 0, 1};
                }
            }
            write_png(scratch() / "test.png", image);
            const StoredImage file = read_stored_image(scratch() / "test.png");
            REQUIRE(file.width == width);
            REQUIRE(file.height == 97);
            REQUIRE(file.channels == 3);
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < image.size(); ++i) {
                const Rgb8 c = image[i];
                const std::uint8_t bytes[3] = {c.r, c.g, c.b};
                for (std::size_t k = 0; k < 3; ++k) wrong += std::lround(file.values[3 * i + k] * 255) != bytes[k];
            }
            CHECK(wrong == 0);
        }
    }

    TEST_CASE("Radiance images read back to the format's precision") {
        Random random(8);
        ImageRgb image(300, 5);
        for (Rgb& pixel : image.pixels()) {
            const float size = static_cast<float>(std::exp2(random.uniform(-20, 20)));
            const auto part = [&] { return size * static_cast<float>(random.uniform()); };
            pixel = Rgb(part(), part(), part());
        }
        image(0, 0) = Rgb();
        write_hdr(scratch() / "test.hdr", image);
        const ImageRgb read = read_image(scratch() / "test.hdr");
        REQUIRE(read.width() == 300);
        REQUIRE(read.height() == 5);
        for (std::size_t i = 0; i < image.size(); ++i) {
            // RGBE truncates to eight bits of mantissa, so the error is within 1/128 of the largest channel.
            for (std::size_t k = 0; k < 3; ++k)
                REQUIRE(std::abs(read[i][k] - image[i][k]) <= max_component(image[i]) / 128);
        }
    }
}
