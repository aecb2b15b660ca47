#include "compare/images.h"

#include "common/program/program.h"
#include "common/program/statistics.h"
#include "common/system/file.h"
#include "compare/metrics/limits.h"
#include "compare/report/false_color.h"
#include "compare/report/output.h"
#include "compare/report/report_json.h"
#include "compare/report/report_page.h"
#include "compare/report/text.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Holds the values stored in a file, and their variances if the file has them.
struct ComparedImage {
    ImageRgb values, variance;
    Encoding encoding = Encoding::kLinear;
    std::int64_t transparent = 0; ///< number of pixels whose alpha is not 1; alpha is not compared
};

ImageRgb stored_values(const StoredImage& file) {
    ImageRgb image(file.width, file.height);
    const auto channels = static_cast<std::size_t>(file.channels);
    for (std::size_t i = 0; i < image.size(); ++i) {
        const float* const v = file.values.data() + i * channels;
        image[i] = channels < 3 ? Rgb(v[0]) : Rgb(v[0], v[1], v[2]);
    }
    return image;
}

std::int64_t transparent_pixels(const StoredImage& file) {
    if (file.channels % 2 != 0) return 0; // gray or RGB
    const auto channels = static_cast<std::size_t>(file.channels);
    std::int64_t count = 0;
    for (std::size_t i = channels - 1; i < file.values.size(); i += channels) count += file.values[i] != 1;
    return count;
}

ComparedImage read_compared_image(const fs::path& path, bool decode) {
    const StoredImage file = read_stored_image(path);
    ComparedImage image{stored_values(file), {}, file.encoding, transparent_pixels(file)};
    if (decode && image.encoding == Encoding::kEncoded) {
        image.values = decoded(image.values);
        image.encoding = Encoding::kLinear;
    }
    if (lower_case_extension(path) == ".exr") image.variance = rgb_image("variance.", read_exr(path));
    return image;
}

void check_comparable(const ImagesOptions& options, const ComparedImage& a, const ComparedImage& b) {
    const auto size = [](const ComparedImage& p) { return message(p.values.width(), "x", p.values.height()); };
    if (size(a) != size(b))
        throw Error(message("the images differ in size: ", options.a.string(), " has ", size(a), " pixels, ",
                            options.reference.string(), " ", size(b)));
    if (a.encoding != b.encoding) {
        const bool a_is_8bit = a.encoding == Encoding::kEncoded;
        throw Error(message((a_is_8bit ? options.a : options.reference).string(), " holds encoded 8-bit values, ",
                            (a_is_8bit ? options.reference : options.a).string(),
                            " linear ones: --decode compares both as linear"));
    }
}

std::vector<Limit> parse_limits(const std::vector<std::string>& texts) {
    std::vector<Limit> limits;
    for (const std::string& text : texts) limits.push_back(parse_limit(text));
    return limits;
}

void check_limits(const std::vector<Limit>& limits, bool variances) {
    for (const Limit& limit : limits)
        if (!variances && limit.metric.rfind("z_", 0) == 0)
            throw Error(message("--fail-above ", limit.metric,
                                ": neither file has variances (EXR channels variance.R, variance.G, variance.B)"));
}

// The table ----------------------------------------------------------------------------------------------------------

std::string text_of(double value) { return std::isnan(value) ? "none" : significant(value, 6); }

void print_channels(std::ostream& out, const char* name, Rgbd c) {
    out << "  " << name << ": r " << text_of(c.r) << ", g " << text_of(c.g) << ", b " << text_of(c.b) << '\n';
}

void print_z_test(std::ostream& out, const ZTest& z, bool a_exact, bool b_exact) {
    out << "\nz-test of " << z.pixels << " pixels"
        << (a_exact   ? ", A taken as exact"
            : b_exact ? ", B taken as exact"
                      : "")
        << " (the noise of the two must be independent: two seeds)\n";
    if (z.tests == 0) {
        out << "  no pixel has a variance: nothing can be said\n";
        return;
    }
    print_channels(out, "mean difference in standard deviations", z.mean_z);
    print_channels(out, "a mean difference that would be found in 99 of 100 such pairs", z.detectable);
    out << "  " << (z.p < 0.01 ? "the images differ by more than noise" : "no difference but noise was found")
        << ": p = " << text_of(z.p) << " after correction for " << z.tests << " tests, the most unlikely being the "
        << "mean of channel "
        << "rgb"[z.channel] << " over " << z.width << "x" << z.height << " pixels at (" << z.x << ", " << z.y << ")\n";
}

void print_table(std::ostream& out, const ImageMetrics& metrics, const ComparedImage& a, const ComparedImage& b) {
    const ErrorMetrics& m = metrics.errors;
    out << (a.encoding == Encoding::kLinear
                ? "linear values\n"
                : "stored (sRGB-encoded) values; of relmse, smape and mean_signed_error the linear ones\n");
    for (const MetricValue& metric : metric_values(metrics)) {
        if (!metrics.z && metric.name.rfind("z_", 0) == 0) continue;
        print_cells(out, {-22, 12, 2, 0}, {metric.name, text_of(metric.value), "", metric.meaning});
    }
    print_channels(out, "mean signed error", m.mean_signed_error);
    if (m.pixels > 0) out << "  worst pixel: (" << m.worst_x << ", " << m.worst_y << ")\n";
    if (m.non_finite_a + m.non_finite_b > 0)
        out << "  left out: " << m.nan_a << " pixels with NaN and " << m.infinite_a << " with infinity in A, "
            << m.nan_b << " and " << m.infinite_b << " in B\n";
    if (a.transparent + b.transparent > 0)
        out << "  alpha is not compared: " << a.transparent << " pixels of A and " << b.transparent
            << " of B have one that is not 1\n";
    if (metrics.flip.exposures > 0)
        out << "  HDR-FLIP over " << metrics.flip.exposures << " exposures from "
            << text_of(metrics.flip.start_exposure) << " to " << text_of(metrics.flip.stop_exposure) << " stops\n";
    if (metrics.z) print_z_test(out, *metrics.z, a.variance.empty(), b.variance.empty());
}

// The page ------------------------------------------------------------------------------------------------------------

/// Returns the file names if they differ, else the paths as given.
std::pair<std::string, std::string> page_names(const ImagesOptions& options) {
    const fs::path a = options.a.filename(), b = options.reference.filename();
    if (a != b) return {a.string(), b.string()};
    return {options.a.string(), options.reference.string()};
}

/// Returns the metrics, and for each image the number of pixels whose alpha was ignored.
json metrics_json_with_alpha(const ImageMetrics& metrics, const ComparedImage& a, const ComparedImage& b) {
    json figures = metrics_json(metrics, "a", "b");
    figures["transparent"] = {{"a", a.transparent}, {"b", b.transparent}};
    return figures;
}

void write_page(const ImagesOptions& options, const ComparedImage& a, const ComparedImage& b,
                const ImageMetrics& metrics) {
    const bool encoded = a.encoding == Encoding::kEncoded;
    const ImageRgb linear_a = encoded ? decoded(a.values) : a.values, linear_b = encoded ? decoded(b.values) : b.values;
    const auto [name_a, name_b] = page_names(options);
    const double range = difference_range(linear_a, linear_b);
    write_image(options.folder / "difference.png", difference_image(linear_a, linear_b, range));
    write_json(options.folder / "report.json", {{"a", options.a.string()},
                                                {"b", options.reference.string()},
                                                {"metrics", metrics_json_with_alpha(metrics, a, b)},
                                                {"difference_range", range}});
    write_file(
        options.folder / "index.html",
        report_page(
            {message(name_a, " against ", name_b), {name_a, linear_a}, {name_b, linear_b}, metrics, a.encoding}));
    if (!options.quiet) std::cerr << "report: " << (options.folder / "index.html").string() << '\n';
}

} // namespace

int compare_images(const ImagesOptions& options) {
    check_json_path(options.stats);
    const std::vector<Limit> limits = parse_limits(options.limits);
    const ComparedImage a = read_compared_image(options.a, options.decode),
                        b = read_compared_image(options.reference, options.decode);
    check_comparable(options, a, b);
    const bool variances = !a.variance.empty() || !b.variance.empty();
    check_limits(limits, variances);

    if (!options.folder.empty()) make_folder(options.folder);
    ImageMetrics metrics = image_metrics(a.values, b.values, a.encoding, options.threads);
    if (variances) metrics.z = z_test({a.values, a.variance}, {b.values, b.variance});
    if (!options.folder.empty()) write_page(options, a, b, metrics);
    if (!options.quiet && options.stats != "-") print_table(std::cout, metrics, a, b);
    if (!options.stats.empty()) write_json(options.stats, metrics_json_with_alpha(metrics, a, b));
    const std::vector<std::string> failures = exceeded(limits, metric_values(metrics));
    for (const std::string& failure : failures) std::cerr << "compare: " << failure << '\n';
    return failures.empty() ? kExitOk : kExitFailed;
}

} // namespace duet::compare
