// This file defines the render program that both pipelines share (`SCENE -o OUT`): options, loading, rendering,
// writing and statistics.
#pragma once

#include "common/camera/camera.h"
#include "common/image/stored_image.h"
#include "common/program/command_line.h"
#include "common/program/scene_options.h"
#include "common/rendering.h"
#include "common/scene/default_scene.h"
#include "common/scene/scene.h"
#include "common/system/control.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace duet {

/// A RenderFunction renders one prepared scene from any number of views.
using RenderFunction = std::function<Rendering(const View&, Control&)>;

/// Adds --size and --up. `options` must outlive the parsing.
void add_scene_options(CommandLine& program, SceneOptions& options);

/// OutputOptions say where the images are written.
struct OutputOptions {
    std::string path;
    int frames = 0; ///< number of frames of an orbit; 0: a single image
};

/// A RenderProgram holds what a pipeline adds to the common program.
struct RenderProgram {
    std::string name, description;
    std::vector<std::string> examples; ///< command lines, for --help
    std::string spp_help;              ///< help text of --spp: its meaning for this pipeline, and its default
    /// Adds the pipeline's own options.
    std::function<void(CommandLine&)> add_options;
    /// Where wants_text_output returns true, the program prints text_output() of the view instead of rendering it. Both
    /// functions may be empty.
    std::function<bool()> wants_text_output;
    std::function<std::string(const Scene&, const View&, const RenderSettings&, std::optional<int> spp)> text_output;
    /// Throws Error for unusable options of the pipeline, before anything is loaded. It may be empty.
    std::function<void(const OutputOptions&)> check;
    /// Prepares the scene for rendering. `settings` are the common options, and `spp` is empty where --spp was not
    /// given.
    std::function<RenderFunction(const Scene&, const RenderSettings& settings, std::optional<int> spp)> prepare;
};

/// Runs the whole program as the body of main, and returns an exit code of program.h.
int run_render_program(const RenderProgram& program, int argc, char** argv);

/// Parses a list of AOVs, a subset of "depth,normal,albedo,hit,variance,samples". Throws Error for another name.
AovSet parse_aovs(std::string_view list);

/// Returns the path of the undenoised image beside a denoised one: `STEM.noisy.EXTENSION`.
std::filesystem::path undenoised_path(const std::filesystem::path& path);

/// Writes the image to `path`, and its auxiliary images (AOVs). In an EXR file they are further channels. For other
/// formats each AOV is written to an EXR file beside the image, `STEM.NAME.exr`. Of a denoised rendering, first the
/// undenoised image is written to undenoised_path, and then the denoised one to `path`.
void write_rendering(const std::filesystem::path& path, const Rendering& rendering, const WriteOptions& options = {});

} // namespace duet
