// A program of another project that builds a scene in code, and draws it with both pipelines and with a shader of its
// own.
// usage: own_scene RASTER_IMAGE PATH_TRACED_IMAGE SHADER_IMAGE
#include "common/image/image_file.h"
#include "common/material/conductor.h"
#include "common/scene/build_scene.h"
#include "common/system/error.h"
#include "raster/draw.h"
#include "raster/render.h"
#include "raytrace/render.h"

#include <cmath>
#include <iostream>

using namespace duet;

Mesh torus(std::uint32_t around, std::uint32_t across) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t k = 0; k < across; ++k) {
            const float a = 2 * kPi * float(i) / float(around), b = 2 * kPi * float(k) / float(across);
            const Vec3 n(std::cos(a) * std::cos(b), std::sin(b), std::sin(a) * std::cos(b));
            mesh.positions.push_back(Vec3(std::cos(a), 0, std::sin(a)) + n * 0.4f);
            mesh.normals.push_back(n);
            const std::uint32_t i1 = (i + 1) % around, k1 = (k + 1) % across;
            const std::uint32_t p = i * across + k, q = i1 * across + k, r = i1 * across + k1, s = i * across + k1;
            mesh.triangles.insert(mesh.triangles.end(), {{p, r, q}, {p, s, r}}); // counter-clockwise from outside
        }
    return mesh;
}

Scene gold_ring() {
    Scene scene;
    const Metal metal{.roughness = 0.3f, .conductor = find_conductor("gold").value()};
    const std::uint32_t gold = add_material(scene, "gold", metal);
    const std::uint32_t clay = add_material(scene, "clay", Diffuse{Rgb(0.5f)});
    const std::uint32_t glow = add_material(scene, "glow", Emissive{Rgb(20.0f)});
    add_object(scene, "ring", torus(96, 48), gold, translation(Vec3(0, 0.4f, 0)));
    add_object(scene, "ground", QuadList{{{Vec3(-9, 0, 9), Vec3(18, 0, 0), Vec3(0, 0, -18)}}}, clay);
    add_object(scene, "light", Sphere{Vec3(2, 4, 1), 0.5f}, glow);
    scene.environment = SkyEnvironment{};
    scene.camera.eye = {0, 2.5, 4};
    scene.camera.look_at = {0, 0.3, 0};
    finish_scene(scene); // throws Error if the parts do not fit together
    return scene;
}

struct Bands {
    template <typename T> struct Varyings { Vec3T<T> n; T height; };
    template <typename T> Varyings<T> vertex(const raster::VertexInput<T>& v) const { return {v.n, v.world_p().y}; }
    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        const T upwards = f.normal(f.at.n).unit().y * T(0.5f) + T(0.5f);
        const RgbT<T> tone = f.base_color() * upwards;
        return raster::select_each(sin(f.at.height * T(40)) > T(0), tone, tone * T(0.5f));
    }
};

int main(int argc, char** argv) {
    if (argc != 4) {
        std::cerr << "usage: own_scene RASTER_IMAGE PATH_TRACED_IMAGE SHADER_IMAGE\n";
        return 2;
    }
    try {
        const Scene scene = gold_ring();
        const View view{scene.camera, 160, 120};
        Control control;
        raster::RasterSettings raster_settings;
        raster_settings.samples_per_pixel = 4;
        const raster::RasterScene for_raster = raster::prepare(scene, raster_settings);
        write_image(argv[1], raster::render(for_raster, view, raster_settings, control).radiance);
        write_image(argv[3], raster::draw(for_raster, view, raster_settings, Bands{}, control).radiance);
        raytrace::PathTracerSettings path_settings;
        path_settings.samples_per_pixel = 64;
        const raytrace::PathTracerScene for_rays = raytrace::prepare(scene, path_settings);
        write_image(argv[2], raytrace::render(for_rays, view, path_settings, control).radiance);
    } catch (const Error& error) {
        std::cerr << "own_scene: " << error.what() << '\n';
        return 1;
    }
}
