// What lies under the pointer, as text.
#pragma once

#include "common/image/rgb.h"
#include "common/scene/scene.h"

#include <string>

namespace duet::compare {

/// Returns a number with four significant digits.
std::string number_text(double value);
/// Returns the three components of a linear color.
std::string color_text(Rgb color);
/// Returns a hit's object, primitive and distance.
std::string hit_text(const Scene& scene, const Hit& hit);
/// Returns the name of the material at a valid hit.
std::string material_text(const Scene& scene, const Hit& hit);

} // namespace duet::compare
