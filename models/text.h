// Text whose bytes are the same on every machine.
#pragma once

#include <string>

namespace duet::models {

/// Appends x in plain decimal notation, rounded to `decimals` places, without trailing zeros: "0.25", "-3", "0".
/// Independent of the locale; x is finite and below 1e12 in size.
void append_number(std::string& text, double x, int decimals);

/// Fixed-point text of x: see append_number.
std::string number(double x, int decimals);

} // namespace duet::models
