// Implements stage 9, resolve, which averages samples into pixels.
#pragma once

#include "common/rendering.h"
#include "raster/settings.h"
#include "raster/shading/sample_attributes.h"

#include <atomic>

namespace duet::raster {

/// Accumulates the image and the requested auxiliary images (AOVs). Each pixel is the mean of its samples. Threads
/// may add different tiles concurrently. The samples of a pixel are added in order, so the sums are the same for any
/// number of threads.
class Framebuffer {
public:
    /// `multiple_samples` allows several samples per pixel; otherwise at most one may be added.
    Framebuffer(const View& view, const RasterSettings& settings, bool multiple_samples);

    /// Adds the auxiliary values of one sample of a pixel. They come before its radiance.
    void add_aovs(const HitTile& tile, int x, int y, const ShadedSample& shaded);
    /// Adds the radiance of one sample of a pixel, or of `count` equal ones. A radiance that is NaN, infinite or
    /// negative is dropped and counted.
    void add(int x, int y, Rgb radiance, int count = 1);

    /// Divides the sums by the counts. Pixels without a sample are black.
    Rendering finish(int threads);
    std::size_t memory_bytes() const;

private:
    void finish_pixel(int x, int y);

    RasterSettings settings_;
    Rendering rendering_;
    Image<Rgbd> sums_; ///< sums of radiance; empty for a single sample per pixel, which is stored directly
    Image<std::uint32_t> sample_counts_, valid_counts_; ///< samples per pixel, and samples with valid radiance
    struct AovSums {
        double depth = 0;
        Vec3d normal;
        Rgbd albedo;
    };
    Image<AovSums> aov_sums_;         ///< sums of the requested depth, normal and albedo; else empty
    Image<std::uint32_t> hit_counts_; ///< samples with a hit; empty unless depth, normal or albedo is requested
    std::atomic<std::int64_t> invalid_ = 0;
};

} // namespace duet::raster
