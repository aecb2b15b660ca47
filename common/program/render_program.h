// The program `SCENE -o OUT`, the same for both pipelines: options, loading, rendering, writing, statistics.
#pragma once

#include "common/camera/camera.h"
#include "common/film/rendering.h"
#include "common/scene/scene.h"
#include "common/system/control.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace duet {

/// One prepared scene, ready for any number of views.
using RenderFunction = std::function<Rendering(const View&, Control&)>;

/// Where the pictures go.
struct OutputOptions {
    std::string path;
    int frames = 0; ///< of an orbit; 0: a single picture
};

/// What a pipeline adds to the common program.
struct RenderProgram {
    std::string name, description, example;
    std::string spp_help; ///< what --spp means here, and its default
    /// Adds the pipeline's own options.
    std::function<void(CLI::App&)> add_options;
    /// Where this says so, the program prints text() of the picture in place of rendering it; both may be empty.
    std::function<bool()> prints_text;
    std::function<std::string(const Scene&, const View&, const RenderSettings&, std::optional<int> spp)> text;
    /// Throws Error for options of its own that cannot be used, before anything is loaded; may be empty.
    std::function<void(const OutputOptions&)> check;
    /// Prepares the scene; `settings` are the common options, `spp` is empty where --spp was not given.
    std::function<RenderFunction(const Scene&, const RenderSettings& settings, std::optional<int> spp)> prepare;
};

/// main's body. Exit codes as in program.h.
int run_render_program(const RenderProgram& program, int argc, char** argv);

/// Parses a command line: 0 and proceed = true, or the exit code (0 after --help, 2 for unusable arguments).
struct ParsedCommandLine {
    bool proceed;
    int exit_code;
};
ParsedCommandLine parse_command_line(CLI::App& app, int argc, char** argv);

/// "640x480" → width and height, each in [1, kMaxPictureSide], at most kMaxImagePixels together; throws Error.
struct PictureSize {
    int width, height;
};
PictureSize parse_picture_size(std::string_view text);

/// "depth,normal,albedo,hit,variance,samples" → the set; throws Error for another name.
AovSet parse_aovs(std::string_view list);

/// The picture to `path`, and its auxiliary pictures: as channels of the file where it is an EXR, else each to an EXR
/// beside it, `STEM.NAME.exr`.
void write_rendering(const std::filesystem::path& path, const Rendering& rendering, bool ascii_ppm = false);

} // namespace duet
