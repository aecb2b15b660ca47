// Lab 10: ambient occlusion.
#pragma once

#include "common/image/image.h"
#include "common/vec/matrix.h"
#include "tests/grading/lab.h"

#include <vector>

namespace duet::lab {

/// What a camera with perspective sees.
struct DepthImage {
    Mat4 clip_from_world; ///< x / w and y / w are in [-1, 1] in the image, y up; w is the distance in front of the eye
    ImageFloat distance;  ///< w of what each pixel shows, at its center; row 0 at the top; infinity where nothing is
};

/// How to look. Lengths are in meters.
struct Search {
    int steps = 4;       ///< points along each direction, 1 or more
    float radius = 0.4f; ///< of the farthest of them
    float bias = 0.01f, range = 0.4f;
};

/// A unit direction in the hemisphere about the unit vector n. For random u, uniform in [0, 1)², the density of the
/// directions is in proportion to their cosine with n (Malley's method is one way).
Vec3 hemisphere_direction(Vec3 n, Vec2 u);

/// Whether q lies behind what the image shows there: its w is greater than the pixel's distance by more than `bias`,
/// and by less than `range`. False where q isn't in front of the eye (w <= 0), or is outside of the image.
bool is_hidden(const DepthImage& seen, Vec3 q, float bias, float range);

/// The fraction of the directions in which at least one of the points p + d · radius · (k / steps)², k = 1 … steps, is
/// hidden. The directions are unit vectors. 0 if there are none.
float occlusion(const DepthImage& seen, Vec3 p, const std::vector<Vec3>& directions, const Search& search);

/// Each pixel becomes the mean of those of the (2 reach + 1)² pixels around it that are in the image and whose distance
/// differs from its own by at most `tolerance`; it is one of them itself. Both images have the same size.
ImageFloat blur(const ImageFloat& values, const ImageFloat& distance, int reach, float tolerance);

/// The occlusion at each pixel, by `count` directions a pixel, in any pattern, and with or without a blur. `points` and
/// `normals` say what the pixels show; where a normal is (0, 0, 0), there is nothing, and the occlusion is 0.
ImageFloat occlusion_image(const DepthImage& seen, const Image<Vec3>& points, const Image<Vec3>& normals, int count,
                           const Search& search);

} // namespace duet::lab

DUET_LAB(hemisphere_direction, is_hidden, occlusion, blur, occlusion_image)
