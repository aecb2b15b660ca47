#include "compare/bench/exclusion.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace duet::compare {

namespace {

[[noreturn]] void fail(std::string_view text) {
    throw Error(message("--exclude: found ", text,
                        ", expected x0,y0,x1,y1: whole pixels, or parts of width and height in [0, 1]"));
}

std::array<double, 4> parse_four_numbers(std::string_view text) {
    std::array<double, 4> numbers{};
    const char *at = text.data(), *const end = text.data() + text.size();
    for (std::size_t i = 0; i < 4; ++i) {
        const auto [next, error] = std::from_chars(at, end, numbers[i]);
        const bool separated = i == 3 ? next == end : next != end && *next == ',';
        if (error != std::errc() || !separated || !std::isfinite(numbers[i]) || numbers[i] < 0) fail(text);
        at = next + 1;
    }
    return numbers;
}

} // namespace

ExcludedRectangle parse_excluded_rectangle(std::string_view text) {
    const std::array<double, 4> n = parse_four_numbers(text);
    const bool fractions = std::all_of(n.begin(), n.end(), [](double v) { return v <= 1; });
    const bool whole = std::all_of(n.begin(), n.end(), [](double v) { return v == std::floor(v); });
    if ((!fractions && !whole) || !(n[0] < n[2]) || !(n[1] < n[3])) fail(text);
    return {n[0], n[1], n[2], n[3], fractions};
}

Image<std::uint8_t> counted_pixels(const std::vector<ExcludedRectangle>& rectangles, int width, int height) {
    Image<std::uint8_t> counted(width, height, 1);
    for (const ExcludedRectangle& r : rectangles) {
        const double sx = r.fractions ? width : 1, sy = r.fractions ? height : 1;
        if (r.x1 * sx > width || r.y1 * sy > height)
            throw Error(message("--exclude: ", r.x0, ",", r.y0, ",", r.x1, ",", r.y1, " reaches beyond the image of ",
                                width, "x", height, " pixels"));
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (x + 0.5 >= r.x0 * sx && x + 0.5 < r.x1 * sx && y + 0.5 >= r.y0 * sy && y + 0.5 < r.y1 * sy)
                    counted(x, y) = 0;
    }
    if (std::find(counted.begin(), counted.end(), 1) == counted.end())
        throw Error("--exclude: nothing of the image is left");
    return counted;
}

} // namespace duet::compare
