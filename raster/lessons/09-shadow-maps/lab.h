// Lab 09: shadow maps.
#pragma once

#include "common/image/image.h"
#include "common/vec/matrix.h"
#include "tests/grading/lab.h"

namespace duet::lab {

/// The depths that the sun sees in a cube of the world.
struct ShadowMap {
    Mat4 clip_from_world; ///< to x and y in [-1, 1] (y up) and depths in [0, 1]; w is 1
    float size = 1;       ///< of the cube, in meters: its width, its height, and the distance from depth 0 to depth 1
    ImageFloat depth;     ///< square; at the center of each texel, row 0 at the top; infinity where nothing is
};

/// World space to the clip space of the sun, for a map that holds the sphere about `center`: its points have x and y in
/// [-1, 1], depth 0 at the point nearest to the sun, and depth 1 at the farthest. to_sun has length 1 and leads toward
/// the sun, in any direction, also straight up. The image may be turned about the sun's direction, but not mirrored.
Mat4 sun_matrix(Vec3 to_sun, Vec3 center, float radius);

/// Whether something lies between p and the sun: whether the depth of p, after p was moved toward the sun by `bias`
/// meters, is greater than that of the texel in which p lies. Points beside the map are lit.
bool in_shadow(const ShadowMap& map, Vec3 p, float bias);

/// The smallest bias, in meters, with which no flat surface shades itself: (reach + 1/2) · √2 · texel · tan θ, where θ
/// is the angle between the unit vectors n and to_sun. A cosine below 0.1 counts as 0.1. Never negative, and always a
/// number, also where rounding has made the cosine a little greater than 1. `texel` is the side of a texel in meters.
float slope_bias(float texel, Vec3 to_sun, Vec3 n, int reach);

/// The fraction of the texels around p that say that p is lit: of (2 reach + 1)² texels, up to `reach` to each side of
/// the one in which p lies. Texels beside the map say so, too.
float lit_fraction(const ShadowMap& map, Vec3 p, float bias, int reach);

/// The sunlight at each pixel of a view: the cosine between the normal and to_sun, times the lit fraction with the
/// slope bias; 0 where the cosine is not positive. Pixels whose normal is (0, 0, 0) show nothing: 0. Other normals have
/// length 1. The result is as large as `points`.
ImageFloat sunlight(const ShadowMap& map, Vec3 to_sun, const Image<Vec3>& points, const Image<Vec3>& normals,
                    int reach);

} // namespace duet::lab

DUET_LAB(sun_matrix, in_shadow, slope_bias, lit_fraction, sunlight)
