// Implements the built-in shadings as programs.
#pragma once

#include "common/system/name_table.h"
#include "raster/settings.h"
#include "raster/shader/packet_shader.h"

#include <memory>

namespace duet::raster {

/// The names of all shadings.
inline constexpr NameTable<Shading, 11> kShadings{"shading",
                                                  {{{"lit", Shading::kLit},
                                                    {"phong", Shading::kPhong},
                                                    {"gouraud", Shading::kGouraud},
                                                    {"flat", Shading::kFlat},
                                                    {"toon", Shading::kToon},
                                                    {"wireframe", Shading::kWireframe},
                                                    {"lines", Shading::kLines},
                                                    {"edges", Shading::kEdges},
                                                    {"normal", Shading::kNormal},
                                                    {"albedo", Shading::kAlbedo},
                                                    {"depth", Shading::kDepth}}}};

/// Returns the program of a shading for a camera; null for Shading::kLit, which has no program
/// (raster/shading/sample_attributes.h).
std::unique_ptr<ShaderProgram> built_in_program(Shading shading, const Camera& camera);

/// Returns the program of the shading of this name. It is defined in a file of the same name.
///@{
std::unique_ptr<ShaderProgram> phong_program();
std::unique_ptr<ShaderProgram> gouraud_program();
std::unique_ptr<ShaderProgram> flat_program();
std::unique_ptr<ShaderProgram> toon_program();
std::unique_ptr<ShaderProgram> wireframe_program();
std::unique_ptr<ShaderProgram> normal_program();
std::unique_ptr<ShaderProgram> albedo_program();
std::unique_ptr<ShaderProgram> depth_program(const Camera& camera);
///@}
/// Returns the program of normals without normal and bump maps, for edge detection. It is defined in
/// normal_shader.cpp.
std::unique_ptr<ShaderProgram> smooth_normal_program();

} // namespace duet::raster
