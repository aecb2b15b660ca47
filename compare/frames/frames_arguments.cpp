// Command-line arguments of `compare frames`.
#include "common/program/render_program.h"
#include "compare/arguments.h"
#include "compare/frames/frames.h"

#include <CLI/CLI.hpp>
#include <map>
#include <memory>

namespace duet::compare {

Subcommand add_frames(CLI::App& app) {
    CLI::App* frames = app.add_subcommand("frames", "Measure the rasterizer's frames a second, beside Mesa's llvmpipe");
    const auto all = std::make_shared<FramesOptions>();
    const auto size = std::make_shared<std::string>();
    const auto no_peer = std::make_shared<bool>(false);
    FramesOptions& options = *all;
    frames->add_option("MESH", options.meshes, "Meshes (.obj)")->required();
    frames->add_option("--view", options.views, "whole, close (it fills most of the image) or both (default)")
        ->delimiter(',')
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, FrameView>{{"whole", FrameView::kWhole}, {"close", FrameView::kClose}}));
    frames->add_option("--work", options.works, "phong, depth (a depth-only pass) or both (default)")
        ->delimiter(',')
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, FrameWork>{{"phong", FrameWork::kPhong}, {"depth", FrameWork::kDepth}}));
    frames->add_option("--threads", options.threads,
                       "Numbers of threads, each bound to as many processors (default: 1 and all)")
        ->delimiter(',')
        ->check(CLI::Range(1, 1024));
    frames->add_option("--size", *size, "Image size WIDTHxHEIGHT (default 1920x1080)");
    frames->add_option("--repeats", options.settings.repeats,
                       "Repeats of each row, ours and the peer's in turns (default 9)")
        ->check(CLI::Range(1, 10000));
    frames->add_flag("--processor-time", options.settings.processor_time,
                     "Count the seconds of all processors instead of the clock's: on a machine that others use, too");
    frames->add_option(
        "--texture", options.texture,
        "An image for base color, by the meshes' texture coordinates (default: gray); the rasterizer alone is "
        "measured with it");
    frames->add_flag("--no-peer", *no_peer, "Measure the rasterizer alone");
    frames->add_option("-o,--output", options.folder, "A folder for the images of both");
    frames->add_option("--stats", options.stats, "Write the rows as JSON to this file (-: standard output)");
    frames->add_flag("--quiet", options.quiet, "No table, no progress bar");
    frames->footer(
        std::string("A frame is: clear, transform, shade by Phong's model with interpolated normals, encode to "
                    "8-bit sRGB in memory; back faces are culled. Both draw the same mesh by the same matrices "
                    "under the same light; where their images differ the exit code is 1. A ratio above 1 is "
                    "the rasterizer ahead.\n\nExample:\n  compare frames models/generated/octopus.obj "
                    "--threads 1 --view close") +
        kExitCodes);
    return {frames, [all, size, no_peer] {
                if (!size->empty()) {
                    const ImageSize parsed = parse_image_size(*size);
                    all->settings.width = parsed.width;
                    all->settings.height = parsed.height;
                }
                all->settings.peer = !*no_peer && all->texture.empty();
                return compare::frames(*all);
            }};
}

} // namespace duet::compare
