// Which texels a sample averages: a line of equal, round probes along its footprint.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// More than this many times longer than wide, a footprint is widened: the picture blurs rather than shimmers.
inline constexpr int kMaxProbes = 16;

/// `count` probes, `step` texels of the image apart. A probe interpolates between two sizes of the image, `level` times
/// halved and once more, weighed 1 − blend and blend; each is looked up bilinearly.
struct ProbeLine {
    int count = 1;
    Vec2d step;
    int level = 0;
    float blend = 0;
};

/// Of the parallelogram spanned by a sample's steps along the picture's x and y, in texels. The probes have the second
/// moments of its box filter: the width across and, as long as max_probes suffices, the length along its axes (the ellipse
/// of Heckbert 1989, «Fundamentals of Texture Mapping and Image Warping», §3.5.8, here of equal covariance; probes along
/// its major axis after McCormack et al. 1999, «Feline: Fast Elliptical Lines for Anisotropic Texture Mapping»). Where a
/// texel is larger than that: one bilinear look-up of the image itself. Steps that are not finite give the smallest
/// size.
ProbeLine probe_line(Vec2d dx, Vec2d dy, int max_probes);

} // namespace duet
