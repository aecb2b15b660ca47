// How much of the environment a point sees, guessed from the depths in the picture.
#pragma once

#include "raster/render.h"
#include "raster/screen.h"

#include <cstdint>

namespace duet::raster {

/// A point of the picture: its place relative to the eye, unit shading normal and unit way to the viewer.
struct OcclusionPoint {
    Vec3 p, n, to_viewer;
};

/// The part of the cosine-weighted hemisphere about the normal that nothing hides within `radius` metres, in [0, 1], by
/// points in the hemisphere that lie behind what the picture shows there: screen-space ambient occlusion (Mittring
/// 2007, «Finding Next Gen: CryEngine 2», §8.5.4.3), its points kept over the surface (Filion and McNaughton 2008,
/// «StarCraft II: Effects & Techniques», §5.5). What is seen hides a point where it stands over the receiver's plane:
/// no depth bias need be guessed. `samples` points, denser near the receiver, jittered by `key`.
float screen_space_occlusion(const Screen& screen, const OcclusionPoint& point, float radius, int samples,
                             std::uint64_t key);

/// The same by the horizons that the picture's depths form along lines across it, the cosine between them integrated
/// in closed form: ground-truth ambient occlusion (Jimenez et al. 2016, «Practical Realtime Strategies for Accurate
/// Indirect Occlusion», §4). Exact where the picture shows all there is and that is a height field, up to the number of
/// lines. Horizons farther than the radius count less and less.
float horizon_occlusion(const Screen& screen, const OcclusionPoint& point, float radius, int lines, int steps,
                        std::uint64_t key);

} // namespace duet::raster
