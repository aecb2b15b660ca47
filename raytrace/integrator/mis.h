// Multiple importance sampling by the power heuristic with β = 2 (Veach 1997, §9.2.4).
#pragma once

#include "common/vec/scalar.h"

namespace duet::raytrace {

/// Returns the contribution of a ratio of densities to MIS weights of many strategies.
inline double mis(double ratio) { return sqr(ratio); }

/// Returns the MIS weight of a sample that was drawn with density `own` and could have been drawn with density
/// `other`. `own` must be positive. T is a floating-point number or a batch of them.
template <typename T> T mis_weight(T own, T other) { return T(1.0f) / (T(1.0f) + sqr(other / own)); }

} // namespace duet::raytrace
