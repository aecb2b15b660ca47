// The program `raytrace SCENE -o OUT` renders a scene with the path tracer. This file holds its options.
// run_render_program() loads the scene, calls prepare() and render() of the pipeline, and writes the image.
#include "common/image/image_file.h"
#include "common/program/render_program.h"
#include "common/system/error.h"
#include "common/system/file.h"
#include "raytrace/film/merge_films.h"
#include "raytrace/pixel_debug.h"
#include "raytrace/render.h"

#include <charconv>
#include <optional>

namespace {

using namespace duet;

struct Options {
    std::string integrator = "path", sampler = "sobol", filter = "box", film, samples, pixel;
    bool no_environment = false;
    std::optional<bool> adaptive;
    raytrace::PathTracerSettings settings; // Options that need no conversion write here.
};

void add_options(CommandLine& command_line, Options& options) {
    command_line
        .add("--depth", options.settings.max_depth,
             "Scattering events at most: 0 = emission only, 1 = direct light (default 64)")
        .range(0, raytrace::PathTracerSettings::kMostDepth);
    command_line.add("--integrator", options.integrator,
                     "path (default), naive (no light sampling), bidirectional (paths from the camera and from the "
                     "lights, connected), vcm (the same, also merged where they nearly meet), photons (progressive "
                     "photon mapping), metropolis (Markov chains of connected paths), whitted (mirrors, glass and hard "
                     "shadows), direct, unshadowed (direct light without visibility), lights (emission and direct "
                     "light of lights), environment (its light on diffuse surfaces), reflection (what is seen by way "
                     "of metal and glass), normal or albedo");
    command_line.add(
        "--sampler", options.sampler,
        "sobol (default: Owen-scrambled), blue-noise (the same, ordered so that what noise is left at few "
        "samples is even over the image), stratified, independent, or center (pixel and lens center, "
        "shutter open)");
    command_line.add("--filter", options.filter,
                     "How a pixel weighs the light around its center: box (default, the pixel itself) or "
                     "blackman-harris (a smooth bell over 3 x 3 pixels)");
    command_line.add("--time", options.settings.time_limit, "Stop after this many seconds, between passes").positive();
    command_line
        .add("--error", options.settings.error_limit, "Stop when the estimated relMSE is below this, between passes")
        .positive();
    command_line.add_flag("--adaptive,!--no-adaptive", options.adaptive,
                          "More samples where the error is, --spp in the mean (default with --time or --error, "
                          "but for --samples and samplers that need to know the number)");
    command_line.add_flag(
        "--denoise", options.settings.denoise,
        "Blur the noise, but not what albedo, normals, depth or both halves of the samples show, "
        "and keep the undenoised image as NAME.noisy.EXT. Needs 2 samples per pixel (default: not)");
    command_line.add(
        "--film", options.film,
        "Keep all samples in this .exr: written at intervals, at the end and when interrupted; a later run goes on "
        "from there, to the same bits as one run. What was begun with --adaptive, --error, --denoise or --aov "
        "variance knows its error, and goes on with these alone. `raytrace merge` joins films");
    command_line
        .add("--film-interval", options.settings.film_interval, "Seconds between two writings of it (default 60)")
        .nonnegative()
        .needs("--film");
    command_line.add("--samples", options.samples,
                     "Samples A:B, from A to B − 1 of each pixel: a shard (in place of --spp)");
    command_line.add("--pixel", options.pixel,
                     "Render that one sample, X,Y[,SAMPLE] (row 0 on top, default sample 0), and print its path: "
                     "needs no -o");
    command_line.add_flag("--no-environment", options.no_environment,
                          "Leave the environment's light and background out");
}

// Sets first_sample and samples_per_pixel from "A:B".
void set_samples(const std::string& text, raytrace::PathTracerSettings& settings) {
    std::uint32_t first = 0, last = 0;
    const char* const end = text.data() + text.size();
    const auto a = std::from_chars(text.data(), end, first);
    const bool colon = a.ec == std::errc() && a.ptr != end && *a.ptr == ':';
    const auto b = std::from_chars(colon ? a.ptr + 1 : end, end, last);
    if (!colon || b.ec != std::errc() || b.ptr != end || first >= last || last > 1u << 24)
        throw Error(message("--samples: found ", text,
                            ", expected FIRST:END such as 0:128, FIRST below END, END at most ", 1 << 24));
    settings.first_sample = first;
    settings.samples_per_pixel = static_cast<int>(last - first);
}

// Throws Error if the undenoised image cannot be written beside the denoised one.
void check_undenoised(const OutputOptions& output, const std::string& film) {
    if (output.path.empty() || lower_case_extension(output.path) == ".mp4") return; // a video has no such image
    const std::filesystem::path path = undenoised_path(output.path);
    check_writable_image(path);
    if (path == film)
        throw Error(message("--film: ", film, " is where --denoise keeps the undenoised image, expected another file"));
}

void check_options(const Options& options, const OutputOptions& output) {
    const std::string& film = options.film;
    if (!options.pixel.empty()) raytrace::parse_sample_id(options.pixel);
    if (options.settings.denoise) check_undenoised(output, film);
    if (film.empty()) return;
    if (output.frames > 0) throw Error("--film: keeps one image, cannot go with --orbit");
    if (lower_case_extension(film) != ".exr") throw Error(message("--film: found ", film, ", expected an .exr"));
    if (film == output.path) throw Error("--film: is the image's own file, expected another");
    const auto folder = std::filesystem::absolute(film).parent_path();
    if (!std::filesystem::is_directory(folder)) throw Error(message("--film: no folder ", folder.string()));
}

raytrace::PathTracerSettings settings_of(const Options& options, const RenderSettings& common, std::optional<int> spp) {
    raytrace::PathTracerSettings settings = options.settings;
    const bool limited = settings.time_limit > 0 || settings.error_limit > 0;
    static_cast<RenderSettings&>(settings) = common;
    settings.samples_per_pixel = spp.value_or(limited ? 1 << 24 : 64);
    if (!options.samples.empty()) {
        if (spp) throw Error("--samples: cannot go with --spp: the range says how many");
        set_samples(options.samples, settings);
    }
    settings.film = options.film;
    settings.integrator = raytrace::integrator(options.integrator);
    settings.sampler = sampler_kind(options.sampler);
    settings.filter = filter_kind(options.filter);
    settings.adaptive = options.adaptive.value_or(limited && options.samples.empty() &&
                                                  !needs_sample_count(settings.sampler) &&
                                                  !traces_light_paths(settings.integrator));
    settings.environment = !options.no_environment;
    return settings;
}

} // namespace

int main(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "merge") return raytrace::run_merge(argc - 1, argv + 1);
    Options options;
    RenderProgram program;
    program.name = "raytrace";
    program.description = "Renders a scene with the path tracer.";
    program.examples = {"raytrace models/cornell.json -o cornell.png --spp 256",
                        "raytrace mesh.obj -o mesh.png --time 60 --denoise",
                        "raytrace merge a.exr b.exr -o joined.png    (films of --film; see raytrace merge --help)"};
    program.spp_help = "Samples per pixel (default 64; none where --time or --error ends the render)";
    program.add_options = [&](CommandLine& command_line) { add_options(command_line, options); };
    program.check = [&](const OutputOptions& output) { check_options(options, output); };
    program.wants_text_output = [&] { return !options.pixel.empty(); };
    program.text_output = [&](const Scene& scene, const View& view, const RenderSettings& common,
                              std::optional<int> spp) {
        const raytrace::PathTracerSettings settings = settings_of(options, common, spp);
        return raytrace::debug_pixel(raytrace::prepare(scene, settings), view, settings,
                                     raytrace::parse_sample_id(options.pixel));
    };
    program.prepare = [&](const Scene& scene, const RenderSettings& common, std::optional<int> spp) -> RenderFunction {
        const raytrace::PathTracerSettings settings = settings_of(options, common, spp);
        return [prepared = raytrace::prepare(scene, settings), settings](const View& view, Control& control) {
            return raytrace::render(prepared, view, settings, control);
        };
    };
    return run_render_program(program, argc, argv);
}
