// This file defines clocks and medians of repeated measurements.
#pragma once

#include "common/system/stopwatch.h"

#include <vector>

namespace duet::compare {

/// Returns the CPU time in seconds that all threads of this process have used.
double processor_seconds();

/// Measures wall-clock time or the CPU time of all threads of this process, which other programs disturb much less.
class WorkStopwatch {
public:
    explicit WorkStopwatch(bool processor_time)
        : processor_time_(processor_time), start_(processor_time ? processor_seconds() : 0) {}
    /// Returns the seconds since construction.
    double seconds() const { return processor_time_ ? processor_seconds() - start_ : watch_.seconds(); }

private:
    bool processor_time_;
    double start_;
    Stopwatch watch_;
};

/// Holds the median of repeated measurements, and their range.
struct MedianRange {
    double min = 0, median = 0, max = 0;
};

/// Returns the median, for an even number of values the mean of the middle two; 0 for no values.
double median(std::vector<double> values);

} // namespace duet::compare
