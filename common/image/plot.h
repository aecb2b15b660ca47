// This file draws plots for the pages of lessons. A plot shows lines through measured points and is written as SVG.
#pragma once

#include "common/vec/vec.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet {

/// A series is one line of a plot. It connects the points in the given order, and its name is written beside its end.
struct Series {
    std::string name;
    std::vector<Vec2d> points;
};

/// A plot has up to 7 series. For example:
///
///     Plot plot{.title = "Rendering time", .x_label = "number of spheres", .y_label = "seconds",
///               .log_x = true, .log_y = true, .timing = true};
///     plot.series.push_back({"list", {{10, 0.02}, {100, 0.21}, {1000, 2.3}}});
///     write_plot("time.svg", plot);
struct Plot {
    static constexpr std::size_t kMaxSeries = 7;

    std::string title{}, x_label{}, y_label{};
    bool log_x = false, log_y = false; ///< a logarithmic axis requires values above 0
    std::vector<Series> series{};      ///< up to 7 series
    bool timing = false;               ///< y is measured time, so tests must not expect the same values again
    int width = 640, height = 400;     ///< size of the image in pixels
};

/// Writes a plot as an SVG file; the file is complete or absent. Attributes allow a program to compare two plots by
/// their values: the element of each line has data-series, data-x and data-y, and the root element has data-timing
/// ("true" or "false"). Throws an Error if the path does not end in .svg, no series has a point, there are more than 7
/// series, the image is too small for its labels, a value is not finite, or a value on a logarithmic axis is not
/// positive.
void write_plot(const std::filesystem::path& path, const Plot& plot);

/// Returns the SVG text that write_plot writes. `name` identifies the plot in error messages.
std::string plot_svg(const std::string& name, const Plot& plot);

} // namespace duet
