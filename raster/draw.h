// A view drawn with a shader of the caller's.
#pragma once

#include "raster/render.h"
#include "raster/shader/program.h"

namespace duet::raster {

/// render() by raster/shader/shader.h's two functions in place of a built-in shading: Settings::shading and Settings::parts are
/// not asked. Where nothing is seen the picture is black. Threads share the shader, whose functions must be free of
/// side effects. A radiance that is NaN, infinite or negative is dropped and counted (RenderStatistics::invalid_samples); with
/// Output::kSrgb8 it is encoded as it is, and not counted.
template <Shader S>
Rendering draw(const Prepared& prepared, const View& view, const Settings& settings, const S& shader, Control& control) {
    const ProgramOf<S> program(shader);
    Rendering result;
    render(prepared, view, settings, program, control, result);
    return result;
}

} // namespace duet::raster
