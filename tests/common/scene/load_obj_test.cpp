// These tests check OBJ and MTL files: the results of valid files and the error messages of hostile ones.
#include "common/scene/default_scene.h"
#include "common/scene/obj/load_obj.h"
#include "common/scene/scene.h"

#include "tests/support/errors.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <set>

using namespace duet;
using duet::test::error_of;
using duet::test::says;
using duet::test::ScratchFolder;

namespace {

ObjFile load(const std::string& text, const ObjOptions& options = {}) {
    const ScratchFolder folder;
    return load_obj(folder.write("mesh.obj", text), options);
}
std::string refusal(const std::string& text) {
    return error_of([&] { load(text); });
}
Material material_of(const std::string& mtl) {
    const ScratchFolder folder;
    folder.write("m.mtl", "newmtl a\n" + mtl);
    return load_obj(folder.write("mesh.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"))
        .materials.at(0)
        .material;
}
const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

using Triangle = std::array<std::uint32_t, 3>;

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("Corners become vertices: those alike in all indices are one") {
        const ObjFile file =
            load(kSquare + "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\nf 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/2/1\n");
        CHECK(file.mesh.positions.size() == 4);
        CHECK(file.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
        CHECK(file.mesh.uvs.at(3) == Vec2(1, 0));
        for (const Vec3 n : file.mesh.normals) CHECK(n == Vec3(0, 0, 1)); // normalized
        CHECK(file.mesh.material_slots.empty());
        CHECK(file.materials.size() == 1);
        CHECK(load(kSquare + "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 3/2 4/2\n").mesh.positions.size() == 6);
    }

    TEST_CASE("Negative indices count back from their line; vertices nobody uses are dropped") {
        const ObjFile file = load("v 9 9 9\n" + kTriangle + "f -3 -2 -1\nv 0 0 1\nf -4 -3 -1\n");
        REQUIRE(file.mesh.positions.size() == 4);
        CHECK(file.mesh.positions[0] == Vec3(0, 0, 0));
        CHECK(file.mesh.positions[3] == Vec3(0, 0, 1));
    }

    TEST_CASE("A face may name vertices that come later") {
        CHECK(load("f 1 2 3\n" + kTriangle).mesh.triangles.size() == 1);
    }

    TEST_CASE("Lines end as they like, continue by a backslash, and hold what else they like") {
        const ObjFile file = load("\xEF\xBB\xBF# comment\r\n\r\no a\rg b c\n\tv  0 0 0 1.0\r\nv 1.e0 +0 -0 0.5 0.5 "
                                  "0.5\nv .0 1 \\\n 0\ns off\nl 1 2\nvp 1\n"
                                  "f 1 \\\r\n 2 3 \nwhatever 7");
        CHECK(file.mesh.triangles.size() == 1);
        CHECK(file.mesh.positions[1] == Vec3(1, 0, 0));
    }

    TEST_CASE("Missing uvs and normals are made up as documented") {
        const ObjFile file = load(kSquare + "vt 0.5 0.5\nvn 1 0 0\nvn 0 0 0\nf 1/1/1 2 3//2\nf 1//1 3 4\n");
        REQUIRE(file.mesh.normals.size() == file.mesh.positions.size());
        std::set<float> x;
        for (const Vec3 n : file.mesh.normals) {
            CHECK(length(n) == doctest::Approx(1));
            CHECK((n == Vec3(1, 0, 0) || n == Vec3(0, 0, 1)));
        }
        CHECK(file.mesh.uvs[0] == Vec2(0.5f, 0.5f));
        CHECK(file.mesh.uvs[1] == Vec2(0, 0));
        CHECK(load(kTriangle + "vn 0 0 1\nf 1//1 2//1 3//1\n", {MeshNormals::kFlat}).mesh.normals.empty());
        CHECK(load(kTriangle + "f 1 2 3\n").mesh.normals.empty());
        CHECK(load(kTriangle + "f 1 2 3\n", {MeshNormals::kAuto}).mesh.normals.size() == 3);
    }

    TEST_CASE("Polygons become triangles, faces without area drop out") {
        CHECK(load("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n").mesh.triangles.size() == 3);
        const ObjFile file = load(kSquare + "f 1 1 2\nf 1 2 1\nf 1 2 2 3 3 4 1\nf 4 4 4 4\n");
        CHECK(file.mesh.triangles.size() == 2);
        CHECK(file.degenerate_faces == 3);
        // The polygon has more than 255 vertices, at which tinyobjloader's own vertex count wraps around.
        std::string many;
        for (int i = 0; i < 1000; ++i) many += message("v ", std::cos(i * 0.00628), " ", std::sin(i * 0.00628), " 0\n");
        many += "f";
        for (int i = 1; i <= 1000; ++i) many += message(" ", i);
        CHECK(load(many + "\n").mesh.triangles.size() == 998);
    }

    TEST_CASE("Hostile files give one line with file and line number") {
        struct {
            std::string text, part;
        } const cases[] = {
            {"", "mesh.obj: has no faces"},
            {kTriangle, "mesh.obj: has no faces"},
            {kTriangle + "f 1 1 2\n", "has no face of three different vertices"},
            {kTriangle + "f 1 2 4\n", "mesh.obj: line 4: the vertex index 4 is out of range: there are 3"},
            {kTriangle + "f 1 2 0\n", "line 4: the vertex index 0 is out of range"},
            {kTriangle + "f 1 2 -4\n", "line 4: the vertex index -4 is out of range"},
            {kTriangle + "f -9223372036854775808 2 3\n",
             "line 4: the vertex index -9223372036854775808 is out of range"},
            {kTriangle + "f 1 2 2147483648\n", "line 4: the vertex index 2147483648 is out of range"},
            {kTriangle + "f 1 2 4294967297\n",
             "line 4: the vertex index 4294967297 is out of range"}, // wraps around to 1 in 32 bits
            {kTriangle + "f 1 2 99999999999999999999999\n",
             "line 4: the vertex index 99999999999999999999999 is out of range"},
            {kTriangle + "f 1/1 2/1 3/1\n", "line 4: the texture coordinate index 1 is out of range: there are 0"},
            {kTriangle + "f 1//1 2//1 3//1\n", "line 4: the normal index 1 is out of range: there are 0"},
            {kTriangle + "f 1/2147483647/1 2 3\n", "out of range"},
            {kTriangle + "f 1 2\n", "line 4: a face of 2 corners, expected at least 3"},
            {kTriangle + "f\n", "line 4: a face of 0 corners"},
            {kTriangle + "f 1 2 x\n", "line 4: found \"x\", expected a vertex index"},
            {kTriangle + "f 1 2 3.5\n", "line 4: found \"3.5\", expected a vertex index"},
            {kTriangle + "f 1 2 /3\n", "line 4: found \"\", expected a vertex index"},
            {kTriangle + "f 1/2/3/4 1 1\n", "line 4"},
            {"v 0 0 nan\n", "line 1: found \"nan\", expected a number"},
            {"v 0 0 NaN(1)\n", "line 1: found \"NaN(1)\", expected a number"},
            {"v 0 inf 0\n", "line 1: found \"inf\", expected a number between"},
            {"v 0 0 1e30\n", "line 1: found \"1e30\", expected a number between -1e18 and 1e18"},
            {"v 0 0 -1e999\n", "line 1: found \"-1e999\", expected a number between"},
            {"v 0 0 1e-999\n" + kTriangle + "f 1 2 9\n", "line 5"},
            {"v 0 0\n", "line 1: ends too early"},
            {"v 0 0 0x10\n", "line 1: found \"0x10\", expected a number"},
            {"v 0 0 1,5\n", "line 1: found \"1,5\", expected a number"},
            {"\n\nvn 0 0 ---1\n", "line 3: found \"---1\", expected a number"},
            {"vt\n", "line 1: ends too early"},
            {std::string("v 0 0 0\0f 1 1 1", 15), "holds a NUL byte, expected text"},
            {"v 0 0 \x01\x02\n", "line 1: found \"\\x01\\x02\", expected a number"},
            {"f 1 2 3\n" + std::string(1 << 20, 'f'), "the vertex index 3 is out of range"},
            {"v 0 0 " + std::string(1 << 20, '1') + "\n", "line 1: found \"11111"},
            {"f " + std::string(1 << 20, '/') + "\n", "line 1"},
        };
        for (const auto& example : cases) {
            const std::string error = refusal(example.text);
            CAPTURE(example.text.substr(0, 100));
            CAPTURE(error);
            CHECK(says(error, example.part));
            CHECK(error.size() < 400);
        }
    }

    TEST_CASE("A byte order mark does not hide the first line") {
        CHECK(load("\xEF\xBB\xBF" + kTriangle + "f 1 2 3\n").mesh.triangles.size() == 1);
    }

    TEST_CASE("A line number survives continued lines before it") {
        CHECK(says(refusal("v 0 \\\n 0 \\\n 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), "line 6: the vertex index 9"));
    }

    TEST_CASE("Files cut off anywhere load or fail cleanly") {
        const std::string whole = "mtllib gone.mtl\n" + kSquare +
                                  "vt 0 0\nvn 0 0 1\ng a\nf 1/1/1 2/1/1 3/1/1 4/1/1\ns 1\nf -4//-1 -3//-1 -2//-1\n";
        int loaded = 0;
        for (std::size_t length = 0; length <= whole.size(); ++length)
            if (refusal(whole.substr(0, length)) == "no error") ++loaded;
        CHECK(loaded > 10);
        CHECK(loaded < static_cast<int>(whole.size()));
    }

    TEST_CASE("MTL materials are mapped by the table of models/README.md") {
        CHECK(std::get<Diffuse>(material_of("Kd 0.1 0.2 0.3\nillum 2\nKs 1 1 1\n")).albedo.value ==
              Rgb(0.1f, 0.2f, 0.3f));
        CHECK(std::get<Diffuse>(material_of("Kd 2 255 0.3\n")).albedo.value == Rgb(1, 1, 0.3f));
        const auto area_light = std::get<Emissive>(material_of("Kd 0.5 0.5 0.5\nKe 17 12 4\n"));
        CHECK(area_light.radiance == Rgb(17, 12, 4));
        CHECK(area_light.albedo.value == Rgb(0.5f));
        CHECK(std::get<Dielectric>(material_of("d 0.5\nNi 1.33\n")).ior == 1.33f);
        CHECK(std::get<Dielectric>(material_of("Tr 0.5\nNi 1.33\n")).ior == 1.33f);
        CHECK(std::holds_alternative<Diffuse>(material_of("d 0.5\nNi 1\n")));
        for (const std::string illum : {"4", "6", "7", "9"})
            CHECK(std::get<Dielectric>(material_of("illum " + illum + "\n")).ior == 1.5f);
        CHECK(std::get<Dielectric>(material_of("illum 7\nNi 9\nTf 0.9 1 1\n")).ior == 4);
        CHECK(std::get<Dielectric>(material_of("illum 7\nNi 9\nTf 0.9 1 1\n")).tint.value == Rgb(0.9f, 1, 1));
        const auto metal = std::get<Principled>(material_of("Kd 1 0.8 0.3\nPm 1\nPr 0.25\nillum 3\nKs 1 1 1\n"));
        CHECK(metal.base_color.value == Rgb(1, 0.8f, 0.3f));
        CHECK(metal.metallic.value == 1);
        CHECK(metal.roughness.value == 0.25f);
        CHECK(metal.ior == 1.5f);
        CHECK(metal.clearcoat.value == 0);
        const auto varnished = std::get<Principled>(material_of("Kd 1 0 0\nPr 0.5\nNi 1.45\nPc 2\nPcr 0.25\n"));
        CHECK(varnished.metallic.value == 0);
        CHECK(varnished.roughness.value == 0.5f);
        CHECK(varnished.ior == 1.45f);
        CHECK(varnished.clearcoat.value == 1);
        CHECK(varnished.clearcoat_roughness.value == 0.25f);
        CHECK(std::get<Principled>(material_of("Kd 1 0 0\nPm 0.3\n")).metallic.value == 0.3f);
        CHECK(std::get<Principled>(material_of("Kd 1 0 0\nPc 1\n")).clearcoat.value == 1);
        CHECK(std::holds_alternative<Diffuse>(material_of("Kd 1 0 0\nPm 0\nPr 0\nPc 0\n")));
        const auto satin = std::get<Metal>(material_of("Ks 0.9 0.9 0.9\nillum 3\nNs 30\nPr 0.125\n"));
        CHECK(satin.roughness.value == 0.125f);
        const auto mirror = std::get<Metal>(material_of("Kd 0 0 0\nKs 0.9 0.9 0.9\nillum 3\nNs 30\n"));
        CHECK(mirror.reflectance.value == Rgb(0.9f));
        CHECK(mirror.roughness.value == doctest::Approx(0.5)); // (2 / 32)^¼
        CHECK(std::holds_alternative<Diffuse>(material_of("illum 3\nKs 0 0 0\n")));
    }

    TEST_CASE("MTL images of all kinds arrive, each with what is taken of it") {
        const ScratchFolder folder;
        folder.write(
            "m.mtl",
            "newmtl a\nKd 1 1 1\nPm 1\nPr 0.5\nmap_Kd a.png\nmap_Pr b.png\nmap_Pm g.png\nnorm c.png\nmap_Bump -bm 3 "
            "d.png\nmap_d e.png\nd 0.75\nNi 1\nnewmtl b\nKd 0 0 0\nmap_Ke f.png\nmap_d e.png\n");
        const ObjFile file = load_obj(
            folder.write("mesh.obj", "mtllib m.mtl\n" + kSquare + "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n"));
        REQUIRE(file.materials.size() == 2);
        const auto texture = [&](std::int32_t index) {
            REQUIRE(index >= 0);
            return file.textures.at(static_cast<std::size_t>(index));
        };
        using Values = ChannelSelection::Values;
        const auto metal = std::get<Principled>(file.materials[0].material);
        const SurfaceMaps& maps = file.materials[0].maps;
        CHECK(texture(metal.base_color.texture).file == folder / "a.png");
        CHECK(texture(metal.metallic.texture).file == folder / "g.png");
        CHECK(texture(metal.metallic.texture).selection.values == Values::kData);
        CHECK(texture(metal.base_color.texture).selection.values == Values::kColors);
        CHECK(texture(metal.roughness.texture).file == folder / "b.png");
        CHECK(texture(metal.roughness.texture).selection.values == Values::kData);
        CHECK(metal.roughness.value == 0.5f);
        CHECK(texture(maps.normal).file == folder / "c.png");
        CHECK(texture(maps.normal).selection.values == Values::kData);
        CHECK(texture(maps.bump).file == folder / "d.png");
        CHECK(maps.bump_scale == doctest::Approx(0.03));
        CHECK(texture(maps.opacity.texture).file == folder / "e.png");
        CHECK(texture(maps.opacity.texture).selection.channel == ChannelSelection::Channel::kOpacity);
        CHECK(maps.opacity.value == 0.75f);
        const auto area_light = std::get<Emissive>(file.materials[1].material);
        CHECK(area_light.radiance == Rgb(1.0f));
        CHECK(texture(area_light.radiance_texture).file == folder / "f.png");
        CHECK(file.materials[1].maps.opacity.constant()); // emitters have no alpha mask
    }

    TEST_CASE("Material slots follow usemtl, in order of first use") {
        const ScratchFolder folder;
        folder.write("two words.mtl", "# none\nnewmtl red\nKd 1 0 0\nnewmtl my blue\nKd 0 0 1\nmap_Kd -s 2 3 1 "
                                      "tex\\tile 1.png\nnewmtl never\nKd 0 0 0\n");
        const ObjFile file = load_obj(folder.write(
            "mesh.obj", "mtllib two words.mtl\n" + kSquare +
                            "f 1 2 3\nusemtl my blue \nf 1 3 4\nusemtl red\nf 2 3 4\nusemtl my blue\nf 1 2 4\n"));
        REQUIRE(file.materials.size() == 3);
        CHECK(file.materials[0].name.empty());
        CHECK(file.materials[1].name == "my blue");
        CHECK(file.materials[2].name == "red");
        CHECK(file.mesh.material_slots == std::vector<std::uint16_t>{0, 1, 2, 1});
        CHECK(std::get<Diffuse>(file.materials[0].material).albedo.value ==
              std::get<Diffuse>(default_obj_material()).albedo.value);
        CHECK(std::get<Diffuse>(file.materials[1].material).albedo.texture == 0);
        CHECK(std::get<Diffuse>(file.materials[2].material).albedo.texture == -1);
        REQUIRE(file.textures.size() == 1);
        CHECK(file.textures[0].file == (folder / "tex" / "tile 1.png"));
        CHECK(file.textures[0].scale == Vec2(2, 3));
        CHECK(load_obj(folder / "mesh.obj", {MeshNormals::kFile, false}).materials.size() == 1);
    }

    TEST_CASE("Missing materials are an error only where a face uses them and a file should have had them") {
        const ScratchFolder folder;
        folder.write("m.mtl", "newmtl red\nKd 1 0 0\n");
        const auto refused = [&](const std::string& text, const ObjOptions& options = {}) {
            return error_of([&] { load_obj(folder.write("mesh.obj", text), options); });
        };
        CHECK(refused("mtllib gone.mtl\n" + kTriangle + "f 1 2 3\n") == "no error");
        CHECK(refused(kTriangle + "usemtl red\nf 1 2 3\n") == "no error");
        const std::string missing = refused("mtllib gone.mtl\n" + kTriangle + "usemtl red\nf 1 2 3\n");
        CHECK_MESSAGE((says(missing, "mesh.obj: the material \"red\" is used, but its file ") &&
                       says(missing, "gone.mtl is missing")),
                      missing);
        CHECK(refused("mtllib gone.mtl\n" + kTriangle + "usemtl red\nf 1 2 3\n", {MeshNormals::kFile, false}) ==
              "no error");
        CHECK(says(refused("mtllib m.mtl\n" + kTriangle + "usemtl rde\nf 1 2 3\n"),
                   "the material \"rde\" is used, but no MTL file has it; did you mean \"red\"?"));
        CHECK(refused("mtllib m.mtl\n" + kTriangle + "usemtl rde\nusemtl red\nf 1 2 3\n") == "no error");
        folder.write("bad.mtl", "newmtl red\nKd 1 zero 0\n");
        CHECK(says(refused("mtllib bad.mtl\n" + kTriangle + "f 1 2 3\n"),
                   "bad.mtl: line 2: found \"zero\", expected a number"));
        folder.write("dark.mtl", "newmtl red\nKe -1 0 0\n");
        CHECK(says(refused("mtllib dark.mtl\n" + kTriangle + "f 1 2 3\n"), "the material \"red\" has Ke -1"));
        folder.write("nan.mtl", "newmtl red\nNs nan\n");
        CHECK(says(refused("mtllib nan.mtl\n" + kTriangle + "f 1 2 3\n"), "nan.mtl: line 2: found \"nan\""));
    }

    TEST_CASE("A bare mesh is framed whole, whatever its size and place") {
        const ScratchFolder folder;
        for (const double scale : {1e-6, 1.0, 1e6})
            for (const double offset : {0.0, 30.0}) {
                const double a = offset * scale, b = (offset + 1) * scale;
                const Scene scene = load_scene(
                    folder.write("mesh.obj", message("v ", a, " ", a, " ", a, "\nv ", b, " ", a, " ", a, "\nv ", b, " ",
                                                     b, " ", a, "\nv ", a, " ", a, " ", b, "\nf 1 2 3\nf 1 2 4\n")));
                const Camera& camera = scene.camera;
                const Vec3d forward = normalize(camera.look_at - camera.eye),
                            right = normalize(cross(forward, camera.up)), up = cross(right, forward);
                const double tan_y = std::tan(radians(camera.fov_degrees / 2)),
                             tan_x = tan_y * scene.width / scene.height;
                double fill = 0;
                for (const Vec3 p : std::get<Mesh>(scene.shapes[0]).positions) {
                    const Vec3d d = Vec3d(p) - camera.eye;
                    fill = max(fill, max(abs(dot(d, right)) / tan_x, abs(dot(d, up)) / tan_y) / dot(d, forward));
                }
                CAPTURE(scale);
                CAPTURE(offset);
                CHECK(fill < 0.95);
                CHECK(fill > 0.6); // its shadow is in the image, too
                const Quad& ground = std::get<QuadList>(scene.shapes[1]).quads[0];
                CHECK(static_cast<double>(ground.corner.y) < a);
                CHECK(static_cast<double>(ground.corner.y) > a - 0.01 * scale);
                CHECK(scene.needs.smooth_normals);
                CHECK(scene.needs.environment);
                CHECK(scene.lights.size() == 1);
            }
    }

    TEST_CASE("A bare mesh stands on its flat side in z, on its lowest point in y, or as the caller says") {
        // A pyramid with its apex at +z: its base lies in the plane z = 0, and in y it stands on an edge.
        const std::string pyramid = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 0 3\n"
                                    "f 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
        const std::string along_y = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv 0 3 0\n"
                                    "f 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
        const ScratchFolder folder;
        const auto apex = [&](const std::string& mesh, UpAxis up) {
            const Scene scene = load_scene(folder.write("mesh.obj", mesh), up);
            CHECK(scene.objects[0].identity); // the turn is baked
            const std::vector<Vec3>& p = std::get<Mesh>(scene.shapes[0]).positions;
            Vec3 farthest = p[0];
            for (const Vec3 q : p)
                if (length(q) > length(farthest)) farthest = q;
            return farthest;
        };
        CHECK(apex(pyramid, UpAxis::kGuessed) == Vec3(0, 3, 0));
        CHECK(apex(along_y, UpAxis::kGuessed) == Vec3(0, 3, 0));
        CHECK(apex(pyramid, UpAxis::kY) == Vec3(0, 0, 3));
        CHECK(apex(pyramid, UpAxis::kZ) == Vec3(0, 3, 0));
        CHECK(apex(along_y, UpAxis::kX) == Vec3(-3, 0, 0));
        folder.write("scene.json", R"({"camera": {"eye": [0, 0, 3], "look_at": [0, 0, 0]}, "objects": []})");
        CHECK(says(error_of([&] { load_scene(folder / "scene.json", UpAxis::kZ); }), "--up turns a bare mesh"));
    }

    TEST_CASE("A bare mesh without extent is refused") {
        const ScratchFolder folder;
        CHECK(says(error_of([&] { load_scene(folder.write("mesh.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n")); }),
                   "too small or too large"));
    }

    TEST_CASE("Real meshes load" * doctest::skip(std::getenv("DUET_MODELS") == nullptr)) {
        for (const auto& entry : std::filesystem::directory_iterator(std::getenv("DUET_MODELS"))) {
            if (entry.path().extension() != ".obj") continue;
            CAPTURE(entry.path());
            const ObjFile file = load_obj(entry.path());
            CHECK(file.mesh.triangles.size() > 500);
            CHECK(file.degenerate_faces == 0);
            for (const auto& triangle : file.mesh.triangles)
                for (const std::uint32_t i : triangle) REQUIRE(i < file.mesh.positions.size());
        }
    }

} // TEST_SUITE
