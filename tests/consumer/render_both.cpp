// A program of another project that uses Duet's libraries: it renders a scene or a mesh with both pipelines.
// usage: render_both SCENE RASTER_IMAGE PATH_TRACED_IMAGE
#include "common/image/image_file.h"
#include "common/scene/scene.h"
#include "common/system/error.h"
#include "raster/render.h"
#include "raytrace/render.h"

#include <iostream>

int main(int argc, char** argv) {
    using namespace duet;
    if (argc != 4) {
        std::cerr << "usage: render_both SCENE RASTER_IMAGE PATH_TRACED_IMAGE\n";
        return 2;
    }
    try {
        const Scene scene = load_scene(argv[1]); // a bare mesh is framed, on a ground under a sky
        const View view{scene.camera, 160, 120};
        Control control; // runs to the end, in silence

        raster::RasterSettings raster_settings;
        raster_settings.samples_per_pixel = 4;
        const raster::RasterScene for_raster = raster::prepare(scene, raster_settings);
        write_image(argv[2], raster::render(for_raster, view, raster_settings, control).radiance);

        raytrace::PathTracerSettings path_settings;
        path_settings.samples_per_pixel = 16;
        const raytrace::PathTracerScene for_rays = raytrace::prepare(scene, path_settings);
        write_image(argv[3], raytrace::render(for_rays, view, path_settings, control).radiance);
    } catch (const Error& error) {
        std::cerr << "render_both: " << error.what() << '\n';
        return 1;
    }
}
