// How much of the environment a point sees, guessed from the depths in the picture.
#pragma once

#include "raster/render.h"
#include "raster/screen/screen.h"
#include "raster/screen/sky_seen.h"

namespace duet::raster {

/// Points of the picture: their places relative to the eye, unit shading normals and ways to the viewer.
struct OcclusionPoints {
    Vec3T<Floats> p, n, to_viewer;
};

/// Where points look: each has one of kPatterns ways to, so that those of a block of 8 × 8 pixels together look
/// everywhere, evenly; and so, as well as so few can, do those of each aligned part of it of 4 × 4 or 2 × 2.
struct OcclusionPattern {
    static constexpr int kSide = 8, kPatterns = kSide * kSide;
    static constexpr int kOfPoint = 16; ///< the first so many look everywhere, too: enough for a point by itself

    Ints which; ///< in [0, kPatterns)

    /// Of Floats::size pixels of a row from column x on.
    static OcclusionPattern of_row(int x, int y);
    /// Patterns `first` and the following, of one point.
    static OcclusionPattern of_point(int first);
};

/// The part of the hemisphere about the normal that nothing hides within `radius` metres, by points in the hemisphere
/// that lie behind what the picture shows there: screen-space ambient occlusion (Mittring 2007, «Finding Next Gen:
/// CryEngine 2», §8.5.4.3), its points kept over the surface (Filion and McNaughton 2008, «StarCraft II: Effects &
/// Techniques», §5.5). What is seen hides a point where it stands over the receiver's plane: no depth bias need be
/// guessed. Points are denser near the receiver. Which directions are hidden it cannot tell: as many of all.
SkySeenT<Floats> screen_space_occlusion(const Screen& screen, const OcclusionPoints& points, const OcclusionPattern& pattern,
                                        float radius);

/// The same by the horizons that the picture's depths form along lines across it, the cosine between them integrated
/// in closed form: ground-truth ambient occlusion (Jimenez et al. 2016, «Practical Realtime Strategies for Accurate
/// Indirect Occlusion», §4); and likewise the directions themselves, which say what of the environment is hidden. Exact
/// where the picture shows all there is and that is a height field, up to the number of `lines` and of `steps` to each
/// side. Horizons farther than half the radius count less and less.
SkySeenT<Floats> horizon_occlusion(const Screen& screen, const OcclusionPoints& points, const OcclusionPattern& pattern,
                                   float radius, int lines, int steps);

} // namespace duet::raster
