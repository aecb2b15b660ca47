// This file declares the edits of a scene that the window offers: each takes the text of a scene file and returns the
// changed text.
#pragma once

#include "common/vec/box.h"
#include "common/vec/matrix.h"
#include "compare/view/scene_text.h"

#include <array>
#include <nlohmann/json_fwd.hpp>

namespace duet::compare {

/// Moves an element of "objects", "lights" or "media" by a vector, in meters. For a shape without a transform, a light
/// and a medium this changes the position; for any other object it changes the last translation or adds one. An element
/// that is everywhere stays as it is.
std::string moved(const std::string& text, const JsonPath& element, Vec3d by);
/// Applies an affine map to an element of "objects" after its own transform; successive maps become one matrix. For a
/// light, the map changes the position and the direction, and for a medium the corners of its box.
std::string transformed(const std::string& text, const JsonPath& element, const Mat4d& map);

/// Says by which handles an element can be changed.
struct Handles {
    bool move = false, turn = false, scale = false;
};
/// Returns what can be done to an element of "objects", "lights" or "media".
Handles handles(const nlohmann::ordered_json& scene, const JsonPath& element);
/// Returns the box of the points that determine the position of a light or a medium; empty for one that is everywhere.
Box3 place(const nlohmann::ordered_json& scene, const JsonPath& element);
/// Returns an object's own axes after its transform, made orthonormal: the first keeps its direction.
std::array<Vec3d, 3> local_axes(const nlohmann::ordered_json& scene, const JsonPath& element);
/// Adds a copy of an element at the end of its list.
std::string duplicated(const std::string& text, const JsonPath& element);

/// Gives an object, which has a "material", a copy of that material under a new name, so that later changes of the
/// material change this object alone.
std::string with_own_material(const std::string& text, const JsonPath& element);

/// Selects what is added to a scene.
enum class NewElement { kSphere, kBox, kQuad, kAreaLight, kPointLight, kCloud };
inline constexpr std::array kNewElementNames{"sphere", "box", "quad", "area light", "point light", "cloud"};
/// Adds an element of about this size at a point. An area light shines downward. Shapes get the first material of the
/// file, or a new one.
std::string with_new_element(const std::string& text, NewElement element, Vec3d at, double size);
/// Adds a mesh, at the position that its file gives.
std::string with_new_mesh(const std::string& text, const std::string& file);

/// Rounds to seven significant digits, which is what a float holds.
double typed_number(double x);

} // namespace duet::compare
