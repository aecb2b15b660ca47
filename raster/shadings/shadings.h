// Implements the built-in shadings as programs.
#pragma once

#include "raster/render.h"
#include "raster/shader/strip_shader.h"

#include <memory>

namespace duet::raster {

/// Returns the program of a shading for a camera; null for Shading::kLit, which has no program (raster/shade.h).
std::unique_ptr<Program> program(Shading shading, const Camera& camera);

// Each program is defined in a file of the same name.
std::unique_ptr<Program> phong_program();
std::unique_ptr<Program> gouraud_program();
std::unique_ptr<Program> flat_program();
std::unique_ptr<Program> toon_program();
std::unique_ptr<Program> wireframe_program();
std::unique_ptr<Program> normal_program();
std::unique_ptr<Program> smooth_normal_program(); ///< in normal.cpp; ignores normal and bump maps, for edge detection
std::unique_ptr<Program> albedo_program();
std::unique_ptr<Program> depth_program(const Camera& camera);

} // namespace duet::raster
