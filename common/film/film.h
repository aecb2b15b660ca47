// The film: sums of samples in double precision, from which mean and variance follow at any time.
#pragma once

#include "common/image/image.h"

#include <array>
#include <cstdint>

namespace duet {

/// Each pixel keeps its samples' sums by replicate (see Sampler): where there are two, scrambled independently,
/// half the difference of their means, squared, estimates the variance of the pixel's mean without bias, whatever the
/// sampler. 2^24 and more samples add up without stalling. Threads may add to different pixels at once.
class Film {
public:
    /// Whether a sample counts: neither NaN, nor infinite, nor negative.
    static bool valid(Rgb sample) { return is_finite(sample) && sample.r >= 0 && sample.g >= 0 && sample.b >= 0; }

    static constexpr std::size_t kReplicates = 2;

    Film(int width, int height);

    /// Adds a sample. One that is NaN, infinite or negative is dropped and counted instead: false.
    bool add(int x, int y, std::size_t replicate, Rgb sample);

    int width() const { return pixels_.width(); }
    int height() const { return pixels_.height(); }
    /// Mean of all samples of a pixel; black where there is none.
    Rgbd mean(int x, int y) const;
    /// Samples that were added or dropped: the next one's number, where they are taken in order.
    std::uint32_t taken(int x, int y) const;
    /// The fewest taken of any pixel, and all of all pixels.
    std::uint32_t least_taken() const;
    std::int64_t all_taken() const;
    /// Whether each pixel has the samples it was promised.
    bool complete() const;
    /// Estimated variance of that mean, by channel; infinity where a replicate has no sample.
    Rgbd variance(int x, int y) const;
    std::uint32_t samples(int x, int y) const;
    std::uint32_t invalid(int x, int y) const { return pixels_(x, y).invalid; }

    ImageRgb image() const;
    ImageRgb variance_image() const;
    Image<std::uint32_t> samples_image() const;
    std::int64_t invalid_samples() const;
    /// Mean of variance / (mean² + 0.01) over channels and the pixels whose variance is known; −1 where that is fewer
    /// than half. By a pixel's own mean a rare bright sample would hide itself, for it raises mean² as much as the variance: with
    /// caustics half of the error was not seen. So a mean counts as no more than the brightest neighbour's, or the
    /// replicate's that has less, whichever is more: what both replicates find is really there.
    double estimated_relmse() const;

    /// What a pixel keeps.
    struct Pixel {
        std::array<Rgbd, kReplicates> sum{};
        std::array<std::uint32_t, kReplicates> count{};
        std::uint32_t invalid = 0;
        std::uint32_t target = 0; ///< how many are to be taken by the end of the pass at hand
    };
    const Image<Pixel>& pixels() const { return pixels_; }
    Image<Pixel>& pixels() { return pixels_; }

private:
    Image<Pixel> pixels_;
};

} // namespace duet
