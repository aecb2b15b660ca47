#include "compare/peers/export_scene.h"

#include "common/geometry/sphere.h"
#include "common/image/image_file.h"
#include "common/medium/density_grid.h"
#include "common/system/file.h"
#include "compare/peers/export_geometry.h"
#include "compare/peers/subprocess.h"
#include "tests/raytrace/scene_builder.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cstring>

using namespace duet;
using namespace duet::compare;
using duet::raytrace::SceneBuilder;
using duet::test::ScratchFolder;
using nlohmann::json;

namespace {

namespace fs = std::filesystem;

json exported(const ScratchFolder& scratch, const Scene& scene, ExportNotes* notes = nullptr) {
    const ExportNotes list = export_scene(scratch.path(), scene, {scene.camera, 40, 30}, {8, 2});
    if (notes != nullptr) *notes = list;
    return json::parse(read_file(scratch / "scene.json"));
}

template <typename T> std::vector<T> numbers(const ScratchFolder& scratch, const json& part) {
    const std::string bytes = read_file(scratch / "geometry.bin");
    std::vector<T> values(part[1].get<std::size_t>());
    const auto offset = part[0].get<std::size_t>();
    REQUIRE(offset + 4 * values.size() <= bytes.size());
    std::memcpy(values.data(), bytes.data() + offset, 4 * values.size());
    return values;
}

/// Returns whether each triangle's geometric normal agrees with its vertex normals.
bool faces_outwards(const TriangleSoup& soup) {
    for (std::size_t t = 0; t < soup.slots.size(); ++t) {
        const auto p = [&](std::size_t k) {
            return soup.positions[static_cast<std::size_t>(soup.triangles[3 * t + k])];
        };
        const Vec3 n = cross(p(1) - p(0), p(2) - p(0));
        for (std::size_t k = 0; k < 3; ++k)
            if (!(dot(n, soup.normals[3 * t + k]) > 0)) return false;
    }
    return true;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("triangles face the same way after any transform, mirroring or not") {
        const Mesh sphere = raytrace::icosphere(1, 1, {}, true);
        const Mat4 turned(translation(Vec3d(1, 2, 3)) * rotation(normalize(Vec3d(1, 2, 3)), 1.0));
        const Mat4 mirrored(Mat4d(turned) * scaling(Vec3d(-1, 2, 0.5)));
        for (const Mat4& m : {Mat4(), turned, mirrored}) {
            const TriangleSoup soup = world_triangles(sphere, m);
            CHECK(soup.slots.size() == sphere.triangles.size());
            CHECK(faces_outwards(soup));
            for (const Vec3 n : soup.normals) CHECK(length(n) == doctest::Approx(1));
        }
    }

    TEST_CASE("a quad is two triangles with its corners' coordinates") {
        const TriangleSoup soup = world_triangles(raytrace::quad({0, 0, 0}, {2, 0, 0}, {0, 3, 0}), Mat4());
        REQUIRE(soup.slots.size() == 2);
        CHECK(soup.normals.empty());
        CHECK(soup.uvs[4] == Vec2(1, 1));
        CHECK(soup.object_positions[4] == Vec3(2, 3, 0));
        CHECK(soup.positions[static_cast<std::size_t>(soup.triangles[5])] == Vec3(0, 3, 0));
    }

    TEST_CASE("the sphere's mesh: closed, outwards, on the sphere, its texture coordinates sphere_uv's") {
        const TriangleSoup soup = sphere_triangles(16);
        CHECK(soup.slots.size() == sphere_triangle_count(16));
        CHECK(area(soup) == doctest::Approx(4 * kPiDouble).epsilon(0.02));
        CHECK(faces_outwards(soup));
        double volume = 0;
        for (std::size_t t = 0; t < soup.slots.size(); ++t) {
            const auto p = [&](std::size_t k) {
                return Vec3d(soup.positions[static_cast<std::size_t>(soup.triangles[3 * t + k])]);
            };
            volume += dot(p(0), cross(p(1), p(2))) / 6;
        }
        CHECK(volume == doctest::Approx(4 * kPiDouble / 3).epsilon(0.02));
        for (std::size_t i = 0; i < soup.uvs.size(); ++i) {
            const Vec3 p = soup.positions[static_cast<std::size_t>(soup.triangles[i])];
            CHECK(length(p) == doctest::Approx(1));
            if (std::abs(p.y) < 0.999f && soup.uvs[i].x > 0 && soup.uvs[i].x < 1) {
                CHECK(sphere_uv(p).x == doctest::Approx(soup.uvs[i].x).epsilon(1e-4));
                CHECK(sphere_uv(p).y == doctest::Approx(soup.uvs[i].y).epsilon(1e-4));
            }
        }
    }

    TEST_CASE("the mesh of a large sphere: closed, outwards, near the viewer within 2e-4 of the distance") {
        for (const double height : {0.0, 1e-4, 2e-3, 0.5}) {
            const Vec3d pole = normalize(Vec3d(1, 2, -2)), eye = pole * (1 + height);
            const TriangleSoup soup = sphere_triangles_near(pole, height);
            CHECK(faces_outwards(soup));
            CHECK(area(soup) == doctest::Approx(4 * kPiDouble).epsilon(2e-3));
            for (std::size_t t = 0; t < soup.triangles.size(); t += 3) {
                const auto p = [&](std::size_t k) {
                    return Vec3d(soup.positions[static_cast<std::size_t>(soup.triangles[t + k])]);
                };
                const Vec3d middle = (p(0) + p(1) + p(2)) * (1.0 / 3);
                CHECK(1 - length(middle) < 2e-4 * length(middle - eye) + 1e-7);
            }
        }
    }

    TEST_CASE("a ground that is a huge sphere has a mesh of its own, of the sphere's radius") {
        const ScratchFolder scratch;
        SceneBuilder builder;
        const std::uint32_t grey = builder.material(Diffuse{});
        builder.add(Sphere{{0, -1000, 0}, 1000}, grey);
        builder.add(Sphere{{0, 0.5f, 0}, 0.5f}, grey);
        Scene scene = builder.finish();
        scene.camera.eye = {0, 2, 10};
        const json file = exported(scratch, scene);
        CHECK(file["meshes"].size() == 2);
        CHECK(file["objects"][0]["matrix"][0][0] == 1000.0);
        CHECK(file["objects"][1]["matrix"][0][0].get<double>() > 0.5);
    }

    TEST_CASE("cornell.json: objects, materials, camera and settings as the path tracer has them") {
        const ScratchFolder scratch;
        ExportNotes notes;
        const Scene scene = load_scene(fs::path(DUET_SOURCE_DIR) / "models" / "cornell.json");
        const json file = exported(scratch, scene, &notes);
        CHECK(notes.empty());
        CHECK(file["objects"].size() == 8);
        CHECK(file["environment"] == json{{"type", "constant"}, {"radiance", {0.0, 0.0, 0.0}}});
        CHECK(file["render"] == json{{"width", 40}, {"height", 30}, {"depth", 8}, {"threads", 2}});
        CHECK(file["camera"]["matrix"][0] == json{1.0, 0.0, 0.0, 0.0});
        CHECK(file["camera"]["matrix"][2][3].get<double>() == doctest::Approx(6.8));
        const json& area_light = file["objects"][7];
        CHECK(area_light["name"] == "lamp");
        const json& material = file["materials"][area_light["materials"][0].get<std::size_t>()];
        CHECK(material["type"] == "emissive");
        CHECK(material["two_sided"] == false);
        CHECK(material["radiance"] == json{17.0, 12.0, 4.0});
        const json& mesh = file["meshes"][area_light["mesh"].get<std::size_t>()];
        const auto positions = numbers<float>(scratch, mesh["positions"]);
        REQUIRE(positions.size() == 12);
        CHECK(positions[0] == -0.24f);
        CHECK(positions[1] == 1.98f);
        CHECK(numbers<std::int32_t>(scratch, mesh["triangles"]) == std::vector<std::int32_t>{0, 1, 2, 0, 2, 3});
    }

    TEST_CASE("all spheres share one mesh; an environment's image is turned as Cycles sees it") {
        const ScratchFolder scratch;
        SceneBuilder builder;
        const std::uint32_t grey = builder.material(Diffuse{});
        builder.add(Sphere{{1, 2, 3}, 0.5f}, grey);
        builder.add(Sphere{{0, 0, 0}, 2}, grey);
        builder.scene.environment =
            make_image_environment(ImageRgb(4, 2, Rgb(1.0f)), 2, static_cast<float>(radians(90.0)));
        ExportNotes notes;
        const json file = exported(scratch, builder.finish(), &notes);
        CHECK(file["meshes"].size() == 1);
        const json& row = file["objects"][0]["matrix"][0];
        CHECK(row[0].get<double>() > 0.5); // enlarged, so that its area equals the sphere's
        CHECK(row[0].get<double>() == doctest::Approx(0.5).epsilon(2e-4));
        CHECK(row[3] == 1.0);
        CHECK(file["objects"][1]["mesh"] == 0);
        CHECK(notes.size() == 1);
        // For direction w, Cycles looks up u = ½ − atan2(y, x)/2π in its rotated coordinates. Our convention adds a
        // quarter.
        const json& rows = file["environment"]["rows"];
        const Vec3d w = normalize(Vec3d(0.3, 0.2, -0.9));
        const auto turned = [&](std::size_t r) {
            return rows[r][0].get<double>() * w.x + rows[r][1].get<double>() * w.y + rows[r][2].get<double>() * w.z;
        };
        const double u = 0.5 - std::atan2(turned(1), turned(0)) / (2 * kPiDouble);
        CHECK(u == doctest::Approx(static_cast<double>(latlong_uv(Vec3(w)).x) + 0.25));
        CHECK(turned(2) == doctest::Approx(w.y));
        CHECK(read_image(scratch / "environment.exr").width() == 4);
    }

    TEST_CASE("many spheres are coarser, and of a sphere's area all the same") {
        const ScratchFolder scratch;
        SceneBuilder builder;
        const std::uint32_t grey = builder.material(Diffuse{});
        for (int i = 0; i < 1000; ++i) builder.add(Sphere{{static_cast<float>(3 * i), 0, 0}, 1}, grey);
        ExportNotes notes;
        const json file = exported(scratch, builder.finish(), &notes);
        const auto positions = numbers<float>(scratch, file["meshes"][0]["positions"]);
        const auto corners = numbers<std::int32_t>(scratch, file["meshes"][0]["triangles"]);
        CHECK(corners.size() / 3 > 1000);
        CHECK(corners.size() / 3 <= (1u << 21) / 1000);
        double sum = 0;
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            const auto p = [&](std::size_t k) {
                const auto at = 3 * static_cast<std::size_t>(corners[i + k]);
                return Vec3d(positions[at], positions[at + 1], positions[at + 2]);
            };
            sum += length(cross(p(1) - p(0), p(2) - p(0))) / 2;
        }
        const double scale = file["objects"][999]["matrix"][0][0].get<double>();
        CHECK(sum * scale * scale == doctest::Approx(4 * kPiDouble).epsilon(1e-5));
    }

    TEST_CASE("media: boxes, all of space, and grids of densities") {
        SceneBuilder builder;
        Medium everywhere, box, cloud;
        everywhere.scattering = {1, 2, 3}, everywhere.asymmetry = 0.5f;
        box.box = {{0, 1, 2}, {3, 4, 5}}, box.absorption = Rgb(1), box.radiance = {4, 0, 0};
        cloud.box = {{-1, -1, -1}, {1, 1, 1}}, cloud.scattering = Rgb(2);
        cloud.density = std::make_shared<const DensityGrid>(std::array{2, 2, 3},
                                                            std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 0});
        builder.scene.media = {everywhere, box, cloud};
        const ScratchFolder scratch;
        ExportNotes notes;
        const json media = exported(scratch, builder.finish(), &notes)["media"];
        REQUIRE(media.size() == 3);
        CHECK(media[0]["scattering"] == json({1, 2, 3}));
        CHECK(media[0]["asymmetry"] == 0.5);
        CHECK(media[0]["box"].is_null());
        CHECK(media[1]["box"] == json({{0, 1, 2}, {3, 4, 5}}));
        CHECK(media[1]["absorption"] == json({1, 1, 1}));
        CHECK(media[1]["radiance"] == json({4, 0, 0}));
        CHECK(media[1]["density"].is_null());
        CHECK(media[2]["density"]["size"] == json({2, 2, 3}));
        CHECK(numbers<float>(scratch, media[2]["density"]["values"]) == cloud.density->densities());
        CHECK(notes.size() == 3); // on boxes, on grids, and on asymmetries
    }

    TEST_CASE("what has no counterpart is refused by name") {
        const ScratchFolder scratch;
        const auto refused = [&](const Scene& scene, const char* what, int depth = 8) {
            std::string text;
            try {
                export_scene(scratch.path(), scene, {scene.camera, 4, 3}, {depth, 1});
            } catch (const Error& error) {
                text = error.what();
            }
            CHECK_MESSAGE(text.find(what) != std::string::npos, text);
        };
        SceneBuilder noise, motion, spot;
        noise.scene.textures.textures.emplace_back(NoiseTexture{});
        noise.add(Sphere{}, noise.material(Diffuse{{Rgb(1.0f), 0}}));
        refused(noise.finish(), "noise");
        motion.place_moving(motion.shape(Sphere{}), motion.material(Diffuse{}), Mat4(),
                            Mat4(translation(Vec3(1, 0, 0))));
        Scene moving = motion.finish();
        refused(moving, "moves");
        moving.camera.shutter_close = moving.camera.shutter_open = 0.5; // static while the shutter is open
        CHECK(exported(scratch, moving)["objects"][0]["matrix"][0][3] == 0.5);
        spot.scene.lights.push_back(SpotLight{{0, 1, 0}, {0, -1, 0}, Rgb(1.0f), 0.5f, -0.5f});
        refused(spot.finish(), "spot");
        refused(load_scene(fs::path(DUET_SOURCE_DIR) / "models" / "cornell.json"), "depth", 0);
    }

    TEST_CASE("a subprocess is written to and read from by lines, and its end is noticed") {
        Subprocess cat({"cat"});
        CHECK(cat.write_line("one"));
        CHECK(cat.write_line("two"));
        CHECK(cat.read_line(std::chrono::seconds(10)).line == "one");
        CHECK(cat.read_line(std::chrono::seconds(10)).line == "two");
        CHECK(cat.read_line(std::chrono::milliseconds(20)).status == Subprocess::Status::kTimeout);
        Subprocess said({"sh", "-c", "echo out; echo error >&2"});
        CHECK(said.read_line(std::chrono::seconds(10)).line == "out");
        CHECK(said.read_line(std::chrono::seconds(10)).line == "error");
        CHECK(said.read_line(std::chrono::seconds(10)).status == Subprocess::Status::kEnd);
        CHECK_THROWS_AS(Subprocess({"no-such-program-anywhere"}), Error);
    }
}
