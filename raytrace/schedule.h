// How many samples each pixel gets, pass by pass.
#pragma once

#include "common/film/film.h"
#include "raytrace/render.h"

namespace duet::raytrace {

/// A first few samples that all miss the lights look converged: what the film tells of errors is asked from so many a
/// pixel on.
inline constexpr double kMinForError = 16;

/// What a render has done itself; the film that it went on from is left out.
struct Spent {
    double seconds = 0;
    std::int64_t samples = 0;
};

/// Tells each pixel of a complete film how many samples it is to have after the next pass (Film::Pixel::target); false
/// where a limit is reached: the mean number of samples, the time, or the error. The first 16 samples are taken at once,
/// since no error is known before, and so are all others 16 by 16 where there is no limit. With one, passes grow with
/// what is done, so that the end comes near the limit, and go no more than half of the way to an error asked for; before a
/// limit of time they start with 2, and the last is cut to what the time is good for, as near as 2 samples.
///
/// With Settings::adaptive the passes from the 16th sample on are spread (see spread_samples).
bool plan_pass(const Settings& settings, const Spent& spent, Film& film);

/// Raises the targets by `samples` in all, so that the error after them is least, as far as the film tells: with an error
/// of √(s/n) at n samples that is n ∝ √s. s is the variance of one sample, half as it is, and half over (mean² + 0.01),
/// each over its mean in the picture: so that the sum of what becomes of MSE and of relMSE, beside as many samples spread
/// evenly, is least, and neither is bought with the other. It is estimated from the pixel's eight neighbours: what its own
/// samples say would bias it, because pixels that look dark and quiet by chance would keep what they look like (Kirk and
/// Arvo 1991, «Unbiased Sampling Techniques for Image Synthesis»). No pixel gets more than it has already, and none is
/// left behind for good: s counts as a hundredth of the mean at least.
void spread_samples(Film& film, std::int64_t samples);

} // namespace duet::raytrace
