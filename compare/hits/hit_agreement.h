// Do the two pipelines see the same primitive in every pixel, at the same distance? And where not: why?
#pragma once

#include "common/camera/camera.h"
#include "common/image/image.h"
#include "common/scene/scene.h"
#include "compare/hits/exact_trace.h"

#include <cstdint>
#include <vector>

namespace duet::compare {

enum class Verdict : std::uint8_t {
    kSame,     ///< same object and primitive, or nothing in both
    kEdge,     ///< double-precision rays within 1/128 pixel of the centre return the one and the other
    kDepthTie, ///< the double-precision ray meets both at the same distance, within kDepthTolerance; or as kEdge, but
               ///< one of the two is met just where the other or a neighbour hides it (kMeetingTolerance in
               ///< edge_search.h)
    kUnexplained ///< neither: one of the pipelines is wrong
};

/// Distances are equal where |Δt|·|cos θ| ≤ kDepthTolerance·t.
inline constexpr double kDepthTolerance = 1e-5;

/// A pixel whose hits differ without explanation.
struct UnexplainedPixel {
    int x = 0, y = 0;
    Hit raster, raytrace;
    ExactHit exact; ///< what the double-precision ray through the centre returns
};

struct HitAgreement {
    std::int64_t pixels = 0, same = 0, edge = 0, depth_tie = 0, unexplained = 0; ///< pixels is the sum of the others
    Image<Verdict> verdicts;
    std::vector<UnexplainedPixel> listed; ///< the first kListed unexplained ones, from the top
    // Distances where both pipelines see the same primitive:
    double worst_distance = 0;            ///< largest |Δt|·|cos θ| / t
    int worst_x = 0, worst_y = 0;         ///< the first pixel that has it
    std::int64_t distance_violations = 0; ///< pixels over kDepthTolerance, or without a finite distance
};
inline constexpr std::size_t kListed = 100;

/// Judges two images of hits of one view, each made with one ray at each pixel's centre, through the lens's centre, as
/// the shutter opens. Throws Error where an image isn't of the view's size or names a primitive that the scene doesn't
/// have.
HitAgreement compare_hits(const Scene& scene, const View& view, const Image<Hit>& raster, const Image<Hit>& raytrace,
                          int threads = 0);

} // namespace duet::compare
