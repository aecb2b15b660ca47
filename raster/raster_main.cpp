// Implements the program `raster SCENE -o OUT`, which renders a scene by rasterization.
#include "common/program/option_checks.h"
#include "common/program/render_program.h"
#include "raster/render.h"
#include "raster/visibility/multisample.h"

#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
    using namespace duet;
    std::string shading_name = "lit", quality_name = "high", occlusion_name = "gtao";
    double occlusion_radius = 0;
    bool no_environment = false, no_culling = false, sample_shading = false, edges = false, shadows = true;
    bool indirect = true, screen_reflections = true, screen_refractions = true, prefiltered = true, transformed_cosines = true;
    int multisamples = 0;
    int shadow_map_side = raster::RasterSettings{}.shadow_map_side,
        shadow_cells = raster::RasterSettings{}.shadow_cells;
    RenderProgram program;
    program.name = "raster";
    program.description = "Renders a scene with the software rasterizer.";
    program.example = "raster models/demo.json -o demo.png --size 1280x720 --spp 4";
    program.spp_help = "Coverage samples a pixel (default 1: its centre)";
    program.add_options = [&](CLI::App& app) {
        app.add_option("--shading", shading_name, raster::shading_names() + " (default: lit, by materials and lights)");
        app.add_option("--quality", quality_name,
                       "lit: realtime (deferred shading) or high (sample by sample; default)");
        app.add_option(
            "--msaa", multisamples,
            "Multisampling: coverage and depth at 2, 4, 8 or 16 samples a pixel, shading once a primitive (in place "
            "of --spp)");
        app.add_flag("--edges", edges, "Ink lines over the picture where depth, normals or objects change");
        app.add_flag("--sample-shading", sample_shading, "With --msaa: shade each sample")->needs("--msaa");
        app.add_flag("--no-environment", no_environment, "Leave the environment's light and background out");
        app.add_flag("--shadows,!--no-shadows", shadows,
                     "Shadow maps: sharp ones of point, spot and sun lights, soft ones of surfaces (default: on)");
        app.add_option("--shadow-map", shadow_map_side,
                       "TextureSampler along a shadow map's side, 64 to 8192; a face of a cube of them has half, of a "
                       "surface light a quarter "
                       "(default 2048); fewer where there would be too many for memory");
        app.add_option("--shadow-cells", shadow_cells,
                       "Pieces along each side of a rectangular light, 1 to 8, each with maps of its own (default 2)");
        app.add_option(
            "--ambient-occlusion", occlusion_name,
            "none, ssao or gtao (default): how what hides the environment is guessed from the picture's depths");
        app.add_option(
               "--occlusion-radius", occlusion_radius,
               "Metres that it may be away (default 0: half of the scene's size or the camera's distance, of ssao an eighth)")
            ->check(nonnegative_number());
        app.add_flag("--prefiltered-environment,!--no-prefiltered-environment", prefiltered,
                     "Rough metal and frosted glass show a blurred environment, not as if smooth (default: on)");
        app.add_flag("--transformed-cosines,!--no-transformed-cosines", transformed_cosines,
                     "Light surfaces shine on rough metal with their shape, not as from their centres (default: on)");
        app.add_flag("--screen-reflections,!--no-screen-reflections", screen_reflections,
                     "Smooth and moderately rough metal mirrors what the picture shows (default: on)");
        app.add_flag("--screen-refractions,!--no-screen-refractions", screen_refractions,
                     "Glass shows what the picture shows without it (default: on)");
        app.add_flag("--indirect,!--no-indirect", indirect,
                     "With --quality realtime: light between surfaces, by irradiance probes (default: on)");
        app.add_flag("--no-culling", no_culling,
                     "Draw back faces of closed meshes and what is outside the frustum, too (same picture)");
    };
    program.prepare = [&](const Scene& scene, const RenderSettings& common, std::optional<int> spp) -> RenderFunction {
        raster::RasterSettings settings;
        static_cast<RenderSettings&>(settings) = common;
        settings.samples_per_pixel = spp.value_or(1);
        settings.shading = raster::parse_shading(shading_name);
        settings.quality = raster::quality(quality_name);
        if (multisamples != 0) raster::multisample_pattern(multisamples); // throws for an unsupported number
        settings.multisamples = multisamples;
        settings.edges = edges;
        settings.sample_shading = sample_shading;
        settings.environment = !no_environment;
        settings.ambient_occlusion = raster::parse_ambient_occlusion(occlusion_name);
        settings.occlusion_radius = occlusion_radius;
        settings.prefiltered_environment = prefiltered;
        settings.transformed_cosines = transformed_cosines;
        settings.screen_reflections = screen_reflections;
        settings.screen_refractions = screen_refractions;
        settings.shadows = shadows;
        settings.indirect_light = indirect;
        settings.shadow_map_side = shadow_map_side;
        settings.shadow_cells = shadow_cells;
        settings.skips.frustum = settings.skips.back_faces = !no_culling;
        return [prepared = raster::prepare(scene, settings), settings](const View& view, Control& control) {
            return raster::render(prepared, view, settings, control);
        };
    };
    return run_render_program(program, argc, argv);
}
