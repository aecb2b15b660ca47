// This file checks whether both pipelines hit the same primitive at the same distance in every pixel, and explains
// differences.
#pragma once

#include "common/camera/camera.h"
#include "common/image/image.h"
#include "common/scene/scene.h"
#include "compare/hits/reference_tracer.h"

#include <cstdint>
#include <string>
#include <vector>

namespace duet::compare {

enum class HitVerdict : std::uint8_t {
    kSame,       ///< same object and primitive, or both miss
    kEdge,       ///< double-precision rays within 1/128 pixel of the center, plus the rounding error, find both hits
    kDepthTie,   ///< the double-precision ray hits both at the same distance, within kDepthTolerance; or displaced rays
                 ///< find one, and hit the other within kTieTolerance of its occluder; or they find one, the
                 ///< undisplaced ray misses one, and the ranges of their distances overlap; or one is at the eye,
                 ///< within rounding
    kUnexplained ///< neither same, edge nor tie: one of the pipelines is wrong
};

/// Two distances to one primitive are equal if |Δt|·|cos θ| ≤ rounding + kDepthTolerance·max(t, reach). The reach is
/// the distance of the primitive's farthest corner from the eye times its aspect ratio: rounding the corners moves the
/// plane in proportion to it. The rounding is that of a ray traced in float (ReferenceTracer::ray_rounding).
inline constexpr double kDepthTolerance = 1e-5;

/// Describes a pixel whose hits differ without an explanation.
struct UnexplainedPixel {
    int x = 0, y = 0;
    Hit raster, raytrace;
    ReferenceHit exact; ///< closest hit of the double-precision ray through the pixel center

    /// Returns the pixel and its three hits, for a message.
    std::string describe() const;
};

/// Holds the verdicts on all pixels of two images of hits.
struct HitAgreement {
    std::int64_t pixels = 0, same = 0, edge = 0, depth_tie = 0, unexplained = 0; ///< pixels is the sum of the others
    Image<HitVerdict> verdicts;
    std::vector<UnexplainedPixel> listed; ///< the first kMaxListed unexplained pixels, from the top
    // The distances below are measured where both pipelines hit the same primitive.
    double worst_distance = 0;            ///< largest (|Δt|·|cos θ| − rounding) / max(t, reach)
    int worst_x = 0, worst_y = 0;         ///< the first pixel with that distance
    std::int64_t distance_violations = 0; ///< pixels over kDepthTolerance, or without a finite distance
};
inline constexpr std::size_t kMaxListed = 100;

/// Compares two images of hits of one view. Each must be made with one ray through each pixel's center and the
/// lens center, at the time when the shutter opens. `threads` 0 uses all. Throws Error if an image does not
/// have the view's size or names a primitive that is not in the scene.
HitAgreement compare_hits(const Scene& scene, const View& view, const Image<Hit>& raster, const Image<Hit>& raytrace,
                          int threads = 0);

} // namespace duet::compare
