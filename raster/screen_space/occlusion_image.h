// This header declares the ambient occlusion of each pixel of an image.
#pragma once

#include "raster/screen_space/ambient_occlusion.h"

namespace duet::raster {

/// Stores the occlusion of the surfaces in a ScreenGBuffer, computed once per pixel for any number of samples. Each
/// pixel samples a few directions. The result is averaged over neighbors on the same surface: within one or two pixel
/// widths of its plane and with similar normals. A block of 8 × 8 pixels covers all directions (in small images,
/// where 8 pixels are wide, nearly a block of 4 × 4). The filter is separable, along rows and then columns. On a
/// plane it is the mean of all 64 patterns, and elsewhere a good approximation (Pham and van Vliet 2005, "Separable
/// Bilateral Filtering for Fast Video Preprocessing").
class OcclusionImage {
public:
    /// The G-buffer must outlive this object. The result is the same for any number of threads.
    OcclusionImage(const ScreenGBuffer& gbuffer, AmbientOcclusion kind, float radius, int threads);

    /// Returns the occlusion at a point (relative to the eye) in pixel (x, y), with its unit shading normal. It uses
    /// the stored value of this pixel or of its neighbors if they are on the same surface; otherwise it is computed
    /// for this point.
    SkyVisibility at(int x, int y, Vec3 p, Vec3 n) const;
    /// Computes the occlusion at any visible point.
    SkyVisibility evaluate(Vec3 p, Vec3 n) const;
    std::size_t memory_bytes() const { return planes_.front().size() * planes_.size() * sizeof(float); }

    static constexpr int kLines = 3, kSteps = 24;

private:
    /// The planes are the visible fraction and the three coordinates of SkyVisibility::hidden.
    using Planes = std::array<ImageFloat, 4>;

    SkyVisibilityT<Floats> evaluate(const OcclusionPoints& points, const OcclusionPattern& pattern) const;
    void evaluate_row(int y);
    /// Filters a row of pixels along rows, or down columns.
    void filter_row(int y, bool down, const Planes& from, Planes& to) const;
    float similarity(int x, int y, Vec3 p, Vec3 n, float tolerance) const;

    const ScreenGBuffer& gbuffer_;
    AmbientOcclusion kind_;
    float radius_;
    std::array<float, 7> kernel_; ///< filter weights by distance from the center
    Planes planes_;
};

} // namespace duet::raster
