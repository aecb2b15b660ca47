// This file describes what lies under the pointer.
#pragma once

#include "common/image/rgb.h"
#include "common/scene/scene.h"

#include <string>

namespace duet::compare {

/// Returns a number as text with four significant digits.
std::string number_text(double value);
/// Returns the three components of a linear color as text.
std::string color_text(Rgb color);
/// Returns a hit's object, primitive and distance as text.
std::string hit_text(const Scene& scene, const Hit& hit);
/// Returns the bounds of the objects that belong to an entry of the scene file's "objects"; empty for none.
Box3 entry_bounds(const Scene& scene, std::size_t entry);
/// Returns the name of the material at a valid hit.
std::string material_text(const Scene& scene, const Hit& hit);

} // namespace duet::compare
