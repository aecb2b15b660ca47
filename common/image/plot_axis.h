// The axis of a plot: what range it shows, and where its ticks are.
#pragma once

#include <string>
#include <vector>

namespace duet {

/// A place on an axis. Minor ticks have a grid line but no label.
struct Tick {
    double value = 0;
    std::string label;
};

struct Axis {
    double low = 0, high = 1; ///< the range that is shown; low < high
    bool logarithmic = false;
    std::vector<Tick> ticks; ///< increasing

    /// Where a value lies: 0 at the low end, 1 at the high end.
    double position(double value) const;
};

/// What an axis has to show: all values from `low` to `high`, finite, and above 0 where it is logarithmic.
struct AxisRequest {
    double low = 0, high = 1;
    bool logarithmic = false;
    bool tight = false; ///< a linear axis ends at low and high, rather than at ticks
    bool whole = false; ///< the values are whole numbers, so a linear axis has no ticks between those
    int count = 6;      ///< about how many labels a linear axis has
};

/// The ticks of a linear axis are multiples of 1, 2 or 5 times a power of ten; where not tight it begins at 0 if the
/// values come near that. A logarithmic axis has labels at powers of ten, as 10², and where it spans fewer than two of
/// them also at 2 and 5 times those.
Axis make_axis(const AxisRequest& request);

/// A number as briefly as `digits` significant digits allow, the same in every locale: "0.5", "1e+06".
std::string brief_number(double value, int digits);

} // namespace duet
