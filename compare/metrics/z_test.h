// Whether two noisy pictures differ by more than their noise.
#pragma once

#include "common/image/image.h"

#include <cstdint>

namespace duet::compare {

/// A linear picture and the estimated variance of each of its values.
struct NoisyImage {
    const ImageRgb& values;
    const ImageRgb& variance; ///< empty: the values are taken as exact
};

/// Two pictures' differences measured by their noise. The pictures' noise must be independent (two seeds): of one seed
/// it cancels, and the test finds nothing.
struct ZTest {
    std::int64_t pixels = 0; ///< pixels tested: finite, with a finite variance, and not the same without noise

    // Pixel by pixel: z = difference / its standard deviation, which is pooled over 5 × 5 pixels. These describe; where
    // the noise changes from pixel to pixel, or is far from normal, the shares are larger.
    double over_2 = 0, over_3 = 0;    ///< share of the values with |z| above 2 (normal: 0.0455) and 3 (0.0027)
    double mean_square = 0;           ///< mean of z²; about 1.04 where only noise differs
    double largest = 0;               ///< largest |z|, infinite where there is a difference and no noise …
    int largest_x = 0, largest_y = 0; ///< … and its pixel

    // The decision: the mean difference of the whole picture and of each block of 32 × 32 pixels, by channel.
    Rgbd mean_z;            ///< of the whole picture's mean difference
    Rgbd detectable;        ///< a mean difference which would be found (p < 0.01) in 99 of 100 pairs of pictures
    std::int64_t tests = 0; ///< three a block and three of the whole
    double p = 1; ///< of the most unlikely of these, corrected for their number: small where the pictures differ
    int x = 0, y = 0, width = 0, height = 0; ///< the most unlikely one's pixels …
    int channel = 0;                         ///< … and channel, 0 to 2
};

/// Throws Error where sizes differ or both are taken as exact.
ZTest z_test(const NoisyImage& a, const NoisyImage& b);

} // namespace duet::compare
