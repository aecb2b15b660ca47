// This header declares the Gothic nave and the window that its tracery fills.
#pragma once

#include <filesystem>

namespace duet::models {

inline constexpr const char* kNaveFile = "generated/nave.obj";
inline constexpr const char* kTraceryFile = "generated/tracery.obj";

/// The window's half width, and the height of its arch's springing above the sill, in meters. The arch is equilateral:
/// the center of each side is the springing point of the other.
inline constexpr double kWindowHalf = 1.3, kWindowSpringing = 3.3;

/// Writes the nave's stone, without the tracery.
void write_nave(const std::filesystem::path& folder);
/// Writes the tracery of one window: x runs along the wall from the window's middle, y up from the sill, z outward.
void write_tracery(const std::filesystem::path& folder);

} // namespace duet::models
