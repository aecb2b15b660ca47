// This file reduces a scene that fails to the part that makes it fail.
#pragma once

#include "compare/stress/scenes/schema_values.h"

#include <functional>

namespace duet::compare {

/// Returns the scene without the members and elements that are not needed for the failure, and with numbers of few
/// digits. `fails` returns whether a scene still fails in the same way. It is not called after `seconds` have passed
/// (Zeller and Hildebrandt 2002, "Simplifying and Isolating Failure-Inducing Input", in its simplest form: one part at
/// a time).
Json reduce_scene(Json scene, double seconds, const std::function<bool(const Json&)>& fails);

} // namespace duet::compare
