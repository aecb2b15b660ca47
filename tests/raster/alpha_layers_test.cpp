// These tests check lists of transparent hits in front of the opaque image.
#include "tests/raster/scenes.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

QuadList square(float z) { return {{Quad{{-1, -1, z}, {2, 0, 0}, {0, 2, 0}}}}; }

/// Makes the last object's material partly transparent.
void make_translucent(Scene& scene, float opacity) {
    scene.maps.resize(scene.materials.size());
    scene.maps.back().opacity = opacity;
}

raster::RasterSettings albedo(int samples = 1) {
    raster::RasterSettings settings;
    settings.shading = raster::Shading::kAlbedo;
    settings.samples_per_pixel = samples;
    settings.aovs.hit = settings.aovs.albedo = true;
    return settings;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("layers of any number are blended from the front, in whatever order they come") {
        for (const int count : {1, 3, 8, 9, 30}) { // lists hold 8 hits at a time
            Scene scene;
            scene.camera = look({0, 0, 5}, {0, 0, 0});
            double through = 1, expected = 0;
            std::vector<int> order;
            for (int i = 0; i < count; ++i) order.push_back(i * 7 % count); // 7 and the counts are coprime
            for (const int i : order) {
                add(scene, square(-0.1f * static_cast<float>(i)), Mat4(),
                    Diffuse{{Rgb(static_cast<float>(i % 4) / 4)}});
                make_translucent(scene, 0.2f);
            }
            add(scene, square(-5), Mat4(), Diffuse{{Rgb(1.0f)}});
            for (int i = 0; i < count; ++i) {
                expected += through * 0.2 * (i % 4) / 4;
                through *= 0.8;
            }
            expected += through;
            finish_scene(scene);
            for (const int samples : {1, 4}) {
                const Rendering shown_image = render(scene, {scene.camera, 9, 9}, albedo(samples));
                CHECK(shown_image.radiance(4, 4).g == doctest::Approx(expected).epsilon(1e-5));
                CHECK(shown_image.albedo(4, 4).g == doctest::Approx(expected).epsilon(1e-5));
                CHECK(shown_image.hit(4, 4).valid());
            }
        }
    }

    TEST_CASE("what is whole among layers hides the rest, and layers behind the opaque image do not show") {
        Scene scene;
        scene.camera = look({0, 0, 5}, {0, 0, 0});
        add(scene, square(0.5f), Mat4(), Diffuse{{Rgb(0.0f)}});
        make_translucent(scene, 0.5f);
        add(scene, square(0), Mat4(), Diffuse{{Rgb(1.0f)}});
        add(scene, square(-1), Mat4(), Diffuse{{Rgb(0.3f)}});
        make_translucent(scene, 0.9f);
        finish_scene(scene);
        CHECK(render(scene, {scene.camera, 9, 9}, albedo()).radiance(4, 4).g == doctest::Approx(0.5));
    }

    TEST_CASE(
        "a sheet leaves the bits of tiles that it does not touch as they are, in every shading that has a program") {
        const auto shown_image = [](bool with_translucent, raster::Shading shading) {
            Scene scene;
            scene.camera = look({0, 1, 5}, {0, 0, 0});
            add(scene, QuadList{{Quad{{-30, -1, 3}, {60, 0.5f, 0}, {0, 0, -60}}}}, Mat4(),
                Diffuse{{Rgb(0.3f, 0.5f, 0.7f)}});
            scene.lights.push_back(PointLight{Vec3(1, 4, 2), Rgb(30.0f)});
            add(scene, QuadList{{Quad{{-1.2f, -0.5f, 0}, {0.4f, 0, 0}, {0, 0.4f, 0}}}}, Mat4(), Diffuse{{Rgb(1.0f)}});
            if (with_translucent) make_translucent(scene, 0.5f);
            finish_scene(scene);
            raster::RasterSettings settings;
            settings.shading = shading;
            return render(scene, {scene.camera, 256, 128}, settings);
        };
        for (const raster::Shading shading :
             {raster::Shading::kPhong, raster::Shading::kGouraud, raster::Shading::kToon}) {
            const Rendering whole = shown_image(false, shading), with_translucent = shown_image(true, shading);
            int apart_beside = 0, apart_under = 0, lit = 0;
            for (int y = 0; y < 128; ++y)
                for (int x = 0; x < 256; ++x) {
                    const Rgb a = whole.radiance(x, y), b = with_translucent.radiance(x, y);
                    (x < 128 ? apart_under : apart_beside) += a.r != b.r || a.g != b.g || a.b != b.b;
                    lit += x >= 128 && max_component(a) > 1e-4f; // Gouraud shading: light from distant vertices
                }
            CHECK(apart_beside == 0);
            CHECK(apart_under > 100);
            CHECK(lit > 5'000);
        }
    }

    TEST_CASE("holes show what exact rays see: halves of a square, a ball's inside") {
        Scene scene;
        scene.camera = look({0.3, 0.4, 5}, {0, 0, 0}, 30);
        ImageRgb halves(64, 1);
        for (int x = 0; x < 64; ++x) halves(x, 0) = Rgb(x < 32 ? 0.0f : 1.0f);
        scene.textures = {{ImageTexture{0, {1, 1}, TextureFilter::kNearest}}, {halves}};
        add(scene, square(0));
        add(scene, Sphere{{0, 0, -0.9f}, 0.6f});
        scene.maps.resize(2);
        scene.maps[0].opacity = scene.maps[1].opacity = {1, 0};
        add(scene, square(-2));
        add(scene, torus(40, 20, 0.8, 0.2));
        scene.maps.resize(4);
        scene.maps[3].opacity = {1, 0}; // opacity from each triangle's own u coordinate
        finish_scene(scene);
        const View view{scene.camera, 120, 90};
        const Rendering shown_image = render(scene, view, hits_only());
        const CameraModel camera(view);
        int wrong = 0, through = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const Hit& hit = shown_image.hit(x, y);
                if (!hit.valid()) continue;
                const Ray ray = camera.ray({x + 0.5, y + 0.5});
                wrong += hit.object != 2 && opacity(scene, ray, hit) != 1;
                through += hit.object == 2 || (hit.object == 1 && hit.t > 5.9f);
            }
        CHECK(wrong == 0);
        CHECK(through > 500);
    }
}
