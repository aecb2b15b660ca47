// Renders a view with a custom shader.
#pragma once

#include "raster/render.h"
#include "raster/shader/program.h"

namespace duet::raster {

/// Renders like render(), with the two functions of a shader (raster/shader/shader.h) in place of a built-in
/// shading. Settings::shading and Settings::parts are ignored. The image is black where nothing is visible. Threads
/// share the shader, so its functions must be free of side effects. A radiance that is NaN, infinite or negative is
/// dropped and counted (RenderStatistics::invalid_samples). With Output::kSrgb8 and one sample per pixel it is
/// encoded as it is and not counted.
template <Shader S>
Rendering draw(const Prepared& prepared, const View& view, const Settings& settings, const S& shader,
               Control& control) {
    const ProgramOf<S> program(shader);
    Rendering result;
    render(prepared, view, settings, program, control, result);
    return result;
}

} // namespace duet::raster
