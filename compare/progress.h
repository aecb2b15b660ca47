// This file reports the progress of work that consists of several steps.
#pragma once

#include "common/system/control.h"

namespace duet::compare {

/// Divides the progress of a task among its steps by their costs.
class ProgressSteps {
public:
    /// The argument `cost` is the sum over all steps. `whole` must outlive the steps.
    ProgressSteps(const Control& whole, double cost) : whole_(whole), cost_(cost) {}
    /// Returns the control of the next step.
    Control next(double cost = 1) {
        const double begin = begun_;
        begun_ += cost;
        return {whole_.stop,
                [this, begin, cost](double fraction) { whole_.report((begin + fraction * cost) / cost_); }};
    }

private:
    const Control& whole_;
    double cost_, begun_ = 0;
};

} // namespace duet::compare
