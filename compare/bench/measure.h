// This file declares repeated, interleaved measurements of short renders, with the spread of error and time.
#pragma once

#include "common/system/control.h"
#include "compare/bench/bench_renderer.h"
#include "compare/bench/estimate.h"
#include "compare/bench/reference.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

/// Holds the mean squared error of an image over all channels and counted pixels.
struct ImageError {
    double mse = 0;
    double relmse = 0; ///< mean of (x − r)² / (r² + 0.01), as in error_metrics
};

/// Holds the errors of a trial, for the whole image and without the excluded rectangles. They are equal if there are
/// none.
struct TrialResult {
    std::uint64_t seed = 0;
    double seconds = 0, cpu_seconds = 0;
    ImageError whole, rest;
};

/// Holds the measurements of one renderer at one sample count.
struct Measurement {
    std::string technique, sampler, note;
    int spp = 0;
    std::vector<TrialResult> trials;
    double variance = 0; ///< mean over pixels and channels, from differences of successive seeds; NaN: one trial
    /// These are metrics of the whole image, the median time, and the efficiencies derived from them.
    Estimate mse, relmse, seconds, efficiency, relmse_efficiency;
    Estimate rest_mse, rest_relmse, rest_efficiency, rest_relmse_efficiency;
    double reference_share = 0; ///< estimated error of the reference as a fraction of `mse`

    /// Returns "technique, sampler", or the technique alone where it has no choice of samplers.
    std::string name() const { return sampler.empty() ? technique : technique + ", " + sampler; }

    bool counted = true; ///< false: another of the peer's settings is more efficient at this sample count

    /// Returns the fraction of the error that more samples would not remove: 1 − variance / mse −
    /// reference_share. Returns 0 if that lies within the confidence band of the mean squared error.
    double bias_share() const;
};

/// Says how often a row is measured.
struct BenchMeasureSettings {
    int repeats = 5;         ///< number of seeds, at least 2
    double time_limit = 600; ///< seconds after which no further round starts; two are always made
    std::uint64_t seed = 0;  ///< trial i of each measurement uses seed + 1 + i
};

/// Clears `counted` for all but the most efficient of a peer's settings, among rows of one technique with the same
/// sample count.
void mark_best_settings(std::vector<Measurement>& rows, const std::string& technique);

/// Widens the confidence bands of the efficiencies by the uncertainty of time that a single run cannot measure. `drift`
/// is the relative change of the CPU's speed between runs. `share` is the processor_share: on an idle CPU, a render
/// takes between its time × share and its time. Both are treated as two standard errors. Mean squared errors and times
/// keep their bands, because they serve to compare rows of one run, which are measured in turns.
void widen_efficiency(std::vector<Measurement>& rows, double drift, double share);

/// Returns CPU time / (wall-clock time × threads), over all trials of Duet's own renderers of at least 10 ms. If it is
/// well below 1, other processes used the CPU, and times are unreliable. Returns 1 if there is no such trial.
double processor_share(const std::vector<Measurement>& rows, int threads);

/// Returns the errors of `image` against `reference` over the pixels where `counted` is not 0. Both must have
/// the same size. Pixels that are not finite make the error NaN.
ImageError image_error(const ImageRgb& image, const ImageRgb& reference, const Image<std::uint8_t>& counted);

/// Measures every renderer at each of its sample counts, with one seed per round. A round runs all of them
/// once in its own order, so that changes of the CPU's speed affect all alike. Each renderer first runs once
/// without being measured. `control` reports the fraction done. Returns nothing if it was stopped.
std::vector<Measurement> measure(const std::vector<BenchRenderer>& renderers, const Reference& reference,
                                 const Image<std::uint8_t>& counted, const BenchMeasureSettings& settings,
                                 Control& control);

} // namespace duet::compare
