// These tests check what the built-in shadings show.
#include "tests/raster/varied_scene.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;
using namespace duet::test;

TEST_SUITE("unit") {

    // Samples are exactly on the dark edges, where rounding gives the lit vertex a weight of either sign.
    TEST_CASE("Gouraud: light is not negative, however weights round where a lit corner is opposite to a dark edge") {
        constexpr float kPixel = 4.0f / 128;
        Mesh mesh;
        std::minstd_rand random(5);
        std::uniform_real_distribution<float> part(0.1f, 0.9f);
        for (int row = 0; row < 16; ++row)
            for (int column = 0; column < 16; ++column) {
                const Vec3 corner(-2 + (8 * static_cast<float>(column) + 0.5f) * kPixel,
                                  -2 + 8 * static_cast<float>(row) * kPixel, 0);
                const auto first = static_cast<std::uint32_t>(mesh.positions.size());
                mesh.positions.insert(mesh.positions.end(), {corner + Vec3(7 * kPixel, 7 * part(random) * kPixel, 0),
                                                             corner + Vec3(0, (6 + part(random)) * kPixel, 0), corner});
                // The sun shines from below.
                mesh.normals.insert(mesh.normals.end(), {{0, -1, 0.1f}, {0, 1, 0.1f}, {0, 1, 0.1f}});
                mesh.triangles.push_back({first, first + 1, first + 2});
            }
        Scene scene;
        add(scene, mesh);
        scene.lights.push_back(SunLight{Vec3(0, 1, 0), Rgb(2)});
        finish_scene(scene);
        const View view{look_orthographic({0, 0, 4}, {0, 0, 0}, 4), 128, 128};
        const Rendering seen = render(scene, view, with_hits(raster::Shading::kGouraud));
        int lit = 0;
        for (std::size_t i = 0; i < seen.hit.size(); ++i) lit += seen.hit[i].valid() && seen.radiance[i].r > 0;
        CHECK(lit > 4'000);
        CHECK(seen.statistics.invalid_samples == 0);
    }

    TEST_CASE("normals that cancel each other out, and those that are none, are no direction in any shading, nor "
              "invalid") {
        for (const bool cancel : {false, true}) {
            Mesh mesh;
            mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
            mesh.normals =
                cancel ? std::vector<Vec3>{{0, 0, 1}, {0, 0, -1}, {0, 0, -1}, {0, 0, 1}} : std::vector<Vec3>(4);
            mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
            Scene scene;
            add(scene, mesh);
            scene.lights.push_back(SunLight{normalize(Vec3(0, -1, -1)), Rgb(2)});
            scene.environment = ConstantEnvironment{Rgb(1.0f)};
            finish_scene(scene);
            const View view{look_orthographic({0, 0, 4}, {0, 0, 0}, 4), 65, 65}; // normals cancel in the middle column
            for (const raster::Shading shading :
                 {raster::Shading::kLit, raster::Shading::kPhong, raster::Shading::kGouraud, raster::Shading::kToon,
                  raster::Shading::kNormal}) {
                const Rendering seen = render(scene, view, with_hits(shading));
                CAPTURE(cancel);
                CAPTURE(static_cast<int>(shading));
                CHECK(seen.statistics.invalid_samples == 0);
                if (shading == raster::Shading::kNormal) CHECK(seen.radiance(32, 32) == Rgb(0.5f)); // the zero vector
            }
        }
    }

    TEST_CASE(
        "lights shine in every shading that shows light, in packets and alone, as materials and lights have them") {
        Scene scene = varied_scene(60);
        scene.textures.textures.push_back(CheckerTexture{Rgb(0.9f, 0.1f, 0.2f), Rgb(0.1f, 0.8f, 0.3f), 3, true});
        for (Material& material : scene.materials)
            material = Emissive{.radiance = Rgb(2.0f), .two_sided = true, .radiance_texture = 0};
        finish_scene(scene);
        scene.lights.clear(); // they would cause highlights
        raster::RasterSettings settings = with_hits();
        settings.environment = false;
        const raster::RasterScene prepared = raster::prepare(scene, settings);
        const View view = perspective();
        Control control;
        const Rendering lit = raster::render(prepared, view, settings, control);
        for (const raster::Shading shading :
             {raster::Shading::kPhong, raster::Shading::kGouraud, raster::Shading::kFlat, raster::Shading::kToon}) {
            settings.shading = shading;
            const Rendering shown = raster::render(prepared, view, settings, control);
            int seen = 0, apart = 0;
            for (std::size_t i = 0; i < lit.hit.size(); ++i) {
                if (!lit.hit[i].valid()) continue;
                ++seen;
                const Rgb a = shown.radiance[i], b = lit.radiance[i];
                apart += max_component(a - b) > 1e-6f || max_component(b - a) > 1e-6f;
            }
            CAPTURE(static_cast<int>(shading));
            CHECK(seen > 6000);
            CHECK(apart == 0);
        }
    }

    TEST_CASE("flat: a triangle has one color; Gouraud and Phong agree where triangles are small") {
        const Scene coarse = varied_scene(12), fine = varied_scene(400);
        const View view = perspective();
        const Rendering flat = render(coarse, view, with_hits(raster::Shading::kFlat));
        int same = 0, pairs = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 1; x < view.width; ++x) {
                const Hit &a = flat.hit(x - 1, y), &b = flat.hit(x, y);
                if (!a.valid() || a.object != b.object || a.primitive != b.primitive ||
                    std::holds_alternative<Sphere>(coarse.shapes[coarse.objects[a.object].shape]))
                    continue;
                ++pairs;
                const Rgb difference = flat.radiance(x, y) - flat.radiance(x - 1, y);
                same += std::abs(difference.r) + std::abs(difference.g) + std::abs(difference.b) < 1e-5f;
            }
        CHECK(pairs > 20'000);
        CHECK(same == pairs);
        const auto mean_apart = [&](const Scene& scene) {
            const Rendering a = render(scene, view, with_hits(raster::Shading::kGouraud)),
                            b = render(scene, view, with_hits(raster::Shading::kPhong));
            double sum = 0;
            for (int y = 0; y < view.height; ++y)
                for (int x = 0; x < view.width; ++x) // the two smooth meshes
                    if (a.hit(x, y).valid() && a.hit(x, y).object < 2)
                        sum += std::abs(static_cast<double>(a.radiance(x, y).r - b.radiance(x, y).r));
            return sum;
        };
        const double far = mean_apart(coarse), near = mean_apart(fine);
        CHECK(near < far / 100);
        CHECK(near > 0); // the two implementations differ
    }

    TEST_CASE("wires: bright on an edge, black away from it, and a pixel wide") {
        Scene scene;
        Mesh mesh;
        mesh.positions = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(-1, 1, 0)};
        mesh.triangles = {{0, 1, 2}};
        add(scene, mesh, Mat4(), Diffuse{{Rgb(1.0f)}});
        finish_scene(scene);
        const View view{look_orthographic({0, 0, 4}, {0, 0, 0}, 3), 101, 101};
        const Rendering shown_image = render(scene, view, with_hits(raster::Shading::kWireframe));
        // Follow the column through x = −0.5, which crosses the lower edge and the hypotenuse. Each shows the half
        // pixel that is inside the triangle. Along the edge's normal that is 1/2 for the lower edge, and √2/2 in the
        // column for the edge at 45°.
        const int column = static_cast<int>((1.5 - 0.5) / 3 * 101);
        double sum = 0;
        int dark = 0;
        for (int y = 0; y < 101; ++y) {
            sum += static_cast<double>(shown_image.radiance(column, y).r);
            dark += shown_image.radiance(column, y).r == 0;
        }
        CHECK(dark >= 95);
        // Within the ramp's width samples hit 0, 1 or 2 of its steps. The coverage of the inner half is ½ + ⅛ of a
        // pixel by area.
        CHECK(sum > 0.5);
        CHECK(sum < 3);
        const double d = 101.0 / 3; // pixels per meter
        for (int y = 0; y < 101; ++y)
            for (int x = 0; x < 101; ++x) {
                const double px = (x + 0.5) / d - 1.5, py = 1.5 - (y + 0.5) / d; // in meters
                // This is the distance to the nearest edge, in pixels.
                const double inside = std::min({px + 1, py + 1, -(px + py) / std::sqrt(2.0)}) * d;
                if (std::abs(inside) < 0.02) continue;
                const double wanted = inside < 0 ? 0 : std::clamp(1 - inside, 0.0, 1.0);
                REQUIRE(static_cast<double>(shown_image.radiance(x, y).r) ==
                        doctest::Approx(wanted).epsilon(0.001).scale(1));
            }
    }

    TEST_CASE("toon: few colors, and no others but on borders") {
        Scene scene;
        add(scene, Sphere{Vec3(0, 0, 0), 1}, Mat4(), Diffuse{{Rgb(0.5f)}});
        scene.lights = {SunLight{normalize(Vec3(-0.5f, -1, -0.7f)), Rgb(3.0f)}};
        finish_scene(scene);
        const View view{look({0, 0, 4}, {0, 0, 0}, 35), 240, 240};
        const Rendering shown_image = render(scene, view, with_hits(raster::Shading::kToon));
        std::vector<float> values;
        for (std::size_t i = 0; i < shown_image.hit.size(); ++i)
            if (shown_image.hit[i].valid()) values.push_back(shown_image.radiance[i].r);
        std::sort(values.begin(), values.end());
        std::vector<float> bands; // values that at least a hundred samples share
        for (std::size_t i = 0; i + 100 < values.size(); ++i)
            if (values[i + 100] - values[i] < 1e-5f && (bands.empty() || values[i] - bands.back() > 1e-4f))
                bands.push_back(values[i]);
        const auto between = std::count_if(values.begin(), values.end(), [&](float v) {
            return std::none_of(bands.begin(), bands.end(), [&](float b) { return std::abs(v - b) < 1e-3f; });
        });
        CHECK(bands.size() == 6); // zero to four quarters of the light, and the highlight
        for (std::size_t k = 1; k < 5; ++k)
            CHECK(static_cast<double>(bands[k] - bands[k - 1]) ==
                  doctest::Approx(0.5 / kPiDouble * 3 / 4).epsilon(1e-4));
        CHECK(values.size() > 20'000);
        CHECK(between < static_cast<std::ptrdiff_t>(values.size()) / 20);
    }
}
