// This header declares ambient occlusion estimated from the image's depths.
#pragma once

#include "raster/gbuffer/screen_gbuffer.h"
#include "raster/lighting/sky_visibility.h"
#include "raster/render.h"

namespace duet::raster {

/// Points are positions relative to the eye with unit shading normals and unit directions to the viewer.
struct OcclusionPoints {
    Vec3T<Floats> p, n, to_viewer;
};

/// A pattern is one of kPatterns sets of sample directions. The patterns of a block of 8 × 8 pixels together cover
/// all directions evenly. Those of each aligned sub-block of 4 × 4 or 2 × 2 pixels do so as well as their number
/// allows.
struct OcclusionPattern {
    static constexpr int kSide = 8, kPatterns = kSide * kSide;
    /// The first kOfPoint patterns cover all directions, which suffices for a single point.
    static constexpr int kOfPoint = 16;

    Ints which; ///< in [0, kPatterns)

    /// Returns the patterns of Floats::size pixels of a row, starting at column x.
    static OcclusionPattern of_row(int x, int y);
    /// Returns `first` and the following patterns, for one point.
    static OcclusionPattern of_point(int first);
};

/// Returns the unoccluded fraction of the hemisphere about the normal, within `radius` meters. It tests which sample
/// points in the hemisphere are behind the visible surface: screen-space ambient occlusion (Mittring 2007, "Finding
/// Next Gen: CryEngine 2", §8.5.4.3), with points restricted to the side above the surface (Filion and McNaughton
/// 2008, "StarCraft II: Effects & Techniques", §5.5). A surface occludes a point if it is above the receiver's plane,
/// so no depth bias is needed. Sample points are denser near the receiver. The method does not know the directions of
/// the occluders, so the result assumes that all directions are occluded equally.
SkyVisibilityT<Floats> screen_space_occlusion(const ScreenGBuffer& gbuffer, const OcclusionPoints& points,
                                              const OcclusionPattern& pattern, float radius);

/// Returns the unoccluded fraction from the horizons of the depth image along lines through the point, with the
/// cosine integrated between them in closed form: ground-truth ambient occlusion (Jimenez et al. 2016, "Practical
/// Realtime Strategies for Accurate Indirect Occlusion", §4). The directions are integrated in the same way, so the
/// result includes which fraction of the environment is occluded. It is exact where the image shows the whole scene and
/// the scene is a height field, up to the number of `lines` and of `steps` to each side. Horizons farther than
/// kFadeFrom, 0.75, of the radius fade out.
SkyVisibilityT<Floats> horizon_occlusion(const ScreenGBuffer& gbuffer, const OcclusionPoints& points,
                                         const OcclusionPattern& pattern, float radius, int lines, int steps);

} // namespace duet::raster
