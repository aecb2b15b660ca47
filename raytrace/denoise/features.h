// Declares the features, which are images of the camera rays' first hits. They have hardly any noise, and the denoiser
// fits the color to them.
#pragma once

#include "raytrace/denoise/planes.h"
#include "raytrace/render_plan.h"

namespace duet::raytrace {

/// The features of a pixel are albedo (3), shading normal (3), and the inverse depth, relative to its mean over the
/// image. All are 0 if a ray escapes. The inverse depth is used because it is linear in the image on a plane.
inline constexpr std::size_t kFeatures = 7;

/// The features of a pixel are means over this number of camera rays. It does not depend on the samples of the image:
/// rays that end at their first hit cost little, and noise of the features harms most where the image has few samples.
inline constexpr int kFeatureSamples = 16;

/// Traces camera rays to their first hit and returns the features. It uses rays of its own instead of the image's
/// samples, so that films need not store features, and continued or merged films can be denoised.
Planes trace_features(const RenderPlan& plan, const View& view, const PathTracerSettings& settings);

} // namespace duet::raytrace
