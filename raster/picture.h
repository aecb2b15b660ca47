// Stage 9: samples become pixels.
#pragma once

#include "common/film/rendering.h"
#include "raster/render.h"
#include "raster/shade.h"

#include <atomic>

namespace duet::raster {

/// The picture and the auxiliary pictures that are asked for, each pixel the mean of its samples. Threads may add
/// different tiles at once; a pixel's samples come in order, so the sums are the same for any number of threads.
class Picture {
public:
    /// `many`: samples a pixel may be added; else one at most.
    Picture(const View& view, const Settings& settings, bool many);

    /// One sample of one pixel, or `count` that are alike: what each adds to the auxiliary pictures, then their radiance.
    /// One that is NaN, infinite or negative is dropped and counted.
    void add_auxiliary(const HitTile& tile, int x, int y, const Shaded& shaded);
    void add(int x, int y, Rgb radiance, int count = 1);

    /// Divides sums by counts. Pixels without a sample are black.
    Rendering finish(int threads);
    std::size_t memory_bytes() const;

private:
    void finish_pixel(int x, int y);

    Settings settings_;
    Rendering rendering_;
    Image<Rgbd> sums_;                   ///< of radiance; empty for a single sample, which needs none
    Image<std::uint32_t> added_, valid_; ///< samples a pixel, and those among them whose radiance counts
    struct Auxiliary {
        double depth = 0;
        Vec3d normal;
        Rgbd albedo;
    };
    Image<Auxiliary> auxiliary_; ///< sums; where depth, normal or albedo are asked for
    Image<std::uint32_t> hits_;  ///< samples that hit something; where depth, normal or albedo are asked for
    std::atomic<std::int64_t> invalid_ = 0;
};

} // namespace duet::raster
