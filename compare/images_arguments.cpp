// This file declares the command-line arguments of `compare images`.
#include "compare/arguments.h"
#include "compare/images.h"
#include "compare/metrics/limits.h"

namespace duet::compare {

void add_images(CommandLine& program) {
    CommandLine& images = program.add_subcommand("images", "Compare two image files");
    ImagesOptions& options = set_action(images, compare::compare_images);
    images.add("A", options.a, "An image (PNG, JPEG, TGA, PPM, PFM, HDR, EXR)").required();
    images.add("B", options.reference, "The reference, of the same size").required();
    images
        .add("--fail-above", options.limits,
             "METRIC=VALUE: exit with 1 where the metric is above VALUE, or, of psnr, ssim and z_p, below it; "
             "may be given more than once")
        .repeatable();
    images.add_flag("--decode", options.decode,
                    "Decode 8-bit files by the sRGB curve and compare linear values throughout: needed to compare an "
                    "8-bit file with a float one");
    images.add("-o,--output", options.folder,
               "A folder for the report page (index.html), difference.png and report.json");
    images.add("--stats", options.stats, "Write the figures as JSON to this file (-: standard output)");
    images.add("--threads", options.threads, "Threads (default: all)").range(1, 1024);
    images.add_flag("--quiet", options.quiet, "No table");
    set_footer(
        images,
        "Metrics: " + metric_names() +
            ".\n\nEXR, PFM and HDR files are linear radiance and so is all that is compared. Of 8-bit files mse, rmse, "
            "mae, psnr, ssim, worst and flip compare stored (sRGB-encoded) values, relmse, smape and mean_signed_error "
            "linear ones. Alpha is not compared; where it is not 1 the table says so. The z metrics need EXR files "
            "with variances (raytrace --aov variance) of two seeds." +
            "\n\nExample:\n  compare images out/raster.png out/raytrace.png --fail-above rmse=0.1 --fail-above "
            "ssim=0.8\n  compare images before.exr after.exr -o out\nthen open out/index.html in a browser.");
}

} // namespace duet::compare
