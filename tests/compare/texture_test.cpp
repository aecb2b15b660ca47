// These tests check textures, maps and alpha masks in both pipelines: equal footprints, normals and hits, and each
// filter's error.
#include "common/camera/pixel_footprint.h"
#include "raster/render.h"
#include "raytrace/render.h"
#include "tests/raster/scenes.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;

namespace {

/// Returns a plane that extends to the horizon, viewed at a slant. Its checkerboard has squares of a quarter of an
/// image of `size`² texels.
Scene slanted_checker(TextureFilter filter, int size = 100, double shift = 0) {
    Scene scene;
    ImageRgb checker(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) checker(x, y) = Rgb((4 * x / size + 4 * y / size) % 2 ? 0.9f : 0.1f);
    scene.textures = {{ImageTexture{0, {400, 400}, filter}}, {checker}};
    Diffuse material;
    material.albedo = {Rgb(1.0f), 0};
    test::add(scene, QuadList{{Quad{{-400, 0, 400}, {800, 0, 0}, {0, 0, -800}}}}, Mat4(), material);
    scene.camera = test::look({shift, 1, 0}, {0.35 + shift, 0.75, -2}, 50);
    finish_scene(scene);
    return scene;
}

View view_of(const Scene& scene) { return {scene.camera, 192, 108}; }

ImageRgb raster_albedo(const Scene& scene, int samples = 1) {
    raster::RasterSettings settings;
    settings.shading = raster::Shading::kAlbedo;
    settings.samples_per_pixel = samples;
    return test::render(scene, view_of(scene), settings).radiance;
}

ImageRgb raytrace_image(const Scene& scene, raytrace::Integrator integrator, SamplerKind sampler, int samples) {
    raytrace::PathTracerSettings settings;
    settings.integrator = integrator;
    settings.sampler = sampler;
    settings.samples_per_pixel = samples;
    Control control;
    return raytrace::render(raytrace::prepare(scene, settings), view_of(scene), settings, control).radiance;
}

/// Returns the root mean square difference below the rows of the horizon.
double error(const ImageRgb& a, const ImageRgb& b) {
    double sum = 0;
    int count = 0;
    for (int y = 44; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x, ++count) {
            const double d = static_cast<double>(a(x, y).g) - static_cast<double>(b(x, y).g);
            sum += d * d;
        }
    return std::sqrt(sum / count);
}

/// Returns how much pixels change while the camera moves sideways by one texel (2 cm) per step, ten times. The value
/// is the mean standard deviation of the pixels near the horizon, where the exact image hardly changes.
double shimmer(TextureFilter filter, int samples = 1) {
    constexpr int kSteps = 10;
    std::vector<ImageRgb> frames;
    for (int i = 0; i < kSteps; ++i) frames.push_back(raster_albedo(slanted_checker(filter, 100, 0.02 * i), samples));
    double sum = 0;
    int count = 0;
    for (int y = 44; y < 50; ++y)
        for (int x = 0; x < frames[0].width(); ++x, ++count) {
            double mean = 0, squares = 0;
            for (const ImageRgb& frame : frames) mean += static_cast<double>(frame(x, y).g) / kSteps;
            for (const ImageRgb& frame : frames) squares += sqr(static_cast<double>(frame(x, y).g) - mean) / kSteps;
            sum += std::sqrt(squares);
        }
    return sum / count;
}

} // namespace

TEST_SUITE("image") {

    TEST_CASE("a slanted plane to the horizon: filters against the truth, integrated over pixels") {
        const ImageRgb truth = raytrace_image(slanted_checker(TextureFilter::kBilinear), raytrace::Integrator::kAlbedo,
                                              SamplerKind::kSobol, 1024);
        const auto error_of = [&](TextureFilter filter) {
            return error(raster_albedo(slanted_checker(filter)), truth);
        };
        const double bilinear = error_of(TextureFilter::kBilinear), trilinear = error_of(TextureFilter::kTrilinear),
                     anisotropic = error_of(TextureFilter::kAnisotropic);
        MESSAGE("error of nearest ", error_of(TextureFilter::kNearest), ", bilinear ", bilinear, ", trilinear ",
                trilinear, ", anisotropic ", anisotropic);
        CHECK(anisotropic < 0.025);
        CHECK(anisotropic < 0.4 * trilinear);
        CHECK(trilinear < 0.7 * bilinear);
        // More samples with smaller footprints must converge to the reference.
        CHECK(error(raster_albedo(slanted_checker(TextureFilter::kAnisotropic), 64), truth) < 0.0035);
    }

    TEST_CASE("filtered textures do not shimmer") {
        const double bilinear = shimmer(TextureFilter::kBilinear), anisotropic = shimmer(TextureFilter::kAnisotropic),
                     truth = shimmer(TextureFilter::kAnisotropic, 64);
        MESSAGE("change of bilinear ", bilinear, ", anisotropic ", anisotropic, ", the truth ", truth);
        CHECK(bilinear > 0.1); // otherwise the test covers nothing
        CHECK(anisotropic < truth + 0.01);
    }

    TEST_CASE("both pipelines filter alike at what the camera sees") {
        for (const TextureFilter filter : {TextureFilter::kTrilinear, TextureFilter::kAnisotropic}) {
            const Scene scene = slanted_checker(filter);
            const ImageRgb drawn = raster_albedo(scene),
                           traced = raytrace_image(scene, raytrace::Integrator::kAlbedo, SamplerKind::kCenter, 1);
            int far = 0;
            for (std::size_t i = 0; i < drawn.size(); ++i) far += std::abs(drawn[i].g - traced[i].g) > 5e-3f;
            CHECK(far <= static_cast<int>(drawn.size()) / 1000); // pixels on the horizon
        }
    }

    TEST_CASE("a map on a sphere is a globe seen from outside: west on the left, north above") {
        Scene scene;
        const Rgb red(0.8f, 0.1f, 0.1f), green(0.1f, 0.8f, 0.1f), blue(0.1f, 0.1f, 0.8f), yellow(0.8f, 0.8f, 0.1f);
        ImageRgb map(4, 2, Rgb(0.0f)); // black at the back; row 0 is the top row
        map(1, 0) = red, map(2, 0) = green, map(1, 1) = blue, map(2, 1) = yellow;
        scene.textures = {{ImageTexture{0, {1, 1}, TextureFilter::kNearest}}, {map}};
        Diffuse material;
        material.albedo = {Rgb(1.0f), 0};
        test::add(scene, Sphere{{0, 0, 0}, 1}, Mat4(), material);
        scene.camera = test::look({0, 0, 6}, {0, 0, 0}, 20); // half of the sphere is visible: u from 1/4 to 3/4
        finish_scene(scene);
        for (const ImageRgb& image :
             {raster_albedo(scene), raytrace_image(scene, raytrace::Integrator::kAlbedo, SamplerKind::kCenter, 1)}) {
            const auto shows = [&](int x, int y, Rgb color) {
                return max_component(image(x, y) - color) < 1e-3f && max_component(color - image(x, y)) < 1e-3f;
            };
            CHECK(shows(81, 39, red));
            CHECK(shows(110, 39, green));
            CHECK(shows(81, 68, blue));
            CHECK(shows(110, 68, yellow));
        }
    }

    TEST_CASE("footprints are the differences of neighbors' coordinates") {
        const auto check = [](const Shape& shape, double tolerance) {
            Scene scene;
            test::add(scene, shape);
            scene.camera = test::look({0.4, 0.7, 3}, {0, 0, 0}, 30);
            finish_scene(scene);
            const View view{scene.camera, 4000, 4000}; // so fine that steps approximate differentials
            const CameraModel camera(view);
            const PixelFootprint pixel(camera.pinhole(), 1);
            raytrace::PathTracerSettings settings;
            const raytrace::PathTracerScene prepared = raytrace::prepare(scene, settings);
            int tested = 0;
            for (int i = 0; i < 400; ++i) {
                const Vec2d at{1000.5 + 97 * (i % 20), 1000.5 + 103 * (i / 20)};
                const auto seen = [&](Vec2d where) {
                    const Ray ray = camera.ray(where);
                    const Hit hit = trace(prepared, ray);
                    return std::pair(hit, hit.valid() ? surface_point(scene, ray, hit) : SurfacePoint{});
                };
                const auto [hit, point] = seen(at);
                const auto [hit_x, right] = seen(at + Vec2d(1, 0));
                const auto [hit_y, below] = seen(at + Vec2d(0, 1));
                const bool same = hit.valid() && hit_x.valid() && hit_y.valid() && hit.primitive == hit_x.primitive &&
                                  hit.primitive == hit_y.primitive;
                const Ray ray = camera.ray(at);
                if (!same || std::abs(dot(point.ng, ray.direction)) < 0.2f || std::abs(point.uv.x - 0.5f) > 0.49f)
                    continue;
                SurfacePoint with = point;
                set_footprint(pixel.at(ray, hit.t), ray.direction, with);
                const Vec2 dx = right.uv - point.uv, dy = below.uv - point.uv;
                const double size = static_cast<double>(std::sqrt(dot(dx, dx) + dot(dy, dy)));
                const Vec2 ex = with.duv_dx - dx, ey = with.duv_dy - dy;
                CHECK(static_cast<double>(std::sqrt(dot(ex, ex) + dot(ey, ey))) < tolerance * size);
                ++tested;
            }
            CHECK(tested > 50);
        };
        check(QuadList{{Quad{{-1, -1, 0}, {2, 0.3f, 0.5f}, {0.2f, 2, -0.6f}}}}, 0.01);
        check(test::torus(12, 8), 0.01);
        check(Sphere{{0, 0, 0}, 0.8f}, 0.02);
    }

    TEST_CASE("both pipelines see the same normals and the same holes") {
        Scene scene;
        ImageRgb bumps(32, 32), disc(32, 32);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x) {
                const double a = 2 * kPiDouble * x / 32, b = 2 * kPiDouble * y / 32;
                bumps(x, y) = {static_cast<float>(0.5 + 0.3 * std::sin(a)), static_cast<float>(0.5 + 0.3 * std::sin(b)),
                               0.9f};
                disc(x, y) = Rgb(std::hypot(x - 15.5, y - 15.5) < 11 ? 1.0f : 0.0f);
            }
        scene.textures = {{ImageTexture{0, {3, 3}}, ImageTexture{1, {4, 2}}}, {bumps, disc}};
        test::add(scene, QuadList{{Quad{{-2, -1, 1}, {4, 0, 0}, {0, 0, -4}}}});
        test::add(scene, Sphere{{-0.7f, 0, 0}, 0.7f});
        test::add(scene, Sphere{{0.8f, 0, 0}, 0.7f});
        test::add(scene, QuadList{{Quad{{-1.5f, -0.8f, 0.9f}, {2, 0, 0.4f}, {0, 1.2f, 0}}}});
        test::add(scene, QuadList{{Quad{{-0.4f, -0.6f, 1.2f}, {1.3f, 0, 0}, {0, 1, 0}}}});
        scene.maps.resize(5);
        scene.maps[4].opacity = 0.5f;
        scene.maps[0].normal = scene.maps[1].normal = 0;
        scene.maps[2].bump = 1;
        scene.maps[2].bump_scale = 0.05f;
        scene.maps[3].opacity = {1, 1};
        scene.maps[3].cutoff = 0.5f;
        scene.camera = test::look({0.2, 0.8, 4}, {0, 0, 0}, 45);
        finish_scene(scene);
        raster::RasterSettings drawn;
        drawn.aovs.hit = drawn.aovs.normal = true;
        const Rendering a = test::render(scene, view_of(scene), drawn);
        raytrace::PathTracerSettings traced;
        traced.integrator = raytrace::Integrator::kNormal;
        traced.sampler = SamplerKind::kCenter;
        traced.samples_per_pixel = 1;
        traced.aovs.hit = traced.aovs.normal = true;
        Control control;
        const Rendering b = raytrace::render(raytrace::prepare(scene, traced), view_of(scene), traced, control);
        int other_hit = 0, other_normal = 0, leaf = 0, sheet = 0;
        // Skip pixels covered by the partly transparent object: one pipeline blends normals there, the other uses
        // the hit that stopped the ray.
        const CameraModel camera(view_of(scene));
        const auto veiled = [&](std::size_t i) {
            const Ray ray = camera.ray({static_cast<double>(i % 192) + 0.5, static_cast<double>(i / 192) + 0.5});
            const Vec3 p = ray.origin + ray.direction * ((1.2f - ray.origin.z) / ray.direction.z);
            return std::abs(p.x - 0.25f) < 0.67f && std::abs(p.y + 0.1f) < 0.52f;
        };
        for (std::size_t i = 0; i < a.hit.size(); ++i) {
            leaf += a.hit[i].valid() && a.hit[i].object == 3;
            sheet += a.hit[i].valid() && a.hit[i].object == 4;
            if (a.hit[i].object != b.hit[i].object || a.hit[i].primitive != b.hit[i].primitive) {
                ++other_hit;
                continue;
            }
            if (veiled(i)) continue;
            other_normal += max_component(abs(a.normal[i] - b.normal[i])) > 4e-3f;
        }
        CHECK(leaf > 500);
        CHECK(sheet > 200);
        CHECK(other_hit <= 4); // on silhouettes
        CHECK(other_normal <= 4);
    }
}
