// SSIM: how alike two pictures are in structure.
#pragma once

#include "common/image/image.h"

namespace duet::compare {

/// The structural similarity index of Wang et al. 2004 («Image Quality Assessment»), mean over the channels: 1 for
/// equal pictures, less for others. Windows of 11 × 11 pixels, weighted by a Gaussian of σ 1.5; K₁ = 0.01, K₂ = 0.03.
/// - Border: only windows that lie wholly in the picture count, as in the authors' program. A picture less than 11
///   pixels wide or high has none: NaN.
/// - Dynamic range: L = 1, the peak of the PSNR, for stored and for linear values. The range of a linear picture's
///   values would be that of its lamps, against which all else is alike.
/// - Windows with a value that is not finite are left out.
/// Throws Error where the pictures differ in size. The same bits for any number of threads (0: all).
double ssim(const ImageRgb& a, const ImageRgb& b, int threads = 0);

} // namespace duet::compare
