#include "common/image/plot.h"

#include "common/image/plot_axis.h"
#include "tests/support/errors.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace duet;
using test::Containing;
using test::error_of;

namespace {

std::string labels(const Axis& axis) {
    std::string all;
    for (const Tick& tick : axis.ticks)
        if (!tick.label.empty()) all += (all.empty() ? "" : " ") + tick.label;
    return all;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

Plot two_lines() {
    Plot plot{.title = "Time & error", .x_label = "samples", .y_label = "seconds", .log_x = true, .log_y = true};
    plot.series = {{"list", {{10, 0.25}, {100, 2.5}}}, {"tree <8>", {{10, 0.1}, {100, 0.2}, {1000, 0.3}}}};
    return plot;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("linear axes have ticks at 1, 2 and 5 times powers of ten, and end at ticks unless tight") {
        CHECK(labels(make_axis({.low = 0, .high = 1})) == "0 0.2 0.4 0.6 0.8 1");
        CHECK(labels(make_axis({.low = 3, .high = 47})) == "0 10 20 30 40 50");
        CHECK(labels(make_axis({.low = 100.1, .high = 100.9})) ==
              "100.1 100.2 100.3 100.4 100.5 100.6 100.7 100.8 100.9");
        CHECK(labels(make_axis({.low = -2e-7, .high = 3e-7})) == "-2e-07 -1e-07 0 1e-07 2e-07 3e-07");
        CHECK(labels(make_axis({.low = 0, .high = 90, .tight = true})) == "0 20 40 60 80");
        CHECK(labels(make_axis({.low = 1, .high = 4, .tight = true, .whole = true})) == "1 2 3 4");
        CHECK(labels(make_axis({.low = 1, .high = 4, .tight = true})) == "1 1.5 2 2.5 3 3.5 4");
    }

    TEST_CASE("logarithmic axes have labels at powers of ten, and more where there are few of those") {
        CHECK(labels(make_axis({.low = 0.002, .high = 3000, .logarithmic = true})) == "10⁻² 10⁻¹ 1 10 10² 10³");
        CHECK(labels(make_axis({.low = 17, .high = 120, .logarithmic = true})) == "10 20 50 100 200");
        CHECK(labels(make_axis({.low = 1, .high = 1e16, .logarithmic = true})) == "1 10³ 10⁶ 10⁹ 10¹² 10¹⁵");
    }

    TEST_CASE("every axis contains its values, and position goes from 0 to 1") {
        for (const bool logarithmic : {false, true})
            for (const bool tight : {false, true})
                for (const double low : {1e-9, 0.07, 1.0, 999.0, 1e12})
                    for (const double factor : {1.0, 1.0001, 1.7, 10.0, 12345.0}) {
                        const double high = low * factor;
                        const Axis axis =
                            make_axis({.low = low, .high = high, .logarithmic = logarithmic, .tight = tight});
                        CAPTURE(low);
                        CAPTURE(high);
                        CHECK(axis.low < axis.high);
                        CHECK(axis.position(low) >= -1e-9);
                        CHECK(axis.position(high) <= 1 + 1e-9);
                        CHECK(axis.ticks.size() <= 200);
                        CHECK(axis.position(axis.low) == doctest::Approx(0));
                        CHECK(axis.position(axis.high) == doctest::Approx(1));
                    }
    }

    TEST_CASE("a plot's file holds the values of its lines") {
        const test::ScratchFolder scratch;
        write_plot(scratch / "time.svg", two_lines());
        const std::string svg = read_file(scratch / "time.svg");
        CHECK(svg == Containing("data-timing=\"false\""));
        CHECK(svg == Containing("data-series=\"list\" data-x=\"10 100 \" data-y=\"0.25 2.5 \""));
        CHECK(svg == Containing("data-series=\"tree &lt;8>\" data-x=\"10 100 1000 \" data-y=\"0.1 0.2 0.3 \""));
        CHECK(svg == Containing("Time &amp; error"));
        CHECK(count(svg, "<polyline") == 2);
        CHECK(count(svg, "<circle") == 5);
        CHECK(plot_svg("again", two_lines()) == svg);
    }

    TEST_CASE("names at the ends of lines that end together don't overlap, and stay in the image") {
        Plot plot{.series = {}};
        for (int i = 0; i < 7; ++i) plot.series.push_back({"line", {{0, 0}, {1, 1e-3 * i}}});
        const std::string svg = plot_svg("lines", plot);
        std::vector<double> heights;
        for (std::size_t at = svg.find(">line</text>"); at != std::string::npos; at = svg.find(">line</text>", at + 1))
            heights.push_back(std::stod(svg.substr(svg.rfind("y=\"", at) + 3)));
        REQUIRE(heights.size() == 7);
        for (std::size_t i = 1; i < 7; ++i) CHECK(std::abs(heights[i] - heights[i - 1]) >= 14);
        for (const double height : heights) CHECK((height > 0 && height < plot.height));
    }

    TEST_CASE("what cannot be drawn is named") {
        const auto error = [](const Plot& plot) { return error_of([&] { plot_svg("p.svg", plot); }); };
        CHECK(error({}) == "p.svg: no series has a point, expected at least one");
        Plot plot = two_lines();
        plot.series[1].points[2].y = 0;
        CHECK(error(plot) ==
              "p.svg: series \"tree <8>\", point 2: y is 0, expected a positive number on a logarithmic axis");
        plot.log_y = false;
        CHECK(error(plot) == "no error");
        plot.series[0].points[1].x = std::numeric_limits<double>::quiet_NaN();
        CHECK(error(plot) ==
              "p.svg: series \"list\", point 1: x is nan, expected a positive number on a logarithmic axis");
        plot.log_x = false;
        CHECK(error(plot) == "p.svg: series \"list\", point 1: x is nan, expected a finite number");
        plot = two_lines();
        plot.width = 150;
        CHECK(error(plot) == Containing("150 x 400 pixels leave too little room"));
        plot = two_lines();
        plot.series.resize(8);
        CHECK(error(plot) == "p.svg: 8 series, expected at most 7");
        CHECK(error_of([&] { write_plot("plot.png", two_lines()); }) == Containing("ends in .svg"));
        CHECK(error_of([&] { write_plot("/nowhere/plot.svg", two_lines()); }) == Containing("exit code 1: "));
    }
}
