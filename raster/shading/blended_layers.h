// Composites alpha-masked and alpha-blended surfaces in deferred shading. Each pixel's surfaces are peeled from front
// to back, with one G-buffer per layer (Everitt 2001, "Interactive Order-Independent Transparency"; here from sorted
// lists, in one pass).
#pragma once

#include "raster/gbuffer/gbuffer_pass.h"

#include "common/geometry/hit.h"

#include <vector>

namespace duet::raster {

/// Holds the blended surfaces in front of the visible surface of each pixel.
class BlendedLayers {
public:
    /// Fills the G-buffer by fill_gbuffer(), and finds the blended surfaces. The first fully opaque one of a pixel
    /// replaces the visible surface in the G-buffer.
    BlendedLayers(const SampleView& sample, GBuffer& gbuffer, Planes3& emission);

    /// Returns the greatest number of blended surfaces in a pixel.
    std::size_t count() const { return layers_.size(); }
    /// Stores the k-th surface from the front of each pixel; the other pixels become background.
    void fill(const SampleView& sample, std::size_t k, GBuffer& gbuffer, Planes3& emission) const;
    /// Adds the radiance of the k-th surfaces, weighted by their visibility.
    void add(std::size_t k, const Planes3& layer, Planes3& radiance) const;
    /// Multiplies the radiance of the visible surfaces by the transmittance of the blended surfaces in front of them.
    void attenuate(Planes3& radiance) const;

    /// Surfaces behind a smaller transmittance are left out. The error is below half a step of an 8-bit image for
    /// surfaces as bright as eight times white.
    static constexpr float kLeastTransmittance = 1.0f / 4096;

private:
    struct Surface {
        int x, y;
        Hit hit;
        float reversed_depth;
        float weight; ///< opacity times the transmittance of the surfaces in front
    };
    struct Attenuation {
        int x, y;
        float transmittance;
    };
    std::vector<std::vector<Surface>> layers_; ///< indexed from the front
    std::vector<Attenuation> attenuations_;
};

} // namespace duet::raster
