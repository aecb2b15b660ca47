// The rays that all kernels trace: those of a renderer's first two segments, in the order in which it visits pixels.
#pragma once

#include "compare/kernels/kernel_scene.h"
#include "raytrace/acceleration/accelerator.h"

#include <span>
#include <vector>

namespace duet::compare {

/// Pixels are visited in tiles of kTile × kTile from the upper left: each in rows, or along a Z-curve (Morton 1966),
/// the order in which the path tracer traces camera rays in bulk. On the curve 16 rays on end are 4 × 4 pixels.
enum class PixelOrder { kRows, kZCurve };
inline constexpr int kTile = 16;

/// One ray through the centre of each pixel.
std::vector<Ray> camera_rays(const Camera& camera, int width, int height, PixelOrder order, int threads);

/// From each of the rays' first hits, in their order, one ray with density cos θ / π about the geometric normal, on the
/// side the ray came from. It starts as a path's next ray does: off the surface by the hit's own error bound. The
/// numbers drawn depend on the seed and the ray's index alone.
std::vector<Ray> bounce_rays(const KernelScene& scene, const raytrace::Accelerator& accelerator,
                             std::span<const Ray> rays, std::uint64_t seed, int threads);

/// Rays, and what each is aimed at.
struct ShadowRays {
    std::vector<Ray> rays; ///< t_max is just short of the light, for kernels that know no other way not to meet it
    std::vector<Hit> ends; ///< as in the path tracer: the light's own triangle, which does not block, and its distance
};
/// From each first hit one ray to a point on a light: the scene's lights take turns. Hits that face away from the
/// point, or that the light cannot reach, send none, as in the path tracer. A light that is no triangle of the scene
/// (a sun, a lamp above a mesh that stands alone) is a mere distance at the end.
ShadowRays shadow_rays(const KernelScene& scene, const raytrace::Accelerator& accelerator, std::span<const Ray> rays,
                       std::uint64_t seed, int threads);

} // namespace duet::compare
