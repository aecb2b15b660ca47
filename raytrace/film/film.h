// Declares the film, which accumulates samples in double precision. It provides the mean of each pixel and the variance
// of the mean at any time.
#pragma once

#include "common/image/image.h"

#include <array>
#include <cstdint>

namespace duet {

/// Stores one sum of samples per replicate (see Sampler) for each pixel. If there are two replicates of equal size,
/// scrambled independently, the square of half the difference of their means is an unbiased estimate of the variance of
/// the pixel's mean, for every sampler. Sums in double still grow after 2^24 samples, at which sums in float would
/// stall. Different threads may add samples to different pixels at the same time.
class Film {
public:
    static constexpr std::size_t kReplicates = 2;

    /// Stores the sum and the number of valid samples for each replicate.
    struct Pixel {
        std::array<Rgbd, kReplicates> sum{};
        std::array<std::uint32_t, kReplicates> count{};
        std::uint32_t invalid = 0;
        std::uint32_t target = 0; ///< number of samples that the pixel must have at the end of the current pass

        /// Returns the mean of all valid samples, or black if there is none.
        Rgbd mean() const;
        /// Returns the estimated variance of mean() for each channel, or infinity if a replicate has no sample.
        Rgbd variance() const;
        /// Returns the number of valid samples.
        std::uint32_t samples() const { return count[0] + count[1]; }
        /// Returns the number of samples taken, including the dropped ones. If samples are taken in order, this is the
        /// index of the next sample.
        std::uint32_t samples_taken() const { return samples() + invalid; }
    };

    Film(int width, int height);

    /// Adds a valid sample (is_valid_radiance) to a replicate of pixel (x, y) and returns true. An invalid sample is
    /// dropped and only counted; the function then returns false. The replicate is 0 or 1.
    bool add(int x, int y, std::size_t replicate, Rgb sample);

    int width() const { return pixels_.width(); }
    int height() const { return pixels_.height(); }
    /// Each of the following functions returns the value of Pixel's function of the same name.
    Rgbd mean(int x, int y) const { return pixels_(x, y).mean(); }
    Rgbd variance(int x, int y) const { return pixels_(x, y).variance(); }
    std::uint32_t samples(int x, int y) const { return pixels_(x, y).samples(); }
    std::uint32_t samples_taken(int x, int y) const { return pixels_(x, y).samples_taken(); }
    /// Returns the minimum of samples_taken() over all pixels.
    std::uint32_t min_samples_taken() const;
    /// Returns the maximum of samples_taken() over all pixels.
    std::uint32_t max_samples_taken() const;
    /// Returns the sum of samples_taken() over all pixels.
    std::int64_t total_samples_taken() const;
    /// Returns whether every pixel has reached its target number of samples (see Pixel::target).
    bool complete() const;
    /// Returns the number of dropped samples of a pixel: those that are NaN, infinite or negative.
    std::uint32_t invalid(int x, int y) const { return pixels_(x, y).invalid; }

    ImageRgb image() const;
    ImageRgb variance_image() const;
    Image<std::uint32_t> samples_image() const;
    std::int64_t invalid_samples() const;
    /// Returns the mean of variance / (mean² + 0.01) over the channels of all pixels with a known variance. Returns
    /// −1 if fewer than half of the pixels have one.
    ///
    /// A rare bright sample raises mean² as much as the variance and would thus hide its own error: with caustics,
    /// half of the error went undetected. The formula therefore limits a pixel's mean to the larger of two values. The
    /// first is the mean of the brightest neighbor. The second is the mean less its standard error, which for
    /// replicates of equal size is the smaller of their two means: a brightness that both replicates contain is real.
    double estimated_relmse() const;

    const Image<Pixel>& pixels() const { return pixels_; }
    Image<Pixel>& pixels() { return pixels_; }

private:
    Image<Pixel> pixels_;
};

} // namespace duet
