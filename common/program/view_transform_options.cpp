#include "common/program/view_transform_options.h"

namespace duet {

ViewTransform ViewTransformOptions::applied_to(ViewTransform scene) const {
    const float stops = exposure ? static_cast<float>(*exposure) : scene.exposure;
    return {stops, tone.value_or(scene.tone), dither.value_or(scene.dither)};
}

void add_view_transform(CommandLine& program, ViewTransformOptions& options) {
    program.add("--exposure", options.exposure, "Stops by which 8-bit images are brighter (default: the scene's, or 0)")
        .number_range(-kMaxExposure, kMaxExposure, "a number of stops in [-32, 32]");
    program
        .add_parsed(
            "--tone", [&options](const std::vector<std::string>& names) { options.tone = kTones.value(names.back()); },
            "Tone curve of 8-bit images: none, filmic or agx (default: the scene's, or none, which clips)")
        .repeatable();
    program.add_flag("--dither,!--no-dither", options.dither,
                     "Add noise of one code to 8-bit images, which hides the steps of slow gradients (default: as the "
                     "scene says, or not)");
}

} // namespace duet
