// The built-in shadings, as programs.
#pragma once

#include "raster/render.h"
#include "raster/shader/strip_shader.h"

#include <memory>

namespace duet::raster {

/// Of Settings::shading, as a camera sees; null for Shading::kLit, which is no program (raster/shade.h).
std::unique_ptr<Program> program(Shading shading, const Camera& camera);

// A file each.
std::unique_ptr<Program> phong_program();
std::unique_ptr<Program> gouraud_program();
std::unique_ptr<Program> flat_program();
std::unique_ptr<Program> toon_program();
std::unique_ptr<Program> wireframe_program();
std::unique_ptr<Program> normal_program();
std::unique_ptr<Program> smooth_normal_program(); ///< of normal.cpp, whatever maps say: what edges are drawn by
std::unique_ptr<Program> albedo_program();
std::unique_ptr<Program> depth_program(const Camera& camera);

} // namespace duet::raster
