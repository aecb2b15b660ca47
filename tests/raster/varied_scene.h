// This header builds a scene of everything that the rasterizer draws, for tests that compare two shading paths.
#pragma once

#include "raster/geometry/geometry.h"
#include "tests/raster/scenes.h"

namespace duet::test {

inline Mesh smooth_torus(int around, int across) {
    Mesh mesh = torus(around, across);
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k) {
            const double u = 2 * kPiDouble * i / around, v = 2 * kPiDouble * k / across;
            mesh.normals.push_back(Vec3(Vec3d(std::cos(u) * std::cos(v), std::sin(v), -std::sin(u) * std::cos(v))));
        }
    return mesh;
}

/// Returns meshes with and without normals, used once, mirrored and stretched, plus a sphere and a quad.
inline Scene varied_scene(int around) {
    Scene scene;
    add(scene, smooth_torus(around, around / 2), Mat4(), Diffuse{{Rgb(0.8f, 0.5f, 0.3f)}});
    add_instance(scene, 0, Mat4(translation(Vec3(1.2f, 0.9f, -0.5f)) * scaling(Vec3(-0.5f, 0.5f, 0.7f))));
    add(scene, torus(20, 10), Mat4(translation(Vec3(-1.3f, 0.4f, 0.5f))), Diffuse{{Rgb(0.2f, 0.5f, 0.9f)}});
    add(scene, Sphere{Vec3(0, 0.3f, 1.2f), 0.4f}, Mat4(), Diffuse{{Rgb(0.6f)}});
    add(scene, QuadList{{Quad{Vec3(-4, -0.5f, 3), Vec3(8, 0, 0), Vec3(0, 0, -9)}}}, Mat4(), Diffuse{{Rgb(0.5f)}});
    scene.lights = {SunLight{normalize(Vec3(0.4f, -1, -0.5f)), Rgb(2, 1.9f, 1.7f)},
                    PointLight{Vec3(-1, 3, 2), Rgb(4, 3, 5)}};
    scene.environment = ConstantEnvironment{Rgb(0.1f, 0.12f, 0.15f)};
    finish_scene(scene);
    return scene;
}

inline View perspective() { return {look({1.5, 2.2, 4.2}, {0, 0, 0}, 45), 331, 237}; }
inline View orthographic() {
    View view = perspective();
    view.camera.projection = Camera::Projection::kOrthographic;
    view.camera.height = 4;
    return view;
}

/// Holds the geometry of an image with one sample per pixel, which is not at its center.
struct ImageGeometry {
    const Scene scene;
    const raster::RasterSettings settings;
    const raster::RasterScene prepared;
    const Pinhole pinhole;
    const std::vector<raster::SampleOffset> samples{{37, 201}};
    const raster::PassView pass;
    const raster::TileGrid grid;
    raster::Geometry geometry;

    ImageGeometry(const Scene& scene_, const View& view)
        : scene(scene_), prepared(raster::prepare(scene, settings)), pinhole(CameraModel(view).pinhole()),
          pass{pinhole, 0, raster::viewport_of(view, pinhole), samples}, grid{{0, 0, view.width, view.height}} {
        process_geometry(prepared.data(), grid, pass, settings, geometry);
    }
};

} // namespace duet::test
