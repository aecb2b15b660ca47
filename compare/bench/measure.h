// Many short renders, in turn, so that error, time and the spread of both are known.
#pragma once

#include "common/system/control.h"
#include "compare/bench/contender.h"
#include "compare/bench/estimate.h"
#include "compare/bench/reference.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

/// Mean squared error of a picture: over all channels and the pixels that count.
struct PictureError {
    double mse = 0;
    double relmse = 0; ///< mean of (x − r)² / (r² + 0.01), as error_metrics has it
};

/// Both accounts of a picture: whole, and without the excluded rectangles (equal where there are none).
struct TrialFigures {
    std::uint64_t seed = 0;
    double seconds = 0, cpu_seconds = 0;
    PictureError whole, rest;
};

/// One contender at one number of samples.
struct Measurement {
    std::string technique, sampler, note;
    int spp = 0;
    std::vector<TrialFigures> trials;
    double variance = 0; ///< mean over pixels and channels, from the differences of successive seeds; NaN: one trial
    /// Of the whole picture: mean squared error, its relative version, and time; and what follows.
    Estimate mse, relmse, seconds, efficiency, relmse_efficiency;
    Estimate rest_mse, rest_relmse, rest_efficiency, rest_relmse_efficiency;
    double reference_share = 0; ///< the reference's own estimated error as a part of `mse`

    bool counted = true; ///< false: of a peer's settings, not the most efficient at this number of samples

    /// The part of the error that more samples would not take away: 1 − variance / mse − reference_share; 0 where that
    /// is within the band of the mean squared error, and no finding.
    double bias_share() const;
};

struct MeasureSettings {
    int repeats = 5;         ///< seeds, at least 2
    double time_limit = 600; ///< seconds: afterwards no further round begins, but two are always made
    std::uint64_t seed = 0;  ///< trial i of each measurement has seed + 1 + i
};

/// A peer is counted by its best settings: of the rows of one technique that share a number of samples only the most
/// efficient stays counted.
void count_best_only(std::vector<Measurement>& rows, const std::string& technique);

/// Widens the bands of efficiency by what one run cannot know of time: the part `drift` by which a machine's pace
/// changes from run to run, and the processor time that others had (processor_share): on a free machine a render takes
/// between its time × share and its time. Both are taken as two standard errors. Mean squared errors and times keep
/// their bands, which rows of one run, made in turn, are compared by.
void widen_efficiency(std::vector<Measurement>& rows, double drift, double share);

/// Processor time over wall-clock time × threads, in all trials of our own renderers that took 10 ms and more: well
/// below 1 where other programs had the machine, and times mean little. 1 where there is no such trial.
double processor_share(const std::vector<Measurement>& rows, int threads);

/// Errors of `picture` against `reference` over pixels where `counted` is not 0; both of the same size. Pixels that are
/// not finite make the error NaN.
PictureError picture_error(const ImageRgb& picture, const ImageRgb& reference, const Image<std::uint8_t>& counted);

/// Measures every contender at each of its numbers of samples, one seed a round: a round runs all of them once, in an
/// order of its own, so that a machine that grows slower does so for all alike. Each contender first runs once
/// unmeasured. `control` reports the fraction done. Empty where it was stopped.
std::vector<Measurement> measure(const std::vector<Contender>& contenders, const Reference& reference,
                                 const Image<std::uint8_t>& counted, const MeasureSettings& settings, Control& control);

} // namespace duet::compare
