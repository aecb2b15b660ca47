// This file lists the skips of both pipelines, each as a case that can be rendered with and without the skip.
#pragma once

#include "compare/renderer.h"

#include <functional>
#include <string>
#include <vector>

namespace duet::compare {

/// Selects how a skip is proved to preserve the image.
enum class SkipProof {
    kSameBits, ///< every image is the same to the last bit
    kNoBias,   ///< the expected image is the same, by a test that finds a bias of 0.1 % with 99 % power
};

/// A SkipCase is a skip to be measured.
struct SkipCase {
    std::string pipeline, name; ///< "raster" or "raytrace"; name on the command line and in JSON
    std::string omitted;        ///< description of what the skip omits
    std::string statistic;      ///< name in RenderStatistics::skipped; empty: none
    SkipProof proof = SkipProof::kSameBits;
    /// Renders one image with or without the skip.
    std::function<Rendering(const View& view, std::uint64_t seed, bool with, Control& control)> render;
};

/// Returns all skips of both pipelines, in order, for one scene, which must outlive them.
std::vector<SkipCase> skip_cases(const Scene& scene, const ComparisonSettings& settings);
} // namespace duet::compare
