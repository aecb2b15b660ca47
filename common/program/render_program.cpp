#include "common/program/render_program.h"

#include "common/image/image_file.h"
#include "common/program/program.h"
#include "common/program/statistics.h"
#include "common/program/video.h"
#include "common/program/view_transform_options.h"
#include "common/system/file.h"
#include "common/system/memory.h"
#include "common/system/name_table.h"
#include "common/system/parallel.h"
#include "common/system/stopwatch.h"

#include <nlohmann/json.hpp>

#include <iostream>

namespace duet {

namespace {

struct Options {
    std::string scene, output, aovs, stats;
    SceneOptions scene_options;
    int spp = 0, threads = 0, orbit = 0;
    std::uint64_t seed = 0;
    ViewTransformOptions view_transform;
    bool ascii = false, quiet = false;
};

void add_common_options(CommandLine& program, Options& options, const std::string& spp_help) {
    program.add("SCENE", options.scene, "A scene file (.json) or a bare mesh (.obj: framed, on a ground under a sky)")
        .required();
    program.add("-o,--output", options.output, "The image: .png, .jpg, .tga, .ppm, .pfm, .hdr or .exr");
    add_scene_options(program, options.scene_options);
    program.add("--spp", options.spp, spp_help).range(1, 1 << 24);
    program.add("--threads", options.threads, "Threads (default: all)").range(1, 1024);
    program.add("--seed", options.seed, "Seed of all random numbers (default 0)");
    program.add("--stats", options.stats, "Write statistics as JSON to this file (-: standard output)");
    program.add("--aov", options.aovs,
                "Auxiliary images, a list of depth,normal,albedo,hit,variance,samples: channels of an "
                ".exr, or EXR files beside the image");
    program
        .add("--orbit", options.orbit,
             "Render this many frames around the camera's target; the output's name holds %04d, or ends in .mp4 "
             "(needs ffmpeg)")
        .range(1, 9999);
    add_view_transform(program, options.view_transform);
    program.add_flag("--ascii", options.ascii, "Write .ppm as text (P3)");
    program.add_flag("--quiet", options.quiet, "No progress bar");
}

Camera orbited(Camera camera, int frame, int frames) {
    const Mat4d turn = rotation(normalize(camera.up), 2 * kPiDouble * frame / frames);
    camera.eye = camera.look_at + transform_vector(turn, camera.eye - camera.look_at);
    return camera;
}

// Returns the name of the image, or the pattern of the names of an orbit's frames.
std::string image_name(const Options& options) {
    if (options.output.empty()) throw Error("no output: expected -o and the image's file (--help explains)");
    if (!is_video(options.output)) return options.output;
    if (options.orbit == 0) throw Error(message(options.output, ": a video needs --orbit and a number of frames"));
    return video_frames(options.output);
}

void check_output(const Options& options) {
    const std::string name = image_name(options);
    if (options.orbit > 0 && name.find("%04d") == std::string::npos)
        throw Error(message("--orbit: the output's name must hold %04d for the frame's number, or end in .mp4, found ",
                            options.output));
    check_writable_image(name);
    if (options.ascii && lower_case_extension(options.output) != ".ppm")
        throw Error(message("--ascii: only a .ppm can be written as text, found ", options.output));
    check_json_path(options.stats);
}

// Returns a hint at the command that logs the first invalid sample, or nothing where there is none.
std::string invalid_sample_hint(const RenderStatistics& s) {
    if (!s.first_invalid) return {};
    return message("; the same command with --pixel ", s.first_invalid->x, ',', s.first_invalid->y, ',',
                   s.first_invalid->sample, " tells of the first");
}

void print_summary(const RenderContext& context, const Rendering& rendering, const std::string& output) {
    const RenderStatistics& s = rendering.statistics;
    std::cerr << output << ": " << context.width << " x " << context.height << ", " << s.samples_per_pixel
              << (s.samples_per_pixel == 1 ? " sample" : " samples") << " a pixel in "
              << format_duration(context.render_seconds) << (s.interrupted ? " (interrupted)" : "");
    if (const double before = context.load_seconds + context.prepare_seconds; before >= 0.1)
        std::cerr << ", after " << format_duration(before) << " of preparation";
    std::cerr << '\n';
    if (!rendering.denoised.empty())
        std::cerr << undenoised_path(output).string() << ": the same, not denoised\n";
    if (s.invalid_samples > 0)
        std::cerr << "warning: " << s.invalid_samples << " samples were NaN, infinite or negative, and left out"
                  << invalid_sample_hint(s) << '\n';
}

int render_all(const RenderProgram& program, const Options& options) {
    const bool text_only = program.wants_text_output && program.wants_text_output();
    if (!text_only) check_output(options);
    if (program.check) program.check({options.output, options.orbit});
    RenderSettings settings;
    settings.threads = options.threads;
    settings.seed = options.seed;
    settings.aovs = parse_aovs(options.aovs);

    RenderContext context;
    context.program = program.name;
    context.scene = options.scene;
    context.threads = options.threads > 0 ? options.threads : available_threads();
    context.seed = options.seed;
    Stopwatch watch;
    const Scene scene = load_scene(options.scene, options.scene_options);
    context.load_seconds = watch.lap();
    context.width = scene.width;
    context.height = scene.height;
    const std::optional<int> spp = options.spp > 0 ? std::optional(options.spp) : std::nullopt;
    if (text_only) {
        std::cout << program.text_output(scene, View{scene.camera, context.width, context.height}, settings, spp);
        return kExitOk;
    }
    const RenderFunction render = program.prepare(scene, settings, spp);
    context.prepare_seconds = watch.lap();

    const InterruptFlag interrupt;
    const WriteOptions write_options{.ascii_ppm = options.ascii,
                                     .view = options.view_transform.applied_to(scene.view_transform)};
    const int frames = options.orbit > 0 ? options.orbit : 1;
    nlohmann::json all_statistics = nlohmann::json::array();
    ProgressBar bar(program.name, options.quiet);
    for (int frame = 0; frame < frames && !interrupt.raised(); ++frame) {
        const View view{options.orbit > 0 ? orbited(scene.camera, frame, frames) : scene.camera, context.width,
                        context.height};
        const std::string output = options.orbit > 0 ? frame_path(image_name(options), frame) : options.output;
        Control control = bar.control(interrupt, static_cast<std::size_t>(frame), static_cast<std::size_t>(frames));
        watch.restart();
        const Rendering rendering = render(view, control);
        context.render_seconds = watch.lap();
        bar.finish();
        write_rendering(output, rendering, write_options);
        context.write_seconds = watch.lap();
        all_statistics.push_back(statistics_json(context, rendering.statistics));
        if (!options.quiet) print_summary(context, rendering, output);
    }
    if (is_video(options.output) && !interrupt.raised()) write_video(options.output, frames);
    if (!options.stats.empty() && !all_statistics.empty())
        write_json(options.stats, options.orbit > 0 ? all_statistics : all_statistics[0]);
    return interrupt.raised() ? kExitInterrupted : kExitOk;
}

} // namespace

void add_scene_options(CommandLine& program, SceneOptions& options) {
    program.add("--size", options.size, "Image size WIDTHxHEIGHT (default: the scene's)");
    program
        .add_parsed(
            "--up",
            [&options](const std::vector<std::string>& axes) {
                static constexpr NameTable<UpAxis, 3> kAxes{
                    "--up", {{{"x", UpAxis::kX}, {"y", UpAxis::kY}, {"z", UpAxis::kZ}}}};
                options.up = kAxes.value(axes.back());
            },
            "The axis of a bare mesh that points up: x, y or z (default: z for a mesh that is flat below along z "
            "alone, else y)")
        .repeatable();
}

int run_render_program(const RenderProgram& program, int argc, char** argv) {
    return run_program(program.name, [&] {
        CommandLine command_line(program.name, program.description);
        std::string footer = "Examples:\n";
        for (const std::string& example : program.examples) footer += "  " + example + "\n";
        command_line.set_footer(footer +
                                "\nExit codes: 0 done, 1 failed, 2 unusable arguments or input, 130 interrupted "
                                "(what is done is written).");
        Options options;
        add_common_options(command_line, options, program.spp_help);
        program.add_options(command_line);
        const std::optional<int> exit_code = command_line.parse(argc, argv);
        limit_memory();
        return exit_code ? *exit_code : render_all(program, options);
    });
}

AovSet parse_aovs(std::string_view list) {
    static constexpr NameTable<bool AovSet::*, 6> kNames{"--aov",
                                                         {{{"depth", &AovSet::depth},
                                                           {"normal", &AovSet::normal},
                                                           {"albedo", &AovSet::albedo},
                                                           {"hit", &AovSet::hit},
                                                           {"variance", &AovSet::variance},
                                                           {"samples", &AovSet::samples}}}};
    AovSet set;
    while (!list.empty()) {
        const std::string_view name = list.substr(0, list.find(','));
        list.remove_prefix(std::min(list.size(), name.size() + 1));
        set.*kNames.value(name) = true;
    }
    return set;
}

} // namespace duet
