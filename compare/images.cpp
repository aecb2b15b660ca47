#include "compare/images.h"

#include "common/image/image_file.h"
#include "common/program/program.h"
#include "common/program/statistics.h"
#include "compare/metrics/error_metrics.h"
#include "compare/report/report_json.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

struct NamedMetric {
    std::string name;
    double value;
};

std::vector<NamedMetric> named(const ErrorMetrics& m) {
    return {{"mse", m.mse},   {"rmse", m.rmse},     {"mae", m.mae},
            {"psnr", m.psnr}, {"relmse", m.relmse}, {"worst", m.worst}};
}

struct Limit {
    NamedMetric metric;
    double value;

    /// More error is worse; of the peak signal-to-noise ratio, less. NaN exceeds every limit.
    bool exceeded() const { return metric.name == "psnr" ? !(metric.value >= value) : !(metric.value <= value); }
};

Limit parse_limit(const std::string& text, const std::vector<NamedMetric>& metrics) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const auto metric =
        std::find_if(metrics.begin(), metrics.end(), [&](const NamedMetric& m) { return m.name == name; });
    const char* const begin = text.c_str() + (equals == std::string::npos ? text.size() : equals + 1);
    char* end = nullptr;
    const double value = std::strtod(begin, &end);
    if (metric == metrics.end() || end == begin || *end != '\0' || !std::isfinite(value))
        throw Error(message("--fail-above: found ", text,
                            ", expected METRIC=VALUE, METRIC being mse, rmse, mae, psnr, relmse or worst"));
    return {*metric, value};
}

void print_table(std::ostream& out, const std::vector<NamedMetric>& metrics, const ErrorMetrics& m) {
    out << std::setprecision(6);
    for (const NamedMetric& metric : metrics) out << std::left << std::setw(20) << metric.name << metric.value << '\n';
    out << std::setw(20) << "mean_signed_error" << m.mean_signed_error.r << ' ' << m.mean_signed_error.g << ' '
        << m.mean_signed_error.b << '\n';
    out << std::setw(20) << "worst_pixel" << m.worst_x << ' ' << m.worst_y << '\n';
    if (m.non_finite_a + m.non_finite_b > 0)
        out << std::setw(20) << "non_finite" << m.non_finite_a << " in A, " << m.non_finite_b << " in B\n";
}

} // namespace

int compare_images(const ImagesOptions& options) {
    const ErrorMetrics metrics = error_metrics(read_image(options.a), read_image(options.reference));
    const std::vector<NamedMetric> list = named(metrics);
    std::vector<Limit> limits;
    for (const std::string& text : options.limits) limits.push_back(parse_limit(text, list));
    if (!options.quiet && options.stats != "-") print_table(std::cout, list, metrics);
    if (!options.stats.empty()) write_json(options.stats, metrics_json(metrics, "a", "b"));
    int code = kExitOk;
    for (const Limit& limit : limits)
        if (limit.exceeded()) {
            std::cerr << "compare: " << limit.metric.name << " is " << limit.metric.value << ", the limit "
                      << limit.value << '\n';
            code = kExitFailed;
        }
    return code;
}

} // namespace duet::compare
