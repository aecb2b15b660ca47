// raster SCENE -o OUT: renders a scene by projecting its primitives onto the pixels.
#include "common/program/render_program.h"
#include "raster/multisample.h"
#include "raster/render.h"

#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
    using namespace duet;
    std::string shading_name = "lit";
    bool no_environment = false, no_culling = false, sample_shading = false, edges = false;
    int multisamples = 0;
    RenderProgram program;
    program.name = "raster";
    program.description = "Renders a scene with the software rasterizer.";
    program.example = "raster models/demo.json -o demo.png --size 1280x720 --spp 4";
    program.spp_help = "Coverage samples a pixel (default 1: its centre)";
    program.add_options = [&](CLI::App& app) {
        app.add_option("--shading", shading_name, raster::shading_names() + " (default: lit, by materials and lights)");
        app.add_option("--msaa", multisamples,
                       "Multisampling: coverage and depth at 2, 4, 8 or 16 samples a pixel, shading once a primitive (in place "
                       "of --spp)");
        app.add_flag("--edges", edges, "Ink lines over the picture where depth, normals or objects change");
        app.add_flag("--sample-shading", sample_shading, "With --msaa: shade each sample")->needs("--msaa");
        app.add_flag("--no-environment", no_environment, "Leave the environment's light and background out");
        app.add_flag("--no-culling", no_culling,
                     "Draw back faces of closed meshes and what is outside the frustum, too (same picture)");
    };
    program.prepare = [&](const Scene& scene, const RenderSettings& common, std::optional<int> spp) -> RenderFunction {
        raster::Settings settings;
        static_cast<RenderSettings&>(settings) = common;
        settings.samples_per_pixel = spp.value_or(1);
        settings.shading = raster::shading(shading_name);
        if (multisamples != 0) raster::multisample_pattern(multisamples); // refuses what there is not
        settings.multisamples = multisamples;
        settings.edges = edges;
        settings.sample_shading = sample_shading;
        settings.environment = !no_environment;
        settings.skips.frustum = settings.skips.back_faces = !no_culling;
        return [prepared = raster::prepare(scene, settings), settings](const View& view, Control& control) {
            return raster::render(prepared, view, settings, control);
        };
    };
    return run_render_program(program, argc, argv);
}
