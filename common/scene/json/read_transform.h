// Transforms of scene files: lists of steps, applied in order.
#pragma once

#include "common/scene/json/json_reader.h"
#include "common/vec/matrix.h"

namespace duet {

/// A map at the start and at the end of its object's motion; equal for one that stands still.
struct MotionTransform {
    Mat4d start, end;
    bool moving = false;

    /// This map after `inner`, at both ends.
    MotionTransform operator*(const MotionTransform& inner) const;
};

/// The transform of an object of a scene file: its keys "transform" and "transform_end", both optional. Throws Error
/// where a map, or one that the motion passes through, is singular.
MotionTransform read_motion(const JsonValue& object);

/// Why objects cannot be placed by the transform, or nullptr: an entry or one of the inverse too large for float's
/// squares, or a map that is singular to working precision at some time of the motion.
const char* placement_fault(const MotionTransform& transform);

} // namespace duet
