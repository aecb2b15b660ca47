// Declares the sample schedule, which decides how many samples each pixel gets, pass by pass.
#pragma once

#include "raytrace/film/film.h"
#include "raytrace/settings.h"

namespace duet::raytrace {

/// The film's error estimates are used only from this many samples per pixel on, because pixels whose few samples all
/// miss the lights look converged.
inline constexpr double kMinSamplesForError = 16;

/// Counts the samples and the time of this render. It excludes the film that the render continues.
struct SpentBudget {
    double seconds = 0;
    std::int64_t samples = 0;
};

/// Sets the number of samples that each pixel of a complete film is to have after the next pass
/// (Film::Pixel::target). Returns false if a limit is reached: the mean number of samples, the time, or the error.
/// The first 16 samples are taken in one pass, because no error is known before. Without a limit of time or error,
/// all other passes take 16 samples, too. With such a limit, passes grow with the number of samples so far, so that
/// the render ends near the limit, and go at most half of the way to the requested error. With a time limit, they
/// start with 2 samples, and the last pass is cut to the nearest 2 samples that fit into the remaining time.
///
/// With PathTracerSettings::adaptive, passes from the 16th sample on distribute their samples by allocate_samples.
bool plan_pass(const PathTracerSettings& settings, const SpentBudget& spent, Film& film);

/// Raises the targets by `samples` in total, so as to minimize the resulting error by the film's estimates. If the
/// error is √(s/n) after n samples, n must be proportional to √s. Here s is the variance of one sample: half of it
/// unscaled, and half divided by (mean² + 0.01), each relative to its mean over the image. This minimizes the sum of
/// MSE and relMSE, each relative to its value with the same number of evenly distributed samples, so that neither is
/// reduced at the expense of the other.
///
/// s is estimated from the pixel's eight neighbors. The pixel's own samples would bias it, because pixels that look
/// dark and noiseless by chance would remain so (Kirk and Arvo 1991, "Unbiased Sampling Techniques for Image
/// Synthesis"). No pixel gets more new samples than it has already. s is at least a hundredth of its mean, so that
/// every pixel gets new samples in the end.
void allocate_samples(Film& film, std::int64_t samples);

} // namespace duet::raytrace
