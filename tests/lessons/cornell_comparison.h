// How far the paths of a lesson are from the published means of the Cornell box.
#pragma once

#include "raytrace/lessons/07-camera/camera.h"
#include "raytrace/lessons/10-cornell-box/quads.h"
#include "tests/support/cornell_means.h"

#include <algorithm>

namespace duet {

/// The camera of the published picture, which is 1 wide and high here.
inline lesson::Camera published_camera() {
    return lesson::Camera({.eye = {0, 1, 6.8f}, .look_at = {0, 1, 0}, .fov_degrees = 35}, 1, 1);
}

/// How many standard errors the sum over all blocks without the light is off, in the worst channel; the largest such
/// number of one block (of all), where 0.5 % are allowed on top, since the published means agree with each other only
/// so far; and the standard error of the sum, relative to it.
struct CornellComparison {
    double whole = 0, block = 0, relative_error = 0;
};

/// path(x, y, random) is the light of a random path from the point (x, y) of the picture.
template <typename Path> CornellComparison compare_with_published(int paths_a_block, const Path& path) {
    CornellComparison result;
    Rgbd difference, error2, published;
    for (const CornellBlock& block : published_means()) {
        lesson::Random random(static_cast<std::uint64_t>(1000 * block.row + block.column));
        Rgbd sum, squares;
        for (int i = 0; i < paths_a_block; ++i) {
            const float x = (static_cast<float>(block.column) + random.next()) / 16;
            const float y = (static_cast<float>(block.row) + random.next()) / 16;
            const Rgbd light(path(x, y, random));
            sum += light, squares += light * light;
        }
        const double n = paths_a_block;
        const Rgbd mean = sum / n, variance = (squares / n - mean * mean) / (n - 1); // of the mean
        if (!block.holds_light())                                                    // its edges are noisy
            difference += mean - block.mean, error2 += variance, published += block.mean;
        for (std::size_t c = 0; c < 3; ++c) {
            const double off = std::abs(mean[c] - block.mean[c]) - 0.005 * block.mean[c];
            result.block = std::max(result.block, off / std::sqrt(variance[c]));
        }
    }
    for (std::size_t c = 0; c < 3; ++c) {
        result.whole = std::max(result.whole, std::abs(difference[c]) / std::sqrt(error2[c]));
        result.relative_error = std::max(result.relative_error, std::sqrt(error2[c]) / published[c]);
    }
    return result;
}

} // namespace duet
