// Declares debug_pixel(), which implements `raytrace --pixel`. It prints what happens along the path of one sample of
// one pixel.
#pragma once

#include "raytrace/render.h"

#include <string>

namespace duet::raytrace {

/// Identifies one sample of one pixel, as given on the command line.
struct SampleId {
    int x = 0, y = 0;
    std::uint32_t index = 0;
};
/// Parses "x,y" or "x,y,sample", where the default sample is 0. Throws Error for anything else.
SampleId parse_sample_id(const std::string& text);

/// Renders the named sample bit-equal to render(), and returns lines of text about what happens along its path.
/// Throws Error for a pixel outside the image.
std::string debug_pixel(const PathTracerScene& prepared, const View& view, const PathTracerSettings& settings,
                        const SampleId& id);

} // namespace duet::raytrace
