// This file declares the command-line arguments of `compare frames`.
#include "common/program/command_line.h"
#include "common/system/suggestion.h"
#include "compare/arguments.h"
#include "compare/frames/frames.h"

namespace duet::compare {

namespace {

// Returns the values of the names that an option was given. `all` lists the names in the order of the values. Throws
// Error for a name that is not among them.
template <typename Value>
std::vector<Value> parse_names(const char* option, const std::vector<std::string>& names,
                               const std::vector<std::string_view>& all) {
    std::vector<Value> values;
    for (const std::string& name : names) values.push_back(static_cast<Value>(name_index(option, name, all)));
    return values;
}

} // namespace

void add_frames(CommandLine& program) {
    CommandLine& frames =
        program.add_subcommand("frames", "Measure the rasterizer's frames a second, beside Mesa's llvmpipe");
    FramesOptions& options = set_action(frames, compare::frames);
    frames.add("FILE", options.files, "Meshes (.obj), or scene files (.json) for lit frames").required();
    frames
        .add_parsed(
            "--view",
            [&](const auto& names) {
                options.views = parse_names<FrameView>("--view", names, {"whole", "close"});
            },
            "whole, close (it fills most of the image) or both (default)")
        .comma_separated();
    frames
        .add_parsed(
            "--work",
            [&](const auto& names) {
                options.works = parse_names<FrameWork>("--work", names, {"phong", "depth"});
            },
            "phong, depth (a depth-only pass) or both (default)")
        .comma_separated();
    frames
        .add("--threads", options.threads, "Numbers of threads, each bound to as many processors (default: 1 and all)")
        .comma_separated()
        .range(1, 1024);
    frames.add("--size", options.settings.size, "Image size WIDTHxHEIGHT (default 1920x1080)");
    frames.add("--repeats", options.settings.repeats, "Repeats of each row, ours and the peer's in turns (default 9)")
        .range(1, 10000);
    frames.add_flag("--processor-time", options.settings.processor_time,
                    "Count the seconds of all processors instead of the clock's, for a computer that others use, too");
    frames.add("--texture", options.texture,
               "An image for base color, by the meshes' texture coordinates (default: gray); the rasterizer alone is "
               "measured with it");
    frames.add_flag("--no-peer", options.settings.no_peer, "Measure the rasterizer alone");
    frames.add("-o,--output", options.folder, "A folder for the images");
    frames.add("--stats", options.stats, "Write the rows as JSON to this file (-: standard output)");
    frames.add_flag("--quiet", options.quiet, "No table, no progress bar");
    set_footer(frames, "A frame is: clear, transform, shade by Phong's model with interpolated normals, encode to "
                       "8-bit sRGB in memory; back faces are culled. Both draw the same mesh by the same matrices "
                       "under the same light; where their images differ the exit code is 1. A ratio above 1 is "
                       "the rasterizer ahead.\n\nOf a scene file, the time of preparation, of whole lit frames and of "
                       "their stages (by the clock) is measured, without a peer; --view, --work and --texture are for "
                       "meshes.\n\n"
                       "Examples:\n  compare frames models/generated/octopus.obj --threads 1 --view close\n"
                       "  compare frames models/cornell.json models/demo.json");
}

} // namespace duet::compare
