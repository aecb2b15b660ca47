// These tests compare glass in gbuffer space with exact refracted rays.
#include "tests/raster/scenes.h"

#include "common/image/bitwise_equal.h"
#include "common/material/fresnel.h"
#include "raster/gbuffer/screen_gbuffer.h"
#include "raster/screen_space/screen_space_refraction.h"
#include "raster/shading/light_components.h"
#include "raytrace/render.h"

#include <doctest/doctest.h>

#include <array>
#include <filesystem>

using namespace duet;
using namespace duet::test;

namespace {

const View kView{look({0, 0, 5}, {0, 0, 0}, 40), 160, 120};
constexpr double kWallZ = -4;
constexpr float kIor = 1.5f;

/// Returns a wall that reflects all light of a gray sky, red on the left and green on the right.
Scene wall() {
    Scene scene;
    const auto z = static_cast<float>(kWallZ);
    add(scene, QuadList{{{Vec3(-9, -6, z), Vec3(9, 0, 0), Vec3(0, 12, 0)}}}, Mat4(), Diffuse{{Rgb(1, 0, 0)}});
    add(scene, QuadList{{{Vec3(0, -6, z), Vec3(9, 0, 0), Vec3(0, 12, 0)}}}, Mat4(), Diffuse{{Rgb(0, 1, 0)}});
    scene.environment = ConstantEnvironment{Rgb(0.5f)};
    return scene;
}

/// Returns a unit sphere as a triangle mesh with vertex normals.
Mesh round_mesh(int around, int down) {
    Mesh mesh;
    for (int k = 0; k <= down; ++k)
        for (int i = 0; i <= around; ++i) {
            const double v = kPiDouble * k / down, u = 2 * kPiDouble * (i % around) / around;
            mesh.positions.push_back(Vec3(Vec3d(std::sin(v) * std::cos(u), std::cos(v), -std::sin(v) * std::sin(u))));
        }
    mesh.normals = mesh.positions;
    const auto vertex = [&](int i, int k) { return static_cast<std::uint32_t>(k * (around + 1) + i); };
    for (int k = 0; k < down; ++k)
        for (int i = 0; i < around; ++i) {
            if (k > 0) mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k + 1), vertex(i + 1, k)});
            if (k + 1 < down) mesh.triangles.push_back({vertex(i, k), vertex(i, k + 1), vertex(i + 1, k + 1)});
        }
    return mesh;
}

/// Returns a cube of quads around the origin with half side length `half`.
QuadList block(float half) {
    QuadList box;
    for (const float side : {-half, half})
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Vec3 corner(-half, -half, -half), u, v;
            corner[axis] = side;
            u[(axis + (side > 0 ? 1u : 2u)) % 3] = v[(axis + (side > 0 ? 2u : 1u)) % 3] = 2 * half;
            box.quads.push_back({corner, u, v});
        }
    return box;
}

/// Traces a ray through a unit sphere at the origin to the wall. Returns the hit point and the fraction reflected at
/// the front. Returns false for rays that miss the sphere or pass too close to its silhouette.
bool through_ball(const View& view, int x, int y, Vec3d& met, double& reflected) {
    const Rayd ray = CameraModel(view).pinhole().ray({x + 0.5, y + 0.5});
    const double b = dot(ray.origin, ray.direction), c = dot(ray.origin, ray.origin) - 1;
    if (b * b - c < 0.55) return false; // so close to the silhouette that it reflects the wall, too
    const Vec3d p = ray.at(-b - std::sqrt(b * b - c));
    const double eta = static_cast<double>(kIor), cosine = -dot(p, ray.direction);
    const double inner = std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
    const Vec3d way = ray.direction / eta + p * (cosine / eta - inner), q = p - way * (2 * dot(p, way));
    const Vec3d out = way * eta + q * (cosine - eta * inner); // the two angles swap by symmetry
    reflected = static_cast<double>(fresnel_dielectric(static_cast<float>(cosine), kIor));
    if (!(out.z < 0)) return false;
    met = q + out * ((kWallZ - q.z) / out.z);
    return std::abs(met.x) < 2.5 && std::abs(met.y) < 1.8; // within the image
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a ball of glass, and one of triangles, show what refracted rays meet: left and right change places") {
        View parallel = kView;
        parallel.camera.projection = Camera::Projection::kOrthographic;
        parallel.camera.height = 3.6;
        raster::RasterSettings four = plain();
        four.multisamples = 4;
        const std::array<std::pair<View, raster::RasterSettings>, 3> ways{
            {{kView, plain()}, {kView, four}, {parallel, plain()}}};
        for (const bool triangles : {false, true})
            for (const auto& way : ways) {
                const View& view = way.first;
                const raster::RasterSettings& settings = way.second;
                CAPTURE(triangles);
                CAPTURE(settings.multisamples);
                CAPTURE(static_cast<int>(view.camera.projection));
                Scene scene = wall();
                add(scene, triangles ? Shape(round_mesh(96, 48)) : Shape(Sphere{Vec3(0, 0, 0), 1}), Mat4(),
                    Dielectric{kIor});
                finish_scene(scene);
                const ImageRgb found = render(scene, view, settings).radiance;
                int swapped = 0, all = 0, wrong = 0;
                for (int y = 0; y < view.height; ++y)
                    for (int x = 0; x < view.width; ++x) {
                        Vec3d met;
                        double reflected = 0;
                        if (!through_ball(view, x, y, met, reflected) || std::abs(met.x) < 0.1) continue;
                        const float color = static_cast<float>(0.5 * (1 - reflected)),
                                    sky = static_cast<float>(0.5 * reflected);
                        const Rgb expected = met.x < 0 ? Rgb(color + sky, sky, sky) : Rgb(sky, color + sky, sky);
                        ++all;
                        swapped += (x < view.width / 2) == (met.x > 0);
                        for (std::size_t c = 0; c < 3; ++c)
                            if (std::abs(found(x, y)[c] - expected[c]) > 0.02f) {
                                ++wrong;
                                break;
                            }
                    }
                CHECK(all > 200);
                CHECK(swapped > all / 2);
                CHECK(wrong * 50 < all);
            }
    }

    TEST_CASE("glass is seen through glass: by a pane a wall, another pane before it, and a ball") {
        const Dielectric thin{.ior = kIor, .thin = true};
        const auto pane = [](float z) { return QuadList{{{Vec3(-1.5f, -1.5f, z), Vec3(3, 0, 0), Vec3(0, 3, 0)}}}; };
        for (const int behind : {0, 1, 2}) { // a pane, a sphere, a triangle-mesh sphere
            CAPTURE(behind);
            std::array<ImageRgb, 2> pictures; // without and with the pane in front
            for (const bool front : {false, true}) {
                Scene scene = wall();
                if (behind == 0) add(scene, pane(0), Mat4(), thin);
                const Shape ball = behind == 1 ? Shape(Sphere{Vec3(0, 0, 0), 1}) : Shape(round_mesh(96, 48));
                if (behind > 0) add(scene, ball, Mat4(), Dielectric{kIor});
                if (front) add(scene, pane(2), Mat4(), thin);
                finish_scene(scene);
                pictures[front] = render(scene, kView, plain()).radiance;
            }
            int wrong = 0, all = 0;
            for (int y = 40; y < 80; ++y)
                for (int x = 60; x < 100; ++x) {
                    const Rayd ray = CameraModel(kView).pinhole().ray({x + 0.5, y + 0.5});
                    const ThinDielectricBsdf::Fractions fractions =
                        ThinDielectricBsdf{kIor, Rgb(1.0f)}.fractions(static_cast<float>(-ray.direction.z));
                    const Rgb expected = pictures[0](x, y) * fractions.transmitted + Rgb(0.5f) * fractions.reflected;
                    ++all;
                    for (std::size_t c = 0; c < 3; ++c)
                        if (std::abs(pictures[1](x, y)[c] - expected[c]) > 0.01f) {
                            ++wrong;
                            break;
                        }
                }
            CHECK(wrong * 50 < all); // where G-buffer samples of neighboring pixels differ
        }
    }

    TEST_CASE("a block that a pane covers in part is seen under it as if the pane covered all") {
        std::array<ImageRgb, 2> pictures; // half the pane and the whole pane
        for (const bool whole : {false, true}) {
            Scene scene = wall();
            add(scene, block(0.8f), rotation(Vec3(1, 0, 0), 0.26f) * rotation(Vec3(0, 1, 0), 0.52f), Dielectric{kIor});
            const Quad front{Vec3(-1.5f, -1.5f, 2), Vec3(whole ? 3.0f : 1.5f, 0, 0), Vec3(0, 3, 0)};
            add(scene, QuadList{{front}}, Mat4(), Dielectric{.ior = kIor, .thin = true});
            finish_scene(scene);
            pictures[whole] = render(scene, kView, plain()).radiance;
        }
        int wrong = 0, all = 0;
        for (int y = 30; y < 90; ++y)
            for (int x = 45; x < 77; ++x) { // up to three pixels from the pane's edge
                const Rgb difference = pictures[0](x, y) - pictures[1](x, y);
                ++all;
                wrong += std::max({std::abs(difference.r), std::abs(difference.g), std::abs(difference.b)}) > 0.02f;
            }
        CAPTURE(wrong);
        CHECK(wrong * 50 < all); // where the visible surface itself contains the edge
    }

    TEST_CASE("panes in a row: each dims what is behind it, kMaxGlassDepth of them, and those farther back not") {
        for (int panes = 0; panes <= raster::kMaxGlassDepth + 1; ++panes) {
            CAPTURE(panes);
            Scene scene;
            add(scene, QuadList{{{Vec3(-9, -6, static_cast<float>(kWallZ)), Vec3(18, 0, 0), Vec3(0, 12, 0)}}}, Mat4(),
                Emissive{Rgb(1.0f)});
            const Dielectric tinted{.ior = kIor, .tint = {Rgb(0.5f)}, .thin = true};
            for (int i = 0; i < panes; ++i) {
                const Vec3 corner(-1.5f, -1.5f, 2 - 0.5f * static_cast<float>(i));
                add(scene, QuadList{{{corner, Vec3(3, 0, 0), Vec3(0, 3, 0)}}}, Mat4(), tinted);
            }
            finish_scene(scene);
            const float once = ThinDielectricBsdf{kIor, Rgb(0.5f)}.fractions(1).transmitted.r;
            const float expected = std::pow(once, static_cast<float>(std::min(panes, raster::kMaxGlassDepth)));
            CHECK(render(scene, kView, plain()).radiance(80, 60).r == doctest::Approx(expected).epsilon(0.005));
        }
    }

    TEST_CASE("glass that moves before a lens, beside glass: as the path tracer on the mean of blocks, the same bits for any number "
              "of threads") {
        Scene scene;
        const auto z = static_cast<float>(kWallZ);
        add(scene, QuadList{{{Vec3(-9, -6, z), Vec3(9, 0, 0), Vec3(0, 12, 0)}}}, Mat4(), Emissive{Rgb(1, 0.2f, 0.2f)});
        add(scene, QuadList{{{Vec3(0, -6, z), Vec3(9, 0, 0), Vec3(0, 12, 0)}}}, Mat4(), Emissive{Rgb(0.2f, 1, 0.2f)});
        add(scene, QuadList{{{Vec3(-1.5f, -1.5f, 1.5f), Vec3(1.5f, 0, 0), Vec3(0, 3, 0)}}}, Mat4(),
            Dielectric{.ior = kIor, .thin = true});
        Object& ball = add(scene, Sphere{Vec3(0, 0, 0), 1}, translation(Vec3(-0.3f, 0, 0)), Dielectric{kIor});
        ball.to_world_end = Mat4(translation(Vec3(0.3f, 0, 0)));
        ball.moving = true;
        scene.environment = ConstantEnvironment{Rgb(0.5f)};
        scene.camera = kView.camera;
        scene.camera.aperture_radius = 0.05, scene.camera.focus_distance = 5, scene.camera.shutter_close = 1;
        finish_scene(scene);
        const View view{scene.camera, kView.width, kView.height};
        raster::RasterSettings settings = plain();
        settings.samples_per_pixel = 16;
        settings.threads = 1;
        const ImageRgb found = render(scene, view, settings).radiance;
        for (const int threads : {2, 7}) {
            settings.threads = threads;
            CHECK(bitwise_equal(found, render(scene, view, settings).radiance));
        }
        raytrace::PathTracerSettings traced;
        Control control;
        const ImageRgb truth = raytrace::render(raytrace::prepare(scene, traced), view, traced, control).radiance;
        constexpr int kBlock = 8;
        int wrong = 0, blocks = 0;
        for (int y0 = 0; y0 + kBlock <= view.height; y0 += kBlock)
            for (int x0 = 0; x0 + kBlock <= view.width; x0 += kBlock) {
                Rgb difference;
                for (int i = 0; i < kBlock * kBlock; ++i)
                    difference += found(x0 + i % kBlock, y0 + i / kBlock) - truth(x0 + i % kBlock, y0 + i / kBlock);
                ++blocks;
                wrong += std::max(std::abs(difference.r), std::abs(difference.g)) > 0.08f * kBlock * kBlock;
            }
        CHECK(blocks == 300);
        CHECK(wrong < 12); // at the sphere's silhouette, where light is reflected internally
    }

    TEST_CASE("a pane shows the wall straight behind it, as dimmed as its closed form says, and mirrors the sky") {
        Scene scene = wall();
        add(scene, QuadList{{{Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)}}}, Mat4(),
            Dielectric{.ior = kIor, .thin = true});
        finish_scene(scene);
        const ImageRgb found = render(scene, kView, plain()).radiance;
        for (const int x : {66, 75, 85, 94}) {
            const Rayd ray = CameraModel(kView).pinhole().ray({x + 0.5, 70.5});
            const ThinDielectricBsdf::Fractions fractions =
                ThinDielectricBsdf{kIor, Rgb(1.0f)}.fractions(static_cast<float>(-ray.direction.z));
            const float wall = 0.5f * fractions.transmitted.r, sky = 0.5f * fractions.reflected.r;
            CHECK(found(x, 70).r == doctest::Approx(x < 80 ? wall + sky : sky).epsilon(0.002));
            CHECK(found(x, 70).g == doctest::Approx(x < 80 ? sky : wall + sky).epsilon(0.002));
        }
    }

    TEST_CASE("a ball that absorbs shows what is behind it by what the way through leaves") {
        Scene scene = wall();
        Dielectric glass{kIor};
        glass.absorption = Rgb(0.2f, 0.7f, 1.0f);
        add(scene, Sphere{Vec3(0, 0, 0), 1}, Mat4(), glass);
        finish_scene(scene);
        const Rgb found = render(scene, View{kView.camera, 161, 121}, plain()).radiance(108, 60);
        const Rayd ray = CameraModel(View{kView.camera, 161, 121}).pinhole().ray({108.5, 60.5});
        const double b = dot(ray.origin, ray.direction);
        const Vec3d p = ray.at(-b - std::sqrt(b * b - dot(ray.origin, ray.origin) + 1));
        const double cosine = -dot(p, ray.direction), eta = static_cast<double>(kIor);
        const auto way = static_cast<float>(2 * std::sqrt(1 - (1 - cosine * cosine) / (eta * eta)));
        const float reflected = fresnel_dielectric(static_cast<float>(cosine), kIor);
        CHECK(found.r ==
              doctest::Approx(0.5f * reflected + 0.5f * (1 - reflected) * std::exp(-way * 0.2f)).epsilon(0.02));
        CHECK(found.g == doctest::Approx(0.5f * reflected).epsilon(0.05));
    }

    TEST_CASE("glass mirrors a lamp that the picture does not show, and not through what stands before it") {
        for (const bool screened : {false, true}) {
            Scene scene = wall();
            add(scene, QuadList{{{Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)}}}, Mat4(),
                Dielectric{.ior = kIor, .thin = true});
            // The light is behind the eye.
            add(scene, QuadList{{{Vec3(-1, -1, 9), Vec3(0, 2, 0), Vec3(2, 0, 0)}}}, Mat4(), Emissive{Rgb(40.0f)});
            if (screened) add(scene, QuadList{{{Vec3(-1, -1, 8), Vec3(2, 0, 0), Vec3(0, 2, 0)}}});
            finish_scene(scene);
            scene.environment = ConstantEnvironment{Rgb(0.0f)};
            raster::RasterSettings settings = plain();
            settings.components.direct = false;
            const Rgb found = render(scene, kView, settings).radiance(82, 62);
            const float mirrored = 40 * ThinDielectricBsdf{kIor, Rgb(1.0f)}.fractions(1).reflected.b;
            CHECK(found.b == doctest::Approx(screened ? 0.0f : mirrored).epsilon(0.02));
        }
    }

    TEST_CASE("a ball shows a lamp beside the picture, refracted, and not through what stands before that") {
        for (const bool screened : {false, true}) {
            Scene scene;
            add(scene, Sphere{{0, 0, 0}, 1}, Mat4(), Dielectric{kIor});
            add(scene, QuadList{{{Vec3(-6, -3, -2), Vec3(0, 0, -4), Vec3(0, 6, 0)}}}, Mat4(),
                Emissive{Rgb(8.0f), true});
            if (screened)
                add(scene, QuadList{{{Vec3(-4, -6, 2), Vec3(0, 0, -12), Vec3(0, 12, 0)}}}, Mat4(),
                    Diffuse{{Rgb(0.0f)}});
            finish_scene(scene);
            scene.environment = ConstantEnvironment{Rgb(0.0f)};
            const View narrow{look({0, 0, 5}, {0, 0, 0}, 30), 64, 64};
            const ImageRgb found = render(scene, narrow, plain()).radiance;
            const auto bright = std::count_if(found.begin(), found.end(), [](Rgb c) { return c.g > 2; });
            if (screened)
                CHECK(bright == 0); // except where shadow maps blur or light is reflected
            else
                CHECK(bright > 20);
        }
    }

    TEST_CASE("turned off, or where there is no glass, no picture without it is made") {
        for (const bool glass : {false, true})
            for (const bool on : {false, true}) {
                Scene scene = wall();
                add(scene, Sphere{Vec3(0, 0, 0), 1}, Mat4(), glass ? Material(Dielectric{kIor}) : Material(Diffuse{}));
                finish_scene(scene);
                raster::RasterSettings settings; // ambient occlusion needs the rest of the G-buffer
                settings.screen_refractions = on;
                const auto gbuffer = raster::make_screen_gbuffer(raster::prepare(scene, settings), kView, settings);
                REQUIRE(gbuffer != nullptr);
                CHECK((gbuffer->behind() != nullptr) == (glass && on));
            }
    }

    TEST_CASE("the looks at the picture with and without glass count as memory") {
        Scene scene = wall();
        add(scene, Sphere{Vec3(0, 0, 0), 1}, Mat4(), Dielectric{kIor});
        finish_scene(scene);
        const auto bytes = [&](bool looks) {
            raster::RasterSettings settings = plain();
            settings.screen_refractions = looks;
            return render(scene, kView, settings).statistics.memory_bytes;
        };
        // Each pixel stores depth, normal, curvature (`turns`), thickness, key, object, whether it is a light, and
        // radiance with and without lights.
        constexpr std::int64_t kLook = 4 + 12 + 4 + 4 + 4 + 4 + 1 + 12 + 12;
        CHECK(bytes(true) - bytes(false) >= 2 * kLook * kView.width * kView.height);
    }

    TEST_CASE("normals by maps are the same in the normal shading, in strips and one by one, as in the normal picture") {
        const Scene scene = load_scene(std::filesystem::path(DUET_SOURCE_DIR) / "models" / "maps.json");
        const View view{scene.camera, 160, 120};
        raster::RasterSettings settings;
        settings.aovs.normal = settings.aovs.hit = true;
        settings.shading = raster::Shading::kNormal;
        const Rendering found = render(scene, view, settings);
        int bent = 0;
        float worst = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const Hit& hit = found.hit(x, y);
                // Compare only the floor and the amphora, where nothing occludes them.
                if (!hit.valid() || hit.object > 1 || x > 80) continue;
                const Vec3 n = found.normal(x, y);
                bent += hit.object == 0 && n.y < 0.999f;
                for (std::size_t c = 0; c < 3; ++c)
                    worst = std::max(worst, std::abs(found.radiance(x, y)[c] - (n[c] + 1) / 2));
            }
        CHECK(bent > 100);
        CHECK(worst < 2e-5f);
    }
}
