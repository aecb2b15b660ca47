// This file computes the range and the ticks of a plot's axis.
#pragma once

#include <string>
#include <vector>

namespace duet {

/// A tick marks a value on an axis. Minor ticks have a grid line but an empty label.
struct Tick {
    double value = 0;
    std::string label;
};

/// An axis has a range of values and its ticks.
struct Axis {
    double low = 0, high = 1; ///< visible range; low < high
    bool logarithmic = false;
    std::vector<Tick> ticks; ///< in increasing order

    /// Returns the position of a value on the axis: 0 at `low` and 1 at `high`.
    double position(double value) const;
};

/// Describes the requested axis. It must show all values from `low` to `high`, which must be finite, and positive if
/// the axis is logarithmic.
struct AxisRequest {
    double low = 0, high = 1;
    bool logarithmic = false;
    bool tight = false; ///< a linear axis ends at low and high instead of at ticks
    bool whole = false; ///< all values are integers, so a linear axis has ticks only at integers
    int count = 6;      ///< approximate number of labels of a linear axis
};

/// Returns an axis for the request. The ticks of a linear axis are multiples of 1, 2 or 5 times a power of ten. Unless
/// it is tight, a linear axis extends to 0 if the values come near 0. A logarithmic axis has labels at powers of ten,
/// such as 10². If it spans a factor below 100, it also has labels at 2 and 5 times these powers.
Axis make_axis(const AxisRequest& request);

/// Formats a number with up to `digits` significant digits, independently of the locale, for example "0.5" or "1e+06".
std::string format_significant(double value, int digits);

} // namespace duet
