// These tests compare our images with those of Blender's Cycles and EEVEE. They are skipped without Blender, and those
// of EEVEE without xvfb-run.
#include "compare/peers/blender.h"

#include "common/system/error.h"
#include "common/system/file.h"
#include "compare/bench/bias_check.h"
#include "compare/bench/render_reference.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>


using namespace duet;
using namespace duet::compare;
using duet::test::ScratchFolder;
using nlohmann::json;

namespace {

namespace fs = std::filesystem;

/// Returns whether the programs are in PATH that an engine needs, and says so if not.
bool can_run(BlenderEngine engine) {
    try {
        check_blender(engine);
    } catch (const Error& error) {
        MESSAGE("skipped: ", error.what());
        return false;
    }
    return true;
}

/// Returns the z-test of the block means of both renderers' images.
BiasCheck against_cycles(const fs::path& path, int width, int height, int spp) {
    const ScratchFolder scratch;
    const Scene scene = load_scene(path);
    const View view{scene.camera, width, height};
    const ReferenceSettings settings{scratch.path(), spp, 64, 2};
    BlenderPeer peer(BlenderEngine::kCycles, scene, view, {settings.depth, settings.threads});
    Control control;
    const auto render = [&](int n, std::uint64_t seed) { return peer.unbiased_image(n, seed, control); };
    const std::string program = peer.program(control);
    CHECK(program.starts_with("Blender "));
    const CachedReference cycles =
        reference_by_seeds({"cycles", kCyclesExportVersion, program}, scene, view, settings, render, control);
    const CachedReference ours = reference_by("path", scene, view, settings, control);
    const BiasCheck check = check_bias(ours.reference, cycles.reference);
    MESSAGE(path.filename().string(), ": largest |z| ", std::abs(check.worst_z), ", p ", check.p_value, ", detectable ",
            check.detectable);
    return check;
}

/// Removes from everything.json what Cycles does not support: noise and motion.
void make_exportable(json& value, const fs::path& folder) {
    if (value.is_object()) {
        value.erase("transform_end");
        if (value.contains("file")) value["file"] = (folder / value["file"].get<std::string>()).string();
        if (value.contains("type") && value["type"] == "noise") value = {{"type", "checker"}, {"scale", 40}};
    }
    if (value.is_structured())
        for (json& member : value) make_exportable(member, folder);
}

} // namespace

TEST_SUITE("image") {

    // A false alarm has odds of 1 in 1000 (BiasCheck::kSignificance); the seeds are fixed.
    TEST_CASE("the Cornell box: both images agree within their noise") {
        if (!can_run(BlenderEngine::kCycles)) return;
        const BiasCheck check = against_cycles(fs::path(DUET_SOURCE_DIR) / "models" / "cornell.json", 48, 48, 512);
        CHECK(check.consistent());
        CHECK(check.detectable < 0.01);
    }

    // The scene has all materials and lights, all textures except noise, an environment image, a thin lens, and
    // mirrored and instanced meshes.
    TEST_CASE("everything that can be exported: both images agree within their noise") {
        if (!can_run(BlenderEngine::kCycles)) return;
        const ScratchFolder scratch;
        const fs::path models = fs::path(DUET_SOURCE_DIR) / "models";
        json scene = json::parse(read_file(models / "everything.json"));
        make_exportable(scene, models);
        write_file(scratch / "everything.json", scene.dump());
        const BiasCheck check = against_cycles(scratch / "everything.json", 64, 48, 512);
        CHECK(check.consistent());
        CHECK(check.detectable < 0.02);
    }

    // A red ball in the light of a point light, a sun and a sky, in two overlapping boxes of fog and in smoke.
    TEST_CASE("fog and smoke: both images agree within their noise") {
        if (!can_run(BlenderEngine::kCycles)) return;
        const ScratchFolder scratch;
        const fs::path smoke = fs::path(DUET_SOURCE_DIR) / "models" / "textures" / "smoke.raw";
        json scene = json::parse(R"({
            "camera": {"eye": [0, 1, 6], "look_at": [0, 1, 0], "fov_degrees": 40},
            "materials": {"white": {"type": "diffuse", "albedo": 0.7},
                          "red": {"type": "diffuse", "albedo": [0.7, 0.1, 0.1]}},
            "objects": [{"type": "quad", "corner": [-5, 0, 5], "u": [10, 0, 0], "v": [0, 0, -10], "material": "white"},
                        {"type": "sphere", "center": [0.5, 0.8, 0.5], "radius": 0.5, "material": "red"}],
            "lights": [{"type": "point", "position": [-1.5, 2.6, 1.4], "intensity": 10},
                       {"type": "sun", "direction": [1, -1, -0.5], "irradiance": [1, 1, 0.8]}],
            "environment": {"type": "constant", "radiance": [0.2, 0.3, 0.4]},
            "media": [{"type": "fog", "low": [-2, 0, -2], "high": [2, 2, 2], "scattering": [0.3, 0.4, 0.6],
                       "absorption": [0.1, 0.05, 0.2], "asymmetry": 0.4},
                      {"type": "fog", "low": [-1, -1, -1], "high": [0, 4, 1], "scattering": 0.2, "absorption": 0.1,
                       "radiance": [1, 0.5, 0], "asymmetry": 0.4},
                      {"type": "smoke", "low": [-1, 0, 0.5], "high": [-0.5, 1.5, 1], "resolution": [48, 112, 48],
                       "scattering": 10, "absorption": 3, "asymmetry": 0.4}]})");
        scene["media"][2]["file"] = smoke.string();
        write_file(scratch / "fog.json", scene.dump());
        const BiasCheck check = against_cycles(scratch / "fog.json", 64, 48, 512);
        CHECK(check.consistent());
        CHECK(check.detectable < 0.01);
    }

    TEST_CASE("EEVEE draws the Cornell box, as bright as the path tracer within a third, and says its time") {
        if (!can_run(BlenderEngine::kEevee)) return;
        const Scene scene = load_scene(fs::path(DUET_SOURCE_DIR) / "models" / "cornell.json");
        const View view{scene.camera, 64, 64};
        BlenderPeer peer(BlenderEngine::kEevee, scene, view, {64, 2});
        Control control;
        const TimedImage found = peer.render({4, 0, false}, control);
        CHECK(found.seconds > 0);
        const ScratchFolder scratch;
        const CachedReference truth = reference_by("path", scene, view, {scratch.path(), 64, 64, 2}, control);
        double sum = 0, expected = 0;
        for (const Rgb& c : found.image) sum += static_cast<double>(average(c));
        for (const Rgb& c : truth.reference.mean) expected += static_cast<double>(average(c));
        CHECK(sum == doctest::Approx(expected).epsilon(0.33));
    }

    TEST_CASE("Blender's time is its render's, and a stop ends it") {
        if (!can_run(BlenderEngine::kCycles)) return;
        const Scene scene = load_scene(fs::path(DUET_SOURCE_DIR) / "models" / "cornell.json");
        BlenderPeer peer(BlenderEngine::kCycles, scene, {scene.camera, 32, 32}, {8, 1});
        Control control;
        peer.render({1, 1, false}, control);
        const double few = peer.render({16, 1, false}, control).seconds;
        const double many = peer.render({256, 1, false}, control).seconds;
        CHECK(few > 0);
        CHECK(many > 4 * few); // 16 times the samples: fixed costs are negligible
        const std::atomic<bool> stop{true};
        Control stopped{&stop, {}};
        CHECK(peer.render({1 << 20, 1, false}, stopped).image.empty());
    }
}
