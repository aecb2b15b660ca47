// These tests compare the rasterizer's fog with closed forms, with numerical integrals and with the path tracer.
#include "tests/raster/path_traced.h"
#include "tests/raster/varied_scene.h"

#include "common/medium/cloud.h"
#include "common/medium/phase_function.h"
#include "raster/fog/fog_grid.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

Medium fog(Rgb scattering, Rgb absorption = {}, float asymmetry = 0) {
    return {Medium::unbounded(), scattering, absorption, Rgb(), asymmetry};
}

/// Returns a cloud of noise between z = 1 and z = 4.
Medium cloud(Rgb scattering, Rgb absorption) {
    Medium medium = fog(scattering, absorption);
    medium.box = {{-3, -2, 1}, {3, 2, 4}};
    medium.density = std::make_shared<const DensityGrid>(make_cloud({.coverage = 0.6f, .resolution = 32}, medium.box));
    return medium;
}

/// Returns a wall at z = 0 that shines, large enough to fill every view.
Scene shining_wall(Rgb radiance) {
    Scene scene;
    add(scene, QuadList{{Quad{Vec3(-40, -40, 0), Vec3(80, 0, 0), Vec3(0, 80, 0)}}}, Mat4(), Emissive{radiance});
    scene.environment = ConstantEnvironment{Rgb()};
    return scene;
}

View view_of(const Camera& camera, int width = 47, int height = 31) { return {camera, width, height}; }

/// Returns how far a pixel's ray is in a box, before the plane z = 0.
double meters_in(const Box3& box, const Rayd& ray) {
    double begin = 0, end = -ray.origin.z / ray.direction.z;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double a = (static_cast<double>(box.low[axis]) - ray.origin[axis]) / ray.direction[axis],
                     b = (static_cast<double>(box.high[axis]) - ray.origin[axis]) / ray.direction[axis];
        begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
    }
    return std::max(end - begin, 0.0);
}

/// Calls check(color, ray) for each pixel.
template <typename Check> void for_each_ray(const Scene& scene, const View& view, const Check& check) {
    const Rendering image = render(scene, view, {});
    const Pinhole pinhole = CameraModel(view).pinhole();
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) check(image.radiance(x, y), pinhole.ray({x + 0.5, y + 0.5}));
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("absorption attenuates what is behind it by the law of Beer and Lambert") {
        const Rgb sigma(0.1f, 0.4f, 1.3f);
        Scene scene = shining_wall(Rgb(2.0f));
        scene.media = {fog(Rgb(), sigma)};
        scene.media[0].box = Box3{{-3, -2, 1}, {2, 3, 4}};
        finish_scene(scene);
        Camera camera = look({0.3, 0.2, 7}, {0, 0, 0}, 60);
        for (const auto projection : {Camera::Projection::kPerspective, Camera::Projection::kOrthographic}) {
            camera.projection = projection, camera.height = 8;
            for_each_ray(scene, view_of(camera), [&](Rgb c, const Rayd& ray) {
                const double meters = meters_in(scene.media[0].box, ray);
                for (std::size_t i = 0; i < 3; ++i)
                    CHECK(static_cast<double>(c[i]) ==
                          doctest::Approx(2 * std::exp(-static_cast<double>(sigma[i]) * meters)).epsilon(1e-5));
            });
        }
    }

    TEST_CASE("a cloud attenuates what is behind it by its column") {
        Scene scene = shining_wall(Rgb(2.0f));
        scene.media = {cloud(Rgb(), Rgb(0.5f, 2, 9))};
        finish_scene(scene);
        for_each_ray(scene, view_of(look({0.3, 0.2, 7}, {0, 0, 0}, 60)), [&](Rgb c, const Rayd& ray) {
            const Ray single{Vec3(ray.origin), Vec3(ray.direction)};
            const Rgb through = transmittance(scene.media, single, kInfinity);
            for (std::size_t i = 0; i < 3; ++i)
                CHECK(static_cast<double>(c[i]) == doctest::Approx(2 * static_cast<double>(through[i])).epsilon(1e-3));
        });
    }

    TEST_CASE("a thin cloud scatters what the path tracer says") {
        // Nothing is scattered twice to speak of, so the octaves of deep clouds must not add light.
        Scene scene = shining_wall(Rgb());
        scene.materials[0] = Diffuse{{Rgb(0.0f)}};
        scene.lights = {PointLight{{1.5f, 2, 5}, Rgb(40.0f)}, SunLight{{0, -1, 0}, Rgb(2.0f)}};
        scene.media = {cloud(Rgb(0.02f), Rgb())};
        finish_scene(scene);
        const View view = view_of(look({0.3, 0.2, 9}, {0, 0, 2}, 50), 96, 64);
        const ImageRgb image = render(scene, view, {}).radiance, truth = path_traced(scene, view, 1024);
        double error = 0, sum = 0, difference = 0;
        for (std::size_t i = 0; i < image.size(); ++i) {
            error += std::abs(static_cast<double>(image[i].g - truth[i].g));
            difference += static_cast<double>(image[i].g - truth[i].g);
            sum += static_cast<double>(truth[i].g);
        }
        MESSAGE("mean error ", error / sum, ", bias ", difference / sum);
        CHECK(error < 0.06 * sum); // a froxel is an eighth of the image's height
        CHECK(std::abs(difference) < 0.02 * sum);
    }

    TEST_CASE("a medium that emits and absorbs is as bright as its depth says") {
        const Rgb sigma(0.05f, 0.5f, 5);
        Scene scene = shining_wall(Rgb());
        scene.materials[0] = Diffuse{{Rgb(0.0f)}};
        scene.media = {fog(Rgb(), sigma)};
        scene.media[0].radiance = Rgb(3, 2, 1);
        scene.media[0].box = Box3{{-50, -50, 1.5f}, {50, 50, 4}};
        finish_scene(scene);
        for_each_ray(scene, view_of(look({0.3, 0.2, 7}, {0, 0, 0}, 60), 160, 120), [&](Rgb c, const Rayd& ray) {
            const double meters = meters_in(scene.media[0].box, ray);
            for (std::size_t i = 0; i < 3; ++i) {
                const double expected = -static_cast<double>(scene.media[0].radiance[i]) *
                                        std::expm1(-static_cast<double>(sigma[i]) * meters);
                CHECK(static_cast<double>(c[i]) == doctest::Approx(expected).epsilon(2e-3));
            }
        });
    }

    TEST_CASE("a point light's single scattering approaches the integral with more slices") {
        Scene scene = shining_wall(Rgb());
        scene.materials[0] = Diffuse{{Rgb(0.0f)}};
        const Vec3d light(0.6, -0.4, 3);
        const double sigma_s = 0.15, sigma_t = 0.2;
        scene.lights = {PointLight{Vec3(light), Rgb(5.0f)}};
        scene.media = {fog(Rgb(static_cast<float>(sigma_s)), Rgb(static_cast<float>(sigma_t - sigma_s)), 0.5f)};
        finish_scene(scene);
        const View view = view_of(look({0.3, 0.2, 7}, {0, 0, 0}, 50), 64, 64);
        const Pinhole pinhole = CameraModel(view).pinhole();
        raster::RasterSettings settings = direct_light_only();
        settings.shadows = false;
        const raster::RasterScene prepared = raster::prepare(scene, settings);
        raster::GBuffer gbuffer(raster::ScreenProjection(pinhole, {}), view.width, view.height, {});
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) gbuffer.reversed_depth(x, y) = static_cast<float>(pinhole.near / 7.0);
        const auto integral = [&](const Rayd& ray, double length) {
            double sum = 0;
            constexpr int kSteps = 4000;
            for (int i = 0; i < kSteps; ++i) {
                const double t = (i + 0.5) * length / kSteps;
                const Vec3d to = light - ray.at(t);
                const double d = std::sqrt(length_squared(to)), cosine = dot(ray.direction, to) / d;
                const double hg = (1 - 0.25) / (4 * kPiDouble * std::pow(1.25 - cosine, 1.5));
                sum += sigma_s * hg * std::exp(-sigma_t * (t + d)) * 5 / (d * d);
            }
            return sum * length / kSteps;
        };
        double before = 1;
        for (const int slices : {4, 16, 64, 256}) {
            raster::FogGrid grid;
            grid.compute(prepared.data(), settings, gbuffer, {}, {.side = 1, .slices = slices, .threads = 1});
            raster::Planes3 radiance(view.width, view.height);
            grid.apply(gbuffer, 1, true, radiance);
            double error = 0;
            int count = 0;
            for (int y = 0; y < view.height; y += 5)
                for (int x = 0; x < view.width; x += 5, ++count) {
                    const Rayd ray = pinhole.ray({x + 0.5, y + 0.5});
                    const double exact = integral(
                        ray, static_cast<double>(gbuffer.projection.distance(gbuffer.projection.point(
                                 static_cast<float>(x), static_cast<float>(y), gbuffer.reversed_depth(x, y)))));
                    error += std::abs(static_cast<double>(radiance.color_at(x, y).g) / exact - 1);
                }
            error /= count;
            MESSAGE(slices, " slices: mean error ", error);
            CHECK(error < before);
            before = error;
            if (slices == 64) CHECK(error < 0.01);
        }
        CHECK(before < 0.002);
    }

    TEST_CASE("media between a light and a surface attenuate the surface's light") {
        Scene scene = shining_wall(Rgb());
        scene.materials[0] = Diffuse{{Rgb(0.8f)}};
        const Vec3d light(0.5, 0.7, 5);
        scene.lights = {PointLight{Vec3(light), Rgb(50.0f)}};
        finish_scene(scene);
        const View view = view_of(look({0.3, 0.2, 7}, {0, 0, 0}, 60));
        const Rendering clear = render(scene, view, direct_light_only());
        scene.media = {fog(Rgb(), Rgb(0.3f))};
        const Rendering foggy = render(scene, view, direct_light_only());
        const Pinhole pinhole = CameraModel(view).pinhole();
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const Rayd ray = pinhole.ray({x + 0.5, y + 0.5});
                const double t = -ray.origin.z / ray.direction.z;
                const double meters = t + length(light - ray.at(t));
                CHECK(static_cast<double>(foggy.radiance(x, y).g / clear.radiance(x, y).g) ==
                      doctest::Approx(std::exp(-0.3 * meters)).epsilon(1e-5));
            }
    }

    TEST_CASE("blended surfaces in fog are attenuated each by its distance") {
        Scene scene = shining_wall(Rgb(2.0f));
        add(scene, QuadList{{Quad{Vec3(-40, -40, 3), Vec3(80, 0, 0), Vec3(0, 80, 0)}}}, Mat4(), Emissive{Rgb(1.0f)});
        scene.maps.resize(scene.materials.size());
        scene.maps[1].opacity.value = 0.25f;
        scene.media = {fog(Rgb(), Rgb(0.2f))};
        finish_scene(scene);
        for_each_ray(scene, view_of(look({0.3, 0.2, 7}, {0, 0, 0}, 60)), [&](Rgb c, const Rayd& ray) {
            const double wall = -ray.origin.z / ray.direction.z, sheet = (3 - ray.origin.z) / ray.direction.z;
            CHECK(static_cast<double>(c.g) ==
                  doctest::Approx(0.25 * std::exp(-0.2 * sheet) + 0.75 * 2 * std::exp(-0.2 * wall)).epsilon(1e-5));
        });
    }

    TEST_CASE("fog needs no surfaces") {
        Scene scene;
        scene.materials = {Diffuse{}};
        scene.material_names = {"unused"};
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        scene.media = {fog(Rgb(0.2f), Rgb(0.5f))};
        scene.media[0].box = Box3{{-1, -1, -3}, {1, 1, -1}};
        finish_scene(scene);
        const Rendering image = render(scene, view_of(look({0, 0, 0}, {0, 0, -1}, 20)), {});
        const double through = std::exp(-0.7 * 2);
        const Rgb middle = image.radiance(23, 15);
        CHECK(static_cast<double>(middle.g) > 1.05 * through); // the fog scatters the environment's light, too
        CHECK(static_cast<double>(middle.g) < 0.8);
    }

    TEST_CASE("a medium whose box has no thickness in floats, seen from afar, is left out") {
        Scene scene = shining_wall(Rgb(2.0f));
        scene.media = {cloud(Rgb(0.2f), Rgb(0.5f))};
        finish_scene(scene);
        const View view = view_of(look({0, 1e18, 0}, {0, 0, 1}, 60), 8, 8);
        for (const Rgb& color : render(scene, view, {}).radiance) CHECK(is_finite(color));
    }

    TEST_CASE("without fog, a scene looks as if it had no media") {
        Scene scene = varied_scene(24);
        const Rendering clear = render(scene, perspective(), {});
        scene.media = {fog(Rgb(0.1f), Rgb(0.1f))};
        raster::RasterSettings settings;
        settings.fog = false;
        CHECK(render(scene, perspective(), settings).radiance.pixels() == clear.radiance.pixels());
    }

    TEST_CASE("fog is the same for any number of threads") {
        Scene scene = varied_scene(24);
        scene.media = {fog(Rgb(0.1f), Rgb(0.02f), 0.6f)};
        scene.media[0].box = Box3{{-3, -0.5f, -3}, {3, 1, 2}};
        raster::RasterSettings settings;
        settings.threads = 1;
        const Rendering one = render(scene, perspective(), settings);
        settings.threads = 3;
        CHECK(one.radiance.pixels() == render(scene, perspective(), settings).radiance.pixels());
    }

}

TEST_SUITE("image") {

    TEST_CASE("lights in fog look as in the path tracer") {
        Scene scene = varied_scene(24);
        scene.lights = {SpotLight{Vec3(-2, 3, 1), normalize(Vec3(0.6f, -1, -0.4f)), Rgb(30.0f), 0.95f, 0.9f},
                        PointLight{Vec3(1.5f, 1.2f, -1), Rgb(2, 2, 4)}};
        scene.media = {fog(Rgb(0.12f), Rgb(), 0.4f)};
        scene.media[0].box = Box3{{-3, -0.5f, -3}, {3, 3, 4}};
        finish_scene(scene);
        for (View view : {perspective(), orthographic()}) {
            view.width /= 2, view.height /= 2;
            const double error = relmse(render(scene, view, {}).radiance, path_traced(scene, view, 256));
            MESSAGE("relMSE ", error);
            CHECK(error < 0.03);
        }
    }
}
