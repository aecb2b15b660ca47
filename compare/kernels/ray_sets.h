// This file generates the ray sets that all kernels trace: a renderer's first two path segments, in the order in which
// it visits pixels.
#pragma once

#include "compare/kernels/kernel_scene.h"
#include "raytrace/acceleration/accelerator.h"

#include <span>
#include <vector>

namespace duet::compare {

/// Selects the order of pixels. Tiles of kTile × kTile are visited from the upper left, each by rows or along a Z-order
/// curve (Morton 1966), in which the path tracer traces camera rays in batches. On the curve, 16 consecutive rays cover
/// 4 × 4 pixels.
enum class PixelOrder { kRows, kZCurve };
inline constexpr int kTile = 16;

/// Returns one ray through the center of each pixel.
std::vector<Ray> camera_rays(const Camera& camera, int width, int height, PixelOrder order, int threads);

/// Returns one ray from each first hit of `rays`, in order, with density cos θ / π around the geometric normal
/// on the side of the incoming ray. It starts as a path's next ray does, offset from the surface by the hit's
/// error bound. The random samples depend only on the seed and the ray's index.
std::vector<Ray> bounce_rays(const KernelScene& scene, const raytrace::Accelerator& accelerator,
                             std::span<const Ray> rays, std::uint64_t seed, int threads);

/// Holds shadow rays and their ends.
struct ShadowRays {
    std::vector<Ray> rays; ///< t_max is just short of the light, for kernels that cannot ignore the light's triangle
    std::vector<Hit> ends; ///< distance and, as in the path tracer, the light's own triangle, which does not block
};
/// Returns one ray from each first hit to a point on a light, using the scene's lights in turn. As in the path tracer,
/// there is no ray if the hit faces away from the point or the light cannot reach it. The end is only a distance for a
/// light that is not a triangle of the scene (a sun, or the light above a mesh that stands alone).
ShadowRays shadow_rays(const KernelScene& scene, const raytrace::Accelerator& accelerator, std::span<const Ray> rays,
                       std::uint64_t seed, int threads);

} // namespace duet::compare
