// This file declares a statistical test of whether two noisy images differ by more than their noise.
#pragma once

#include "common/image/image.h"

#include <cstdint>

namespace duet::compare {

/// A NoisyImage is a linear image and the estimated variance of each of its values.
struct NoisyImage {
    const ImageRgb& values;
    const ImageRgb& variance; ///< empty: the values are taken as exact
};

/// Holds the differences of two images in units of their noise. The noise of the images must be independent (two
/// seeds). With the same seed the noise cancels, and the test finds nothing.
struct ZTest {
    std::int64_t pixels = 0; ///< pixels tested: finite, with a finite variance, and not both equal and noise-free

    // The per-pixel statistics use z = difference / standard deviation, with the variance pooled over 5 × 5
    // pixels. They are descriptive only: where the noise changes from pixel to pixel or is far from normal, the
    // fractions are larger.
    double over_2 = 0, over_3 = 0;    ///< fraction of values with |z| above 2 (normal: 0.0455) and above 3 (normal:
                                      ///< 0.0027)
    double mean_square = 0;           ///< mean of z²; about 1.04 if only noise differs
    double largest = 0;               ///< largest |z|; infinite for a difference without noise
    int largest_x = 0, largest_y = 0; ///< the pixel with the largest |z|

    // The decision is based on the mean difference, per channel, of the whole image and of each block of 32 ×
    // 32 pixels.
    Rgbd mean_z;            ///< z of the mean difference of the whole image
    Rgbd detectable;        ///< mean difference that would be found (p < 0.01) in 99 of 100 image pairs
    std::int64_t tests = 0; ///< three per block and three for the whole image
    double p = 1; ///< smallest p-value, corrected for the number of tests: small if the images differ
    int x = 0, y = 0, width = 0, height = 0; ///< pixels of the test with the smallest p-value
    int channel = 0;                         ///< channel of the test with the smallest p-value, 0 to 2
};

/// Tests two images of the same size. Throws Error if sizes differ or if both images are taken as exact.
ZTest z_test(const NoisyImage& a, const NoisyImage& b);

} // namespace duet::compare
