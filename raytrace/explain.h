// explain() implements `raytrace --pixel`, which prints what happens along the path of one sample of one pixel.
#pragma once

#include "raytrace/render.h"

#include <string>

namespace duet::raytrace {

/// Names one sample of one pixel, as named on the command line.
struct SampleName {
    int x = 0, y = 0;
    std::uint32_t index = 0;
};
/// Parses "x,y" or "x,y,sample", where the default sample is 0. Throws Error for anything else.
SampleName parse_sample_name(const std::string& text);

/// Renders the named sample bit-equal to render(), and returns lines of text about what happens along its path.
/// Throws Error for a pixel outside the image.
std::string explain(const Prepared& prepared, const View& view, const Settings& settings, const SampleName& name);

} // namespace duet::raytrace
