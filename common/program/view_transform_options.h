// This file adds the options of the view transform (common/image/view_transform.h) to a command line.
#pragma once

#include "common/image/view_transform.h"
#include "common/program/command_line.h"

#include <optional>

namespace duet {

/// These are the values of --exposure, --tone and --dither, where they were given.
struct ViewTransformOptions {
    std::optional<double> exposure;
    std::optional<Tone> tone;
    std::optional<bool> dither;

    /// Returns the view transform of a scene with the values that were given on the command line.
    ViewTransform applied_to(ViewTransform scene) const;
};

/// Adds the options. `options` must outlive the parsing.
void add_view_transform(CommandLine& program, ViewTransformOptions& options);

} // namespace duet
