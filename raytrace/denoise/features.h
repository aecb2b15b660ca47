// Features are images of what the camera rays hit. They have hardly any noise, and the denoiser fits the color to them.
#pragma once

#include "raytrace/denoise/planes.h"
#include "raytrace/render_plan.h"

namespace duet::raytrace {

/// The features of a pixel: albedo (3), shading normal (3), and the inverse of the depth, relative to its mean in the
/// image. All are 0 where a ray escapes. The inverse of the depth is used because on a plane it is linear in the image.
inline constexpr std::size_t kFeatures = 7;

/// The features of a pixel are means over this number of camera rays. It does not depend on the samples of the image:
/// rays that end at their first hit cost little, and noise of the features harms most where the image has few samples.
inline constexpr int kFeatureSamples = 16;

/// Traces camera rays as far as their first hit. They are rays of their own, not those of the image's samples. So a
/// film has to store no features, and one that was continued or merged can be denoised.
Planes trace_features(const RenderPlan& plan, const View& view, const PathTracerSettings& settings);

} // namespace duet::raytrace
