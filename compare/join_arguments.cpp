// This file declares the command-line arguments of `compare join`.
#include "compare/arguments.h"
#include "compare/join.h"

namespace duet::compare {

void add_join(CommandLine& program) {
    CommandLine& join = program.add_subcommand("join", "Put images of one size side by side, or in bands");
    JoinOptions& options = set_action(join, join_images);
    join.add("IMAGES", options.images, "Images (PNG, JPEG, TGA, PPM, PFM, HDR, EXR)").required();
    join.add("-o,--output", options.output, "The image: .png, .jpg, .tga, .ppm, .pfm, .hdr or .exr").required();
    join.add("--columns", options.columns, "Columns of the grid (default: all images in one row)").range(1, 1024);
    join.add("--gap", options.gap, "White pixels between images (default 0)").range(0, 1024);
    join.add_flag("--bands", options.bands,
                  "One image of their size: a band of each, from left to right");
    join.add("--slant", options.slant_degrees, "Degrees by which the bands lean to the right (default 0)")
        .number_range(-80, 80, "a number from -80 to 80")
        .needs("--bands");
    add_view_transform(join, options.view_transform);
    set_footer(join, "Example:\n  compare join out/raster.png out/raytrace.png -o both.jpg --bands --slant 10 --gap 2");
}

} // namespace duet::compare
