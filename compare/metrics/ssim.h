// This file computes SSIM, the structural similarity of two images.
#pragma once

#include "common/image/image.h"

namespace duet::compare {

/// Returns the structural similarity index of Wang et al. 2004 ("Image Quality Assessment"), averaged over the
/// channels. It is 1 for equal images and less for others. Windows are 11 × 11 pixels, weighted by a Gaussian
/// with σ = 1.5; K₁ = 0.01 and K₂ = 0.03.
/// - Border: Only windows that lie entirely within the image count, as in the authors' program. An image less than
///   11 pixels wide or high has none, and the result is NaN.
/// - Dynamic range: L = 1, the peak of the PSNR, for encoded and for linear values. With the value range of a linear
///   image as L, its light sources would set L so high that all other pixels would count as alike.
/// - Windows that contain a value that is not finite are skipped.
/// Throws Error if the images differ in size. The result is bitwise identical for any number of threads (0:
/// all).
double ssim(const ImageRgb& a, const ImageRgb& b, int threads = 0);

} // namespace duet::compare
