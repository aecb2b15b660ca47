// This file reads the transforms of scene files: lists of steps that are applied in order.
#pragma once

#include "common/scene/json/json_reader.h"
#include "common/vec/matrix.h"

namespace duet {

/// A MotionTransform is a map at the start and at the end of an object's motion. For a static object both are equal.
struct MotionTransform {
    Mat4d start, end;
    bool moving = false;

    /// Returns this map applied after `inner`, at both ends of the motion.
    MotionTransform operator*(const MotionTransform& inner) const;
};

/// Reads the transform of an object from its keys "transform" and "transform_end", which are both optional. Throws
/// Error where transform_error returns a reason.
MotionTransform read_motion(const JsonValue& object);

/// Returns the reason why the transform cannot place objects, or nullptr where it can. Reasons are an entry of a map
/// or its inverse beyond 1e18, and a map that is singular to working precision at some time of the motion.
const char* transform_error(const MotionTransform& transform);

} // namespace duet
