// This file declares the properties that the renderings of any valid scene must have.
#pragma once

#include "compare/renderer.h"

#include <string>

namespace duet::compare {

/// Says which requirement a scene fails first. Both texts are empty if it fails none.
struct CheckResult {
    std::string failure; ///< the requirement, without numbers, so that failures with one cause have the same text
    std::string details; ///< where, and which numbers
    bool failed() const { return !failure.empty(); }
};

/// Renders the scene with both pipelines and checks, in this order:
/// - where the pipelines hit different primitives, rays in double precision explain it (compare/hits);
/// - distances to the same primitive agree within kDepthTolerance;
/// - no sample is NaN, infinite or negative, nor is any pixel of an auxiliary image NaN;
/// - one and three threads give the same bits, in the image and in all auxiliary images.
CheckResult check_scene(const Scene& scene, const ComparisonSettings& settings);

/// Returns whether the images and all auxiliary images of two renderings are equal in every bit.
bool same_bits(const Rendering& a, const Rendering& b);

} // namespace duet::compare
