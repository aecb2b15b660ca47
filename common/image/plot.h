// Plots for the pages of lessons: lines through measured points, written as an SVG file.
#pragma once

#include "common/vec/vec.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet {

/// One line of a plot: its name stands at its end. The points are joined in the order given.
struct Series {
    std::string name;
    std::vector<Vec2d> points;
};

/// What a plot shows. For example:
///
///     Plot plot{.title = "Rendering time", .x_label = "number of spheres", .y_label = "seconds",
///               .log_x = true, .log_y = true, .timing = true};
///     plot.series.push_back({"list", {{10, 0.02}, {100, 0.21}, {1000, 2.3}}});
///     write_plot("time.svg", plot);
struct Plot {
    std::string title{}, x_label{}, y_label{};
    bool log_x = false, log_y = false; ///< logarithmic axes show values above 0 only
    std::vector<Series> series{};      ///< up to 7
    bool timing = false;               ///< y is measured time: a test does not expect the same values again
    int width = 640, height = 400;     ///< in pixels
};

/// Writes a plot as SVG, whole or not at all. Besides what one sees, each line's element has the attributes
/// data-series, data-x and data-y, and the whole has data-timing ("true" or "false"), so that a program can compare two
/// plots by their values. Throws Error where the path does not end in .svg, no series has a point, there are more
/// series than colors, the picture is too small for its labels, or a value is not finite or, on a logarithmic axis, not
/// positive.
void write_plot(const std::filesystem::path& path, const Plot& plot);

/// The SVG that write_plot writes; `name` is what an Error calls it.
std::string plot_svg(const std::string& name, const Plot& plot);

} // namespace duet
