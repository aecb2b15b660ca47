#include "common/image/plot.h"

#include "common/image/plot_axis.h"
#include "common/system/error.h"
#include "common/system/escape.h"
#include "common/system/file.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet {

namespace {

// Color-blind readers can distinguish these line colors (after Okabe and Ito 2008, "Color Universal Design", without
// their yellow, which is too light on a white page). Text has a darker color of the same hue.
struct SeriesColor {
    const char *line, *text;
};
constexpr std::array<SeriesColor, Plot::kMaxSeries> kSeriesColors{{{"#0072B2", "#005A8E"},
                                                                   {"#D55E00", "#A84A00"},
                                                                   {"#009E73", "#007153"},
                                                                   {"#CC79A7", "#994470"},
                                                                   {"#000000", "#000000"},
                                                                   {"#E69F00", "#855C00"},
                                                                   {"#56B4E9", "#1B6C9C"}}};
constexpr double kFontSize = 13, kTitleSize = 15, kLineHeight = 17;

// Estimates the width of a text in pixels. Letters and the fonts of viewers differ in width; the estimate is large
// enough for all texts except long rows of capital letters.
double text_width(const std::string& text, double size = kFontSize) {
    const auto letters = std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }); // in UTF-8
    return 0.58 * size * static_cast<double>(letters);
}

std::string pixels(double value) { return format_significant(std::round(value * 10) / 10, 6); }

void check_value(const std::string& name, const Series& series, std::size_t i, char axis, double value,
                 bool logarithmic) {
    const bool positive = value > 0 || !logarithmic;
    if (std::isfinite(value) && positive) return;
    throw Error(message(name, ": series \"", series.name, "\", point ", i, ": ", axis, " is ", value, ", expected a ",
                        logarithmic ? "positive number on a logarithmic axis" : "finite number"));
}

void check_plot(const std::string& name, const Plot& plot) {
    std::size_t points = 0;
    for (const Series& series : plot.series) {
        points += series.points.size();
        for (std::size_t i = 0; i < series.points.size(); ++i) {
            check_value(name, series, i, 'x', series.points[i].x, plot.log_x);
            check_value(name, series, i, 'y', series.points[i].y, plot.log_y);
        }
    }
    if (points == 0) throw Error(message(name, ": no series has a point, expected at least one"));
    if (plot.series.size() > kSeriesColors.size())
        throw Error(message(name, ": ", plot.series.size(), " series, expected at most ", kSeriesColors.size()));
}

// Holds the position of the plot area and the axes, which map values to pixels.
struct Layout {
    double left, right, top, bottom; ///< edges of the plot area in pixels from the upper left corner
    Axis x, y;

    double x_of(double value) const { return left + (right - left) * x.position(value); }
    double y_of(double value) const { return bottom - (bottom - top) * y.position(value); }
};

Axis axis_of(const Plot& plot, double Vec2d::*component, AxisRequest request) {
    request.low = kInfinity, request.high = -kInfinity, request.whole = true;
    for (const Series& series : plot.series)
        for (const Vec2d& point : series.points) {
            const double value = point.*component;
            request.low = std::min(request.low, value);
            request.high = std::max(request.high, value);
            request.whole = request.whole && value == std::round(value);
        }
    return make_axis(request);
}

Layout layout_of(const std::string& name, const Plot& plot) {
    Layout layout{.left = 0,
                  .right = 0,
                  .top = 0,
                  .bottom = 0,
                  .x = axis_of(plot, &Vec2d::x, {.logarithmic = plot.log_x, .tight = true, .count = plot.width / 90}),
                  .y = axis_of(plot, &Vec2d::y, {.logarithmic = plot.log_y, .count = plot.height / 60})};
    double ticks_width = 0, names_width = 0;
    for (const Tick& tick : layout.y.ticks) ticks_width = std::max(ticks_width, text_width(tick.label));
    for (const Series& series : plot.series) names_width = std::max(names_width, text_width(series.name));
    layout.left = ticks_width + 16;
    layout.right = plot.width - std::max(names_width + 30, 24.0);
    layout.top = 18 + (plot.title.empty() ? 0 : 1.5 * kTitleSize) + (plot.y_label.empty() ? 0 : 1.3 * kFontSize);
    layout.bottom = plot.height - 28 - (plot.x_label.empty() ? 0 : 1.4 * kFontSize);
    if (layout.right - layout.left < 100 || layout.bottom - layout.top < 60)
        throw Error(message(name, ": ", plot.width, " x ", plot.height,
                            " pixels leave too little room beside the labels, ",
                            "expected a larger image or shorter labels"));
    return layout;
}

std::string text_at(double x, double y, const std::string& text, const std::string& attributes) {
    return message("<text x=\"", pixels(x), "\" y=\"", pixels(y), "\" ", attributes, ">", markup_escaped(text),
                   "</text>\n");
}

std::string line_from(Vec2d a, Vec2d b, const std::string& attributes) {
    return message("<line x1=\"", pixels(a.x), "\" y1=\"", pixels(a.y), "\" x2=\"", pixels(b.x), "\" y2=\"",
                   pixels(b.y), "\" ", attributes, "/>\n");
}

std::string titles(const Layout& layout, const Plot& plot) {
    double y = 8;
    std::string svg;
    if (!plot.title.empty())
        svg += text_at(12, y += 1.2 * kTitleSize, plot.title,
                       message("font-size=\"", kTitleSize, "\" font-weight=\"bold\""));
    if (!plot.y_label.empty()) svg += text_at(12, y + 1.5 * kFontSize, plot.y_label, "fill=\"#444\"");
    if (!plot.x_label.empty())
        svg += text_at((layout.left + layout.right) / 2, plot.height - 12, plot.x_label,
                       "fill=\"#444\" text-anchor=\"middle\"");
    return svg;
}

std::string grid(const Layout& layout) {
    const auto stroke = [](const Tick& tick) { return tick.label.empty() ? "stroke=\"#eee\"" : "stroke=\"#ccc\""; };
    std::string svg;
    for (const Tick& tick : layout.x.ticks) {
        const double x = layout.x_of(tick.value);
        svg += line_from({x, layout.top}, {x, layout.bottom}, stroke(tick));
        if (!tick.label.empty()) svg += text_at(x, layout.bottom + 18, tick.label, "text-anchor=\"middle\"");
    }
    for (const Tick& tick : layout.y.ticks) {
        const double y = layout.y_of(tick.value);
        svg += line_from({layout.left, y}, {layout.right, y}, stroke(tick));
        if (!tick.label.empty()) svg += text_at(layout.left - 6, y + 4.5, tick.label, "text-anchor=\"end\"");
    }
    svg += line_from({layout.left, layout.bottom}, {layout.right, layout.bottom}, "stroke=\"#444\"");
    return svg + line_from({layout.left, layout.top}, {layout.left, layout.bottom}, "stroke=\"#444\"");
}

std::string lines(const Layout& layout, const Plot& plot) {
    std::string svg;
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
        const Series& series = plot.series[s];
        std::string polyline_points, xs, ys, dots;
        for (const Vec2d& point : series.points) {
            const std::string x = pixels(layout.x_of(point.x)), y = pixels(layout.y_of(point.y));
            polyline_points += x + "," + y + " ";
            xs += format_significant(point.x, 7) + " ";
            ys += format_significant(point.y, 7) + " ";
            dots += message("<circle cx=\"", x, "\" cy=\"", y, "\" r=\"3\"/>\n");
        }
        svg += message("<g data-series=\"", markup_escaped(series.name), "\" data-x=\"", xs, "\" data-y=\"", ys,
                       "\" fill=\"", kSeriesColors[s].line, "\">\n<polyline points=\"", polyline_points,
                       "\" fill=\"none\" stroke=\"", kSeriesColors[s].line,
                       "\" stroke-width=\"2\" stroke-linejoin=\"round\"/>\n");
        svg += (series.points.size() <= 24 ? dots : "") + "</g>\n"; // more dots would hide the line
    }
    return svg;
}

struct EndLabel {
    std::size_t series;
    Vec2d end; ///< the last point of the line
    double y;  ///< where the name is written
};

// Moves labels apart vertically until they do not overlap. A label stays beside the end of its line where possible.
void separate_labels(std::vector<EndLabel>& labels, double bottom) {
    std::sort(labels.begin(), labels.end(), [](const EndLabel& a, const EndLabel& b) { return a.y < b.y; });
    for (std::size_t i = 1; i < labels.size(); ++i) labels[i].y = std::max(labels[i].y, labels[i - 1].y + kLineHeight);
    double lowest = bottom;
    for (auto label = labels.rbegin(); label != labels.rend(); ++label, lowest -= kLineHeight)
        label->y = std::min(label->y, lowest);
}

std::string series_labels(const Layout& layout, const Plot& plot) {
    std::vector<EndLabel> labels;
    for (std::size_t s = 0; s < plot.series.size(); ++s)
        if (const Series& series = plot.series[s]; !series.points.empty() && !series.name.empty()) {
            const Vec2d end{layout.x_of(series.points.back().x), layout.y_of(series.points.back().y)};
            labels.push_back({s, end, end.y});
        }
    separate_labels(labels, layout.bottom);
    std::string svg;
    for (const EndLabel& label : labels) {
        const SeriesColor color = kSeriesColors[label.series];
        const bool beside = std::abs(label.y - label.end.y) < 3 && label.end.x > layout.right - 3;
        if (!beside)
            svg += line_from(label.end, {layout.right + 14, label.y},
                             message("stroke=\"", color.line, "\" stroke-dasharray=\"2 3\""));
        svg += text_at(layout.right + (beside ? 9 : 18), label.y + 4.5, plot.series[label.series].name,
                       message("fill=\"", color.text, "\""));
    }
    return svg;
}

} // namespace

std::string plot_svg(const std::string& name, const Plot& plot) {
    check_plot(name, plot);
    const Layout layout = layout_of(name, plot);
    // Draw a white background, because the page around the plot may be dark.
    return message("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"", plot.width, "\" height=\"", plot.height,
                   "\" viewBox=\"0 0 ", plot.width, " ", plot.height, "\" role=\"img\" data-timing=\"",
                   plot.timing ? "true" : "false",
                   "\" font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"", kFontSize,
                   "\" fill=\"#222\">\n<title>", markup_escaped(plot.title.empty() ? name : plot.title),
                   "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n", titles(layout, plot),
                   grid(layout), lines(layout, plot), series_labels(layout, plot), "</svg>\n");
}

void write_plot(const std::filesystem::path& path, const Plot& plot) {
    if (lower_case_extension(path) != ".svg")
        throw Error(message(path.string(), ": a plot is an SVG file, expected a name that ends in .svg"));
    write_file(path, plot_svg(path.filename().string(), plot));
}

} // namespace duet
