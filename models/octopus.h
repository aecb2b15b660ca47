// This header declares the octopus, and the positions of its eyes and of its ball, where the scene places spheres.
#pragma once

#include "common/vec/vec.h"

#include <filesystem>

namespace duet::models {

inline constexpr const char* kOctopusFile = "generated/octopus.obj";
inline constexpr const char* kOctopusSmallFile = "generated/octopus-hundred-thousand.obj";
inline constexpr const char* kOctopusMillionFile = "generated/octopus-million.obj";
inline constexpr const char* kOctopusFineFile = "generated/octopus-fine.obj";

/// The eyes are spheres at (±x, y, z).
inline constexpr double kEyeX = 0.245, kEyeY = 0.82, kEyeZ = 0.17, kEyeRadius = 0.1;
/// The right eye's lids open in this direction.
inline constexpr Vec3d kEyeGaze{0.62, 0.02, 0.78};
/// One arm winds around this ball.
inline constexpr Vec3d kBallCenter{0.72, 0.40, 0.78};
inline constexpr double kBallRadius = 0.28;

/// Writes the octopus's mesh below the folder. A number in a name is that of the triangles, rounded.
///@{
void write_octopus(const std::filesystem::path& folder);
void write_octopus_hundred_thousand(const std::filesystem::path& folder);
void write_octopus_million(const std::filesystem::path& folder);
void write_octopus_fine(const std::filesystem::path& folder);
///@}

} // namespace duet::models
