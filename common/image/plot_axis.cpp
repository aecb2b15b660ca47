#include "common/image/plot_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

namespace duet {

namespace {

// Returns 1, 2 or 5 times a power of ten as the distance between ticks, so that `span` has about `count` steps.
double tick_step(double span, int count) {
    const double rough = span / count, power = std::pow(10.0, std::floor(std::log10(rough)));
    const double digit = rough / power; // in [1, 10)
    return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

Axis linear_axis(AxisRequest request) {
    auto& [low, high, logarithmic, tight, whole, count] = request;
    if (!tight && low > 0 && low < 0.4 * high) low = 0; // the axis starts at 0, so that heights show ratios
    if (!tight && high < 0 && high > 0.4 * low) high = 0;
    if (!(low < high)) { // widen the range around a single value
        const double room = low == 0 ? 1 : std::abs(low) * 0.5;
        low -= room, high += room;
    }
    const double step = std::max(tick_step(high - low, std::clamp(count, 2, 10)), whole ? 1.0 : 0.0);
    // The tolerance 1e-9 treats a value as a tick if it equals the tick up to rounding.
    const double inward = tight ? -1e-9 : 1e-9;
    const auto first = static_cast<long long>(tight ? std::ceil(low / step + inward) : std::floor(low / step + inward));
    const auto last =
        static_cast<long long>(tight ? std::floor(high / step - inward) : std::ceil(high / step - inward));
    Axis axis{low, high, false, {}};
    for (long long i = first; i <= last; ++i) {
        const double value = static_cast<double>(i) * step;
        axis.ticks.push_back({value, format_significant(value, 6)});
    }
    if (!tight) axis.low = axis.ticks.front().value, axis.high = axis.ticks.back().value;
    return axis;
}

std::string power_label(int exponent) {
    if (exponent == 0) return "1";
    if (exponent == 1) return "10";
    static constexpr std::array kRaised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string label = exponent < 0 ? "10⁻" : "10";
    for (const char digit : std::to_string(std::abs(exponent))) label += kRaised[static_cast<std::size_t>(digit - '0')];
    return label;
}

Axis logarithmic_axis(double low, double high) {
    if (!(low < high)) low /= 2, high *= 2;
    const int first = static_cast<int>(std::floor(std::log10(low) + 1e-9));
    const int last = static_cast<int>(std::ceil(std::log10(high) - 1e-9));
    const bool few = std::log10(high / low) < 2;
    const int label_interval = 1 + (last - first) / 8; // more than 8 labels would overlap
    Axis axis{low, high, true, {}};
    for (int exponent = first; exponent <= last; ++exponent)
        for (int digit = 1; digit <= 9; ++digit) {
            const double value = digit * std::pow(10.0, exponent);
            const bool tight = value < low * (1 - 1e-9) || value > high * (1 + 1e-9);
            if (tight) continue;
            const bool labeled =
                digit == 1 ? (exponent - first) % label_interval == 0 : few && (digit == 2 || digit == 5);
            const std::string label = few ? format_significant(value, 6) : power_label(exponent);
            axis.ticks.push_back({value, labeled ? label : ""});
        }
    return axis;
}

// Rounds a bound of a logarithmic axis outward to 1, 2 or 5 times a power of ten.
double round_outward(double value, bool up) {
    const double power = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
    const double digit = value / power;
    if (up) return power * (digit <= 1 + 1e-9 ? 1 : digit <= 2 + 1e-9 ? 2 : digit <= 5 + 1e-9 ? 5 : 10);
    return power * (digit >= 5 - 1e-9 ? 5 : digit >= 2 - 1e-9 ? 2 : 1);
}

} // namespace

double Axis::position(double value) const {
    return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

Axis make_axis(const AxisRequest& request) {
    if (!request.logarithmic) return linear_axis(request);
    return logarithmic_axis(round_outward(request.low, false), round_outward(request.high, true));
}

std::string format_significant(double value, int digits) {
    std::ostringstream text; // not std::to_chars, which the library of the web page's build lacks for double
    text.imbue(std::locale::classic());
    text << std::setprecision(digits) << value;
    return text.str();
}

} // namespace duet
