// raytrace SCENE -o OUT: renders a scene by sending rays from the pixels into it.
#include "common/program/render_program.h"
#include "raytrace/render.h"

#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
    using namespace duet;
    std::string integrator_name = "path", sampler = "sobol", filter = "box", bvh = "default";
    raytrace::Settings settings;
    bool no_environment = false;
    RenderProgram program;
    program.name = "raytrace";
    program.description = "Renders a scene with the path tracer.";
    program.example = "raytrace models/cornell.json -o cornell.png --spp 256";
    program.spp_help = "Samples a pixel (default 64; none where --time or --error ends the render)";
    program.add_options = [&](CLI::App& app) {
        app.add_option("--depth", settings.max_depth,
                       "Scattering events at most: 0 = emission only, 1 = direct light (default 64)")
            ->check(CLI::Range(0, 100000));
        app.add_option("--integrator", integrator_name,
                       "path (default), naive (no light sampling), direct, unshadowed (direct light without "
                       "visibility), lights (emission and direct light of lights), environment (its light on diffuse "
                       "surfaces), reflection (what is seen by way of "
                       "metal and glass), normal or albedo");
        app.add_option("--sampler", sampler,
                       "sobol (default: Owen-scrambled), blue-noise (the same, ordered so that what noise is left at few "
                       "samples is even over the picture), stratified, independent, or center (pixel and lens centre, "
                       "shutter open)");
        app.add_option("--filter", filter,
                       "How a pixel weighs the light around its centre: box (default, the pixel itself) or "
                       "blackman-harris (a smooth bell over 3 x 3 pixels)");
        app.add_option("--time", settings.time_limit, "Stop after this many seconds, between passes")
            ->check(CLI::PositiveNumber);
        app.add_option("--error", settings.error_limit, "Stop when the estimated relMSE is below this, between passes")
            ->check(CLI::PositiveNumber);
        app.add_option("--bvh", bvh,
                       "Quality of the hierarchies that rays search: default, or high (long to build; faster to search "
                       "where triangles are long or overlap; the same picture)");
        app.add_flag("--no-environment", no_environment, "Leave the environment's light and background out");
    };
    program.prepare = [&](const Scene& scene, const RenderSettings& common, std::optional<int> spp) -> RenderFunction {
        const bool limited = settings.time_limit > 0 || settings.error_limit > 0;
        static_cast<RenderSettings&>(settings) = common;
        settings.samples_per_pixel = spp.value_or(limited ? 1 << 24 : 64);
        settings.integrator = raytrace::integrator(integrator_name);
        settings.sampler = sampler_kind(sampler);
        settings.filter = filter_kind(filter);
        settings.bvh = raytrace::bvh_quality(bvh);
        settings.environment = !no_environment;
        return [prepared = raytrace::prepare(scene, settings), settings](const View& view, Control& control) {
            return raytrace::render(prepared, view, settings, control);
        };
    };
    return run_render_program(program, argc, argv);
}
