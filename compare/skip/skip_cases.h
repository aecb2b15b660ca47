// The skips of both pipelines, each as something that can be rendered with and without.
#pragma once

#include "common/camera/camera.h"
#include "common/film/rendering.h"
#include "common/scene/scene.h"
#include "common/system/control.h"

#include <functional>
#include <string>
#include <vector>

namespace duet::compare {

/// How a skip is proved to leave the picture as it is.
enum class SkipProof {
    kSameBits, ///< every picture is the same to the last bit
    kNoBias,   ///< the expected picture is: a test that finds a bias of 0.1 % with 99 % power
};

/// A skip to be measured.
struct SkipCase {
    std::string pipeline, name; ///< "raster" or "raytrace"; as the command line and the JSON call it
    std::string left_out;       ///< what, in words
    std::string statistic;      ///< its name in RenderStatistics::skipped; empty: it has none
    SkipProof proof = SkipProof::kSameBits;
    /// One picture, with the skip or without it.
    std::function<Rendering(const View& view, std::uint64_t seed, bool with, Control& control)> render;
};

/// A skip of design that a pipeline does not have.
struct MissingSkip {
    std::string pipeline, name;
};

struct SkipSettings {
    int raster_spp = 4, raytrace_spp = 4;
    int threads = 0; ///< 0: all
};

/// All skips of both pipelines, in order, for one scene, which must outlive them.
std::vector<SkipCase> skip_cases(const Scene& scene, const SkipSettings& settings);
/// What is not built: occluded triangles and tiles, converged pixels.
std::vector<MissingSkip> missing_skips();

} // namespace duet::compare
