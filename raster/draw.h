// Renders a view with a custom shader.
#pragma once

#include "raster/render.h"
#include "raster/shader/shader_program.h"

namespace duet::raster {

/// Renders like render(), with the two functions of a shader (raster/visibility/shader.h) in place of a built-in
/// shading. RasterSettings::shading and RasterSettings::components are ignored. The image is black where nothing is
/// visible.
/// Threads share the shader, so its functions must be free of side effects. A radiance that is NaN, infinite or
/// negative is dropped and counted (RenderStatistics::invalid_samples). With Output::kSrgb8 and one sample per pixel it
/// is encoded as it is and not counted.
template <Shader S>
Rendering draw(const RasterScene& prepared, const View& view, const RasterSettings& settings, const S& shader,
               Control& control) {
    const ShaderProgramOf<S> program(shader);
    Rendering result;
    render(prepared, view, settings, program, control, result);
    return result;
}

} // namespace duet::raster
