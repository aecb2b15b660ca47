// These tests check which scene files are read and which are rejected with which message.
#include "common/scene/scene.h"

#include "common/medium/density_grid.h"

#include "tests/support/errors.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace duet;
using duet::test::error_of;
using duet::test::says;
using duet::test::ScratchFolder;

namespace {

/// Describes a scene of one sphere in which each section can be replaced.
struct Parts {
    std::string camera = R"({"eye": [0, 0, 5], "look_at": [0, 0, 0]})";
    std::string materials = R"({"m": {"type": "diffuse"}})";
    std::string objects = R"([{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m"}])";
    std::string more{}; ///< further members, each preceded by a comma
    std::string text() const {
        return R"({"camera": )" + camera + R"(, "materials": )" + materials + R"(, "objects": )" + objects + more + "}";
    }
};

Scene load(const std::string& text) {
    const ScratchFolder folder;
    return load_scene(folder.write("scene.json", text));
}
std::string refusal(const std::string& text) {
    return error_of([&] { load(text); });
}
void check_refusals(std::initializer_list<std::pair<Parts, std::string>> cases) {
    for (const auto& example : cases) {
        const Parts& parts = example.first;
        const std::string error = refusal(parts.text());
        CAPTURE(parts.text());
        CAPTURE(error);
        CHECK(says(error, example.second));
    }
}
Parts with_camera(const std::string& camera) { return {.camera = camera}; }
Parts with_materials(const std::string& materials) { return {.materials = materials}; }
Parts with_objects(const std::string& objects) { return {.objects = objects}; }
Parts with(const std::string& more) { return {.more = ", " + more}; }

const char* const kWhole = R"({
  "$schema": "scene.schema.json", "description": "all there is",
  "camera": {"projection": "perspective", "eye": [0, 1, 6], "look_at": [0, 1, 0], "up": [0, 2, 0], "fov_degrees": 20,
             "near": 0.01, "aperture_radius": 0.1, "focus_distance": 5, "shutter": [0.25, 0.75]},
  "image": {"width": 320, "height": 200, "exposure": -1.5, "tone": "agx", "dither": true},
  "textures": {
    "tiles": {"type": "checker", "even": 0.9, "odd": [0.1, 0.2, 0.3], "scale": 8, "solid": true},
    "stone": {"type": "noise", "low": 0.1, "high": [0.9, 0.8, 0.7], "scale": 4, "octaves": 6, "marble": true}
  },
  "materials": {
    "white": {"type": "diffuse", "albedo": [0.725, 0.71, 0.68]},
    "tiled": {"type": "diffuse", "albedo": {"texture": "tiles", "tint": 0.5}},
    "gold": {"type": "metal", "reflectance": [1.0, 0.78, 0.34], "roughness": 0.2},
    "glass": {"type": "dielectric", "ior": 1.4, "tint": 0.9},
    "lamp": {"type": "emissive", "radiance": [17, 12, 4], "two_sided": true, "albedo": 0.3}
  },
  "objects": [
    {"name": "floor", "type": "quad", "corner": [-1, 0, 1], "u": [2, 0, 0], "v": [0, 0, -2], "material": "tiled"},
    {"type": "sphere", "center": [0, 1, 0], "radius": 0.5, "material": "glass"},
    {"type": "box", "low": [-1, 0, -1], "high": [1, 2, 1], "material": "gold", "transform": [{"translate": [0, 0,
     -3]}]},
    {"name": "light", "type": "quad", "corner": [0, 2, 0], "u": [1, 0, 0], "v": [0, 0, 1], "material": "lamp"}
  ],
  "lights": [
    {"type": "point", "position": [0, 3, 0], "intensity": 10},
    {"type": "spot", "position": [0, 3, 0], "direction": [0, -2, 0], "intensity": [1, 2, 3], "inner_degrees": 20,
     "outer_degrees": 60},
    {"type": "sun", "direction": [0, -3, 4], "irradiance": 3}
  ],
  "environment": {"type": "sky", "down": 0.5, "up": [0.1, 0.2, 0.4]}
})";

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("Each part of a scene arrives") {
        const Scene scene = load(kWhole);
        CHECK(scene.camera.fov_degrees == 20);
        CHECK(scene.camera.near == 0.01);
        CHECK(scene.camera.aperture_radius == 0.1);
        CHECK(scene.camera.focus_distance == 5);
        CHECK(scene.camera.shutter_open == 0.25);
        CHECK(scene.camera.shutter_close == 0.75);
        CHECK(scene.width == 320);
        CHECK(scene.view_transform == ViewTransform{-1.5f, Tone::kAgx, true});
        CHECK(scene.height == 200);
        REQUIRE(scene.materials.size() == 5);
        CHECK(scene.material_names[2] == "gold");
        CHECK(std::get<Metal>(scene.materials[2]).roughness.value == 0.2f);
        CHECK(std::get<Dielectric>(scene.materials[3]).ior == 1.4f);
        const auto& tiled = std::get<Diffuse>(scene.materials[1]);
        CHECK(tiled.albedo.value == Rgb(0.5f));
        const auto& checker =
            std::get<CheckerTexture>(scene.textures.textures[static_cast<std::size_t>(tiled.albedo.texture)]);
        CHECK(checker.odd == Rgb(0.1f, 0.2f, 0.3f));
        CHECK(checker.solid);
        CHECK(std::get<NoiseTexture>(scene.textures.textures[1]).octaves == 6);
        REQUIRE(scene.objects.size() == 4);
        CHECK(scene.objects[0].name == "floor");
        CHECK(scene.objects[1].name == "sphere-1");
        CHECK(scene.objects[2].identity); // the transform was baked
        CHECK(std::get<QuadList>(scene.shapes[2]).quads[0].corner == Vec3(-1, 0, -4));
        REQUIRE(scene.lights.size() == 4);
        CHECK(scene.first_surface_light == 3);
        CHECK(std::get<SpotLight>(scene.lights[1]).direction == Vec3(0, -1, 0));
        CHECK(std::get<SpotLight>(scene.lights[1]).cos_outer == doctest::Approx(0.5));
        CHECK(std::get<SunLight>(scene.lights[2]).direction == Vec3(0, -0.6f, 0.8f));
        const auto& light = std::get<SurfaceLight>(scene.lights[3]);
        CHECK(light.object == 3);
        CHECK(light.two_sided);
        CHECK(light.radiance == Rgb(17, 12, 4));
        CHECK(std::get<SkyEnvironment>(scene.environment).down == Rgb(0.5f));
        CHECK(scene.needs.lens);
        CHECK(scene.needs.textures);
        CHECK_FALSE(scene.needs.image_textures);
        CHECK(scene.needs.glossy);
        CHECK(scene.needs.transmission);
        CHECK_FALSE(scene.needs.motion);
        CHECK_FALSE(scene.needs.meshes);
    }

    TEST_CASE("Materials of every kind arrive") {
        Parts parts;
        parts.materials = R"({
            "a": {"type": "diffuse", "roughness": 0.7},
            "b": {"type": "metal", "conductor": "copper", "roughness": 0.3},
            "c": {"type": "dielectric", "roughness": 0.4, "priority": 3, "absorption": {"color": [0.5, 1, 0],
             "distance": 2}},
            "d": {"type": "dielectric", "thin": true},
            "e": {"type": "principled", "base_color": [0.1, 0.2, 0.3], "metallic": 0.25,
             "roughness": {"texture": "t", "scale": 0.5},
                  "ior": 1.4, "clearcoat": 0.8, "clearcoat_roughness": 0.1},
            "m": {"type": "coated", "albedo": 0.3, "roughness": 0.2, "ior": 1.6}})";
        parts.more = R"(, "textures": {"t": {"type": "checker"}})";
        const Scene scene = load(parts.text());
        CHECK(std::get<Diffuse>(scene.materials[0]).roughness.value == 0.7f);
        const auto& copper = std::get<Metal>(scene.materials[1]);
        CHECK(copper.conductor.valid());
        CHECK(copper.reflectance.value == find_conductor("copper")->f0);
        const auto& liquid = std::get<Dielectric>(scene.materials[2]);
        CHECK(liquid.roughness.value == 0.4f);
        CHECK(liquid.priority == 3);
        CHECK(std::exp(-2 * liquid.absorption.r) == doctest::Approx(0.5));
        CHECK(liquid.absorption.g == 0);
        CHECK(std::exp(-2 * liquid.absorption.b) == doctest::Approx(1e-6).epsilon(1e-3));
        CHECK(std::get<Dielectric>(scene.materials[3]).thin);
        const auto& paint = std::get<Principled>(scene.materials[4]);
        CHECK(paint.base_color.value == Rgb(0.1f, 0.2f, 0.3f));
        CHECK(paint.metallic.value == 0.25f);
        CHECK(paint.roughness.texture == 0);
        CHECK(paint.ior == 1.4f);
        CHECK(paint.clearcoat.value == 0.8f);
        CHECK(paint.clearcoat_roughness.value == 0.1f);
        const auto& plastic = std::get<Coated>(scene.materials[5]);
        CHECK(plastic.albedo.value == Rgb(0.3f));
        CHECK(plastic.roughness.value == 0.2f);
        CHECK(plastic.ior == 1.6f);
    }

    TEST_CASE("An orthographic camera") {
        const Scene scene =
            load(with_camera(R"({"projection": "orthographic", "eye": [0, 0, 5], "look_at": [0, 0, 0], "height": 3})")
                     .text());
        CHECK(scene.camera.projection == Camera::Projection::kOrthographic);
        CHECK(scene.camera.height == 3);
    }

    TEST_CASE("What is wrong with the top of a file or its camera is said") {
        check_refusals({
            {with(R"("lihgts": [])"), "$: unknown key \"lihgts\"; did you mean \"lights\"?"},
            {with(R"("image": {"width": 0})"), "$.image.width: found 0, expected a whole number in [1, 16384]"},
            {with(R"("image": {"width": 100000})"), "$.image.width: found 100000"},
            {with(R"("image": {"width": 16384, "height": 16384})"),
             "$.image: found 268435456 pixels, expected at most 90000000; --size may ask for more"},
            {with(R"("image": {"width": 2.5})"), "$.image.width: found 2.5"},
            {with(R"("image": [1, 2])"), "$.image: found an array of 2 elements, expected an object"},
            {with(R"("image": {"exposure": 33})"), "$.image.exposure: found 33, expected a number in [-32, 32]"},
            {with(R"("image": {"tone": "warm"})"), "$.image.tone: found the string \"warm\", expected one of"},
            {with(R"("image": {"dither": 1})"), "$.image.dither: found 1"},
            {with(R"("description": 7)"), "$.description: found 7, expected a string"},
            {with_camera("7"), "$.camera: found 7, expected an object"},
            {with_camera(R"({"look_at": [0, 0, 0]})"), "$.camera: the key \"eye\" is missing"},
            {with_camera(R"({"eye": [0, 0], "look_at": [0, 0, 0]})"), "$.camera.eye: found an array of 2 elements"},
            {with_camera(R"({"eye": [0, 0, 1e19], "look_at": [0, 0, 0]})"), "$.camera.eye[2]: found 1e+19"},
            {with_camera(R"({"eye": [1, 1, 1], "look_at": [1, 1, 1]})"),
             "$.camera.look_at: must not be where the eye is"},
            {with_camera(R"({"eye": [0, 5, 0], "look_at": [0, 0, 0]})"), "$.camera: \"up\" must not be parallel"},
            {with_camera(R"({"eye": [0, 0, 5], "look_at": [0, 0, 0], "up": [0, 0, 0]})"),
             "$.camera.up: must not be the zero vector"},
            {with_camera(R"({"eye": [0, 0, 5], "look_at": [0, 0, 0], "fov_degrees": 180})"),
             "$.camera.fov_degrees: found 180"},
            {with_camera(R"({"eye": [0, 0, 5], "look_at": [0, 0, 0], "near": -1})"), "$.camera.near: found -1"},
            {with_camera(R"({"eye": [0, 0, 5], "look_at": [0, 0, 0], "shutter": [0.7, 0.2]})"),
             "$.camera.shutter: the shutter closes before"},
            {with_camera(R"({"eye": [0, 0, 5], "look_at": [0, 0, 0], "height": 2})"),
             "$.camera: unknown key \"height\""},
            {with_camera(R"({"projection": "orthographic", "eye": [0, 0, 5], "look_at": [0, 0, 0], "fov_degrees": 2})"),
             "$.camera: unknown key \"fov_degrees\""},
            {with_camera(R"({"projection": "fisheye", "eye": [0, 0, 5], "look_at": [0, 0, 0]})"),
             "$.camera.projection: found the string \"fisheye\""},
        });
        CHECK(says(refusal("[]"), "$: found an empty array, expected an object"));
        CHECK(says(refusal("{}"), "$: the key \"camera\" is missing"));
    }

    TEST_CASE("What is wrong with a material, texture, light or environment is said") {
        check_refusals({
            {with_materials(R"({"m": {"type": "difuse"}})"),
             "$.materials.m.type: found the string \"difuse\", expected one of"},
            {with_materials(R"({"m": {"type": "difuse"}})"), "did you mean \"diffuse\"?"},
            {with_materials(R"({"m": {}})"), "$.materials.m: the key \"type\" is missing"},
            {with_materials(R"({"m": {"type": "diffuse", "albedo": 1.2}})"),
             "$.materials.m.albedo: found 1.2, expected a number in [0, 1]"},
            {with_materials(R"({"m": {"type": "diffuse", "albedo": "red"}})"),
             "$.materials.m.albedo: found the string \"red\", expected a number, an array"},
            {with_materials(R"({"m": {"type": "diffuse", "albedo": [1, 1]}})"),
             "$.materials.m.albedo: found an array of 2 elements"},
            {with_materials(R"({"m": {"type": "diffuse", "albedo": {"texture": "t"}}})"),
             "$.materials.m.albedo.texture: unknown texture \"t\""},
            {with_materials(R"({"m": {"type": "diffuse", "ior": 1.5}})"),
             "$.materials.m: unknown key \"ior\"; expected one of \"type\""},
            {with_materials(R"({"m": {"type": "dielectric", "ior": 0.5}})"), "$.materials.m.ior: found 0.5"},
            {with_materials(R"({"m": {"type": "metal", "roughness": -0.1}})"), "$.materials.m.roughness: found -0.1"},
            {with_materials(R"({"m": {"type": "emissive"}})"), "$.materials.m: the key \"radiance\" is missing"},
            {with_materials(R"({"m": {"type": "emissive", "radiance": -1}})"), "$.materials.m.radiance: found -1"},
            {with_materials(R"({"m": {"type": "emissive", "radiance": 1, "two_sided": 1}})"),
             "$.materials.m.two_sided: found 1, expected true or false"},
            {with_materials(R"({"m": {"type": "metal", "conductor": "golt"}})"),
             "$.materials.m.conductor: unknown conductor \"golt\"; did you mean \"gold\"?"},
            {with_materials(R"({"m": {"type": "metal", "conductor": "gold", "reflectance": 1}})"),
             "$.materials.m.conductor: expected no reflectance beside it"},
            {with_materials(R"({"m": {"type": "dielectric", "thin": true, "roughness": 0.2}})"),
             "$.materials.m.roughness: a thin dielectric has none"},
            {with_materials(R"({"m": {"type": "dielectric", "absorption": {"color": 0.5}}})"),
             "$.materials.m.absorption: the key \"distance\" is missing"},
            {with_materials(R"({"m": {"type": "dielectric", "absorption": {"color": 0.5, "distance": 1e-50}}})"),
             "$.materials.m.absorption.distance: found 1e-50"},
            {with_materials(R"({"m": {"type": "dielectric", "priority": 1.5}})"), "$.materials.m.priority: found 1.5"},
            {with_materials(R"({"m": {"type": "principled", "metallic": 2}})"), "$.materials.m.metallic: found 2"},
            {with_materials(R"({"m": {"type": "coated", "ior": 5}})"), "$.materials.m.ior: found 5"},
            {with_materials("[]"), "$.materials: found an empty array, expected an object"},
            {with(R"("textures": {"t": {"type": "image", "file": "gone.png"}})"), "$.textures.t.file: "},
            {with(R"("textures": {"t": {"type": "image", "file": "gone.png"}})"), "gone.png: no such file"},
            {with(R"("textures": {"t": {"type": "noise", "octaves": 17}})"), "$.textures.t.octaves: found 17"},
            {with(R"("textures": {"t": {"type": "checker", "scale": 0}})"),
             "$.textures.t.scale: found 0, expected a number above 0"},
            {with(R"("lights": {})"), "$.lights: found an object, expected an array"},
            {with(R"("lights": [{"type": "point", "position": [0, 0, 0]}])"),
             "$.lights[0]: the key \"intensity\" is missing"},
            {with(R"("lights": [{"type": "sun", "direction": [0, 0, 0], "irradiance": 1}])"),
             "$.lights[0].direction: a direction must not be the zero vector"},
            {with(
                 R"("lights": [{"type": "spot", "position": [0, 0, 0], "direction": [0, 0, 1], "intensity": 1,
                  "inner_degrees": 40}])"),
             "$.lights[0]: \"inner_degrees\" must be below"},
            {with(R"("environment": {"type": "constant", "radiance": 1e300})"), "$.environment.radiance: found 1e+300"},
            {with(R"("environment": {"type": "image", "file": "gone.hdr"})"), "gone.hdr: no such file"},
        });
    }

    TEST_CASE("Clouds come from noise, and smoke from a file") {
        const ScratchFolder folder;
        folder.write("smoke.raw", std::string("\0\xff\x33\0\0\0\0\0\0\0\0\xff", 12));
        const Parts parts = with(R"("media": [
            {"type": "cloud", "low": [0, 0, 0], "high": [4, 2, 1], "scattering": 1, "resolution": 8, "coverage": 1},
            {"type": "smoke", "low": [0, 0, 0], "high": [2, 1, 1], "absorption": 1, "file": "smoke.raw",
             "resolution": [3, 2, 2]}])");
        const Scene scene = load_scene(folder.write("scene.json", parts.text()));
        REQUIRE(scene.media.size() == 2);
        REQUIRE((scene.media[0].density && scene.media[1].density));
        CHECK(scene.media[0].density->size() == std::array{9, 5, 3});
        CHECK(scene.media[0].density->largest() > 0);
        CHECK(density_at(scene.media[1], {0, 0, 0}) == 0);
        CHECK(density_at(scene.media[1], {1, 0, 0}) == 1);
        CHECK(density_at(scene.media[1], {2, 0, 0}) == doctest::Approx(0.2f));
        CHECK(density_at(scene.media[1], {2, 1, 1}) == 1);
        CHECK(std::ranges::count(scene.files, folder.path() / "smoke.raw") == 1);
    }

    TEST_CASE("What is wrong with a cloud or smoke is said") {
        const std::string box = R"("low": [0, 0, 0], "high": [1, 1, 1], "scattering": 1)";
        const auto smoke = [&](const std::string& keys) {
            return with(R"("media": [{"type": "smoke", )" + box + ", " + keys + "}]");
        };
        const auto clouds = [&](int count) {
            std::string list;
            for (int i = 0; i < count; ++i)
                list += (i > 0 ? ", " : "") + (R"({"type": "cloud", "resolution": 256, )" + box + "}");
            return with(R"("media": [)" + list + "]");
        };
        check_refusals({{with(R"("media": [{"type": "cloud", "low": [0, 0, 0]}])"), "high"},
                        {with(R"("media": [{"type": "mist", )" + box + "}]"), "cloud"},
                        {smoke(R"("file": "none.raw", "resolution": [2, 2, 2])"), "none.raw"},
                        {smoke(R"("file": "scene.json", "resolution": [2, 2, 2])"), "expected 8"},
                        {smoke(R"("file": "scene.json", "resolution": [2, 2])"), "three numbers"},
                        {smoke(R"("file": "scene.json", "resolution": [1, 2, 2])"), "resolution"},
                        {smoke(R"("file": "scene.json", "resolution": [4096, 4096, 4096])"), "at most"},
                        {clouds(2), "at most"}});
    }

    TEST_CASE("What is wrong with an object is said") {
        const std::string sphere = R"("type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m")";
        const auto moved = [&](const std::string& transform) {
            return with_objects("[{" + sphere + ", " + transform + "}]");
        };
        check_refusals({
            {with_objects("{}"), "$.objects: found an object, expected an array"},
            {with_objects("[1]"), "$.objects[0]: found 1, expected an object"},
            {with_objects(R"([{"type": "cube"}])"), "$.objects[0].type: found the string \"cube\""},
            {with_objects(R"([{"type": "sphere", "center": [0, 0, 0], "radius": 0, "material": "m"}])"),
             "$.objects[0].radius: found 0"},
            {with_objects(R"([{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "mm"}])"),
             "$.objects[0].material: unknown material \"mm\"; did you mean \"m\"?"},
            {with_objects(R"([{"type": "sphere", "center": [0, 0, 0], "radius": 1}])"),
             "$.objects[0]: the key \"material\" is missing"},
            {with_objects(
                 R"([{"type": "quad", "corner": [0, 0, 0], "u": [1, 0, 0], "v": [2, 0, 0], "material": "m"}])"),
             "$.objects[0]: the quad's \"u\" and \"v\" span no area"},
            {with_objects(R"([{"type": "box", "low": [0, 0, 0], "high": [1, 0, 1], "material": "m"}])"),
             "$.objects[0]: \"low\" must be below \"high\""},
            {with_objects(R"([{"type": "mesh", "file": "gone.obj"}])"), "gone.obj: no such file"},
            {with_objects(R"([{"type": "mesh", "file": "generated/gone.obj"}])"),
             "generated/gone.obj: no such file; the build targets \"models\""},
            {with_objects(R"([{"type": "mesh", "file": "gone.obj"}])"), "$.objects[0].file: "},
            {moved(R"("transform": [{"scale": 0}])"), "$.objects[0].transform[0].scale: a scale of 0"},
            {moved(R"("transform": [{"scale": "big"}])"), "$.objects[0].transform[0].scale: found the string \"big\""},
            {moved(R"("transform": [{"translate": [0, 0, 0]}, {"scale": [1, 0, 1]}])"),
             "$.objects[0].transform[1].scale: a scale of 0"},
            {moved(R"("transform": {"scale": 2})"), "$.objects[0].transform: found an object, expected an array"},
            {moved(R"("transform": [{"rotate_degrees": 20}])"),
             "$.objects[0].transform[0]: the key \"axis\" is missing"},
            {moved(R"("transform": [{"rotate_degrees": 20, "axis": [0, 0, 0]}])"),
             "$.objects[0].transform[0].axis: an axis must not be"},
            {moved(R"("transform": [{"translte": [1, 0, 0]}])"), "did you mean \"translate\"?"},
            {moved(R"("transform": [{"translate": [1, 0, 0], "scale": 2}])"),
             "$.objects[0].transform[0]: unknown key \"scale\""},
            {moved(R"("transform": [{"matrix": [1, 2, 3]}])"),
             "$.objects[0].transform[0].matrix: found an array of 3 elements"},
            {moved(R"("transform": [{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2]}])"),
             "the last row of a matrix must be"},
            {moved(R"("transform": [{"matrix": [1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0, 0, 0, 0, 1]}])"),
             "$.objects[0].transform: the transform is singular"},
            {moved(R"("transform": [{"scale": 1e18}, {"scale": 1e18}])"), "beyond 1e18"},
            {moved(R"("transform_end": [{"rotate_degrees": 180, "axis": [0, 1, 0]}])"),
             "$.objects[0].transform_end: the motion passes through a singular"},
            {moved(R"("transform_end": [{"scale": -1}])"),
             "$.objects[0].transform_end: the motion passes through a singular"},
            {with_objects(R"([{"type": "sphere", "center": [9e17, 0, 0], "radius": 9e17, "material": "m"}])"),
             "the object \"sphere-0\" reaches beyond 1e18"},
            {with_objects(R"([{"type": "box", "low": [0, 0, 0], "high": [1e15, 1, 1], "material": "m"}])"),
             "the object \"box-0\" reaches 1e+15 m from the eye, more than 1e13 times the 5 m that"},
        });
    }

    TEST_CASE("Motions that stay regular are accepted") {
        const std::string sphere =
            R"([{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m", "transform_end": )";
        for (const std::string end : {R"([{"rotate_degrees": 170, "axis": [1, 2, 3]}])", R"([{"scale": 0.001}])",
                                      R"([{"translate": [1e6, 0, 0]}])"}) {
            const Scene scene = load(with_objects(sphere + end + "}]").text());
            CHECK(scene.objects[0].moving);
            CHECK(scene.needs.motion);
        }
    }

    TEST_CASE("Other files are refused by name, before they are read") {
        CHECK(says(error_of([] { load_scene("picture.png"); }),
                   "picture.png: expected a scene file (.json) or a mesh (.obj)"));
        CHECK(says(error_of([] { load_scene("gone.json"); }), "gone.json: no such file"));
        CHECK(says(error_of([] { load_scene("gone.obj"); }), "gone.obj: no such file"));
    }

    TEST_CASE("Large arrays where small ones belong are refused at once") {
        std::string numbers = "[0";
        for (int i = 0; i < 200'000; ++i) numbers += ",0";
        const std::string error = refusal(with_camera(R"({"look_at": [0, 0, 0], "eye": )" + numbers + "]}").text());
        CHECK_MESSAGE(says(error, "$.camera.eye: found an array of 200001 elements"), error);
    }

} // TEST_SUITE
