// `raytrace --pixel`: one sample of one pixel, told readably.
#pragma once

#include "raytrace/render.h"

#include <string>

namespace duet::raytrace {

/// One sample of one pixel.
struct SampleName {
    int x = 0, y = 0;
    std::uint32_t index = 0;
};
/// "x,y" or "x,y,sample"; throws Error for anything else.
SampleName parse_sample_name(const std::string& text);

/// Renders that sample as render() does, to the same bits, and tells what happens on its way, in lines of text. Throws
/// Error for a pixel outside the picture.
std::string explain(const Prepared& prepared, const View& view, const Settings& settings, const SampleName& name);

} // namespace duet::raytrace
