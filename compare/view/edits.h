// The edits of a scene that the window offers: each takes the text of a scene file and returns the changed text.
#pragma once

#include "common/vec/matrix.h"
#include "compare/view/scene_text.h"

namespace duet::compare {

/// Moves an element of "objects" by a vector, in meters. A shape without a transform gets another place, any other
/// object a last translation.
std::string moved(const std::string& text, const JsonPath& element, Vec3d by);
/// Applies an affine map to an element of "objects" after its own transform. Successive maps become one matrix.
std::string transformed(const std::string& text, const JsonPath& element, const Mat4d& map);
/// Adds a copy of an element at the end of its list.
std::string duplicated(const std::string& text, const JsonPath& element);

/// What can be added to a scene.
enum class NewElement { kSphere, kBox, kQuad, kAreaLight, kPointLight, kCloud };
inline constexpr std::array kNewElementNames{"sphere", "box", "quad", "area light", "point light", "cloud"};
/// Adds an element of about this size at a point. An area light shines downward. Shapes get the first material of the
/// file, or a new one.
std::string with_new_element(const std::string& text, NewElement element, Vec3d at, double size);
/// Adds a mesh, at its own place.
std::string with_new_mesh(const std::string& text, const std::string& file);

/// Rounds to seven significant digits, which is what a float holds.
double typed_number(double x);

} // namespace duet::compare
