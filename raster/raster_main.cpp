// Implements the program `raster SCENE -o OUT`, which renders a scene by rasterization. This file holds its options.
// run_render_program() loads the scene, calls prepare() and render() of the pipeline, and writes the image.
#include "common/program/render_program.h"
#include "raster/render.h"
#include "raster/shading/built_in_shaders.h"
#include "raster/visibility/multisample.h"

namespace {

using namespace duet;

struct Options {
    std::string shading = "lit";
    bool no_environment = false, no_culling = false;
    raster::RasterSettings settings; // Options that need no conversion write here.
};

void add_options(CommandLine& command_line, Options& options) {
    command_line.add("--shading", options.shading,
                     "lit (default: by materials and lights), phong, gouraud, flat, toon, wireframe, lines, edges, "
                     "normal, albedo or depth");
    command_line.add(
        "--msaa", options.settings.multisamples,
        "Multisampling: coverage and depth at 2, 4, 8 or 16 samples per pixel, shading once per primitive (in place "
        "of --spp); lit shades each sample");
    command_line.add_flag("--edges", options.settings.edges,
                          "Draw lines over the image where depth, normals or objects change");
    command_line.add_flag("--sample-shading", options.settings.sample_shading, "With --msaa: shade each sample")
        .needs("--msaa");
    command_line.add_flag("--no-environment", options.no_environment,
                          "Leave out the environment's light and background");
    command_line.add_flag(
        "--shadows,!--no-shadows", options.settings.shadows,
        "Shadow maps: sharp ones for point, spot and sun lights, soft ones for area lights (default: on)");
    command_line.add("--shadow-map", options.settings.shadow_map_side,
                     "Texels along a shadow map's side, 64 to 8192; a face of a cube map has half as many, of an "
                     "area light's a quarter (default 2048); fewer where there would be too many for memory, and "
                     "at most eight times the side of a square image of as many pixels, which shows no more");
    command_line.add(
        "--shadow-cells", options.settings.shadow_cells,
        "Pieces along each side of a rectangular light, 1 to 8, each with a map of its own (default 2)");
    command_line.add_flag("--ambient-occlusion,!--no-ambient-occlusion", options.settings.ambient_occlusion,
                          "GTAO: near surfaces hide diffuse light, by the image's depths (default: on)");
    command_line.add_flag("--indirect,!--no-indirect", options.settings.indirect_light,
                          "Diffuse light between surfaces, from irradiance probes (default: on)");
    command_line.add_flag("--subsurface,!--no-subsurface", options.settings.subsurface,
                          "Light bleeds inside of solids with subsurface scattering, by a blur (default: on)");
    command_line.add_flag("--fog,!--no-fog", options.settings.fog,
                          "Media, from froxels: cells of a grid that is aligned with the view (default: on)");
    command_line
        .add("--occlusion-radius", options.settings.occlusion_radius,
             "With --no-indirect: meters up to which surfaces hide the environment (default 0: half of the "
             "scene's size or of the camera's distance)")
        .nonnegative();
    command_line.add_flag("--no-culling", options.no_culling,
                          "Draw back faces of closed meshes and what is outside the frustum, too (same image)");
}

raster::RasterSettings settings_of(const Options& options, const RenderSettings& common, std::optional<int> spp) {
    raster::RasterSettings settings = options.settings;
    static_cast<RenderSettings&>(settings) = common;
    settings.samples_per_pixel = spp.value_or(1);
    settings.shading = raster::kShadings.value(options.shading);
    if (settings.multisamples != 0) raster::multisample_pattern(settings.multisamples); // throws if unsupported
    settings.environment = !options.no_environment;
    settings.skips.frustum = settings.skips.back_faces = !options.no_culling;
    return settings;
}

} // namespace

int main(int argc, char** argv) {
    Options options;
    RenderProgram program;
    program.name = "raster";
    program.description = "Renders a scene with the software rasterizer.";
    program.examples = {"raster models/demo.json -o demo.png --size 1280x720 --spp 4",
                        "raster mesh.obj -o mesh.png --msaa 8"};
    program.spp_help = "Samples per pixel (default 1: its center)";
    program.add_options = [&](CommandLine& command_line) { add_options(command_line, options); };
    program.prepare = [&](const Scene& scene, const RenderSettings& common, std::optional<int> spp) -> RenderFunction {
        const raster::RasterSettings settings = settings_of(options, common, spp);
        return [prepared = raster::prepare(scene, settings), settings](const View& view, Control& control) {
            return raster::render(prepared, view, settings, control);
        };
    };
    return run_render_program(program, argc, argv);
}
