// Declares Metropolis light transport, a Markov chain over paths that stays longer at paths that carry much light. Once
// a path has found its way through a door ajar, similar paths follow (Veach and Guibas 1997; in primary sample space,
// Kelemen et al. 2002). A path is a pair of subpaths with all of their connections, as in bidirectional path tracing.
#pragma once

#include "raytrace/bidirectional/bidirectional.h"
#include "raytrace/render_pass.h"

#include <optional>
#include <vector>

namespace duet::raytrace {

/// Estimates the brightness of each tile of the image from a few paths.
class MetropolisPilot {
public:
    MetropolisPilot(const PassContext& context, const LightEmission& emission);

    /// Returns the weight of luminance at a pixel (row · width + column), which is the inverse of the brightness of the
    /// surrounding tile. Chains therefore do not stay where the image is bright, but visit all tiles about equally
    /// often, and noise is proportional to the brightness (Veach 1997, §11.4.3).
    double weight(std::uint32_t pixel) const { return weights_[tile(pixel)]; }
    /// Returns an estimate of the mean scalar contribution of a path, which is the weighted luminance of its splats.
    double mean_contribution() const { return mean_; }

private:
    std::vector<double> light_of_tiles(const PassContext& context, const LightEmission& emission, int paths) const;
    std::size_t tile(std::uint32_t pixel) const;
    double pixels_of_tile(std::size_t tile) const;

    int width_, height_, tiles_ = 1; ///< tiles per axis
    std::vector<double> weights_;    ///< indexed by tile
    double mean_ = 0;
};

/// Renders samples of all pixels. A sample of a pixel consists of an independent path and kStepsPerPixel steps of
/// Markov chains, which start at some of the independent paths of all pixels. Steps and independent paths both find all
/// light, and are combined by multiple importance sampling: steps find bright paths better, and independent paths dim
/// ones.
class Metropolis {
public:
    /// Keeps references to both arguments.
    Metropolis(const PassContext& context, const LightEmission& emission)
        : context_(context), emission_(emission), pilot_(context, emission) {}

    /// Returns an unbiased estimate of the radiance of all pixels, or nothing if it was stopped. The random samples
    /// depend on `index`, the index of the sample. Independent paths are added to the auxiliary images.
    std::optional<Image<Rgbd>> sample(std::uint32_t index) const;

    static constexpr int kStepsPerPixel = 8;

private:
    const PassContext& context_;
    const LightEmission& emission_;
    const MetropolisPilot pilot_;
};

} // namespace duet::raytrace
