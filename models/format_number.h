// This header declares number formatting that is bitwise equal on every platform.
#pragma once

#include <string>

namespace duet::models {

/// Appends x in plain decimal notation, rounded to `decimals` places, without trailing zeros: "0.25", "-3", "0". It
/// is independent of the locale; x must be finite and |x| below 1e12.
void append_number(std::string& text, double x, int decimals);

/// Returns x as text; see append_number.
std::string format_number(double x, int decimals);

} // namespace duet::models
