#include "compare/metrics/limits.h"

#include "common/system/error.h"
#include "compare/report/text.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace duet::compare {

namespace {

const MetricValue* find(const std::vector<MetricValue>& list, const std::string& name) {
    const auto at = std::find_if(list.begin(), list.end(), [&](const MetricValue& f) { return f.name == name; });
    return at == list.end() ? nullptr : &*at;
}

} // namespace

std::string metric_names() {
    std::vector<std::string> names;
    for (const MetricValue& metric : metric_values({})) names.push_back(metric.name);
    return joined(names);
}

Limit parse_limit(const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const char* const begin = text.c_str() + (equals == std::string::npos ? text.size() : equals + 1);
    char* end = nullptr;
    const double value = std::strtod(begin, &end);
    if (find(metric_values({}), name) == nullptr || end == begin || *end != '\0' || !std::isfinite(value))
        throw Error(
            message("--fail-above: found ", text, ", expected METRIC=VALUE, METRIC being one of ", metric_names()));
    return {name, value};
}

std::vector<std::string> exceeded(const std::vector<Limit>& limits, const std::vector<MetricValue>& found) {
    std::vector<std::string> sentences;
    for (const Limit& limit : limits) {
        const MetricValue& metric = *find(found, limit.metric);
        const double excess = metric.higher_is_better ? limit.value - metric.value : metric.value - limit.value;
        if (excess <= 0 || metric.value == limit.value) continue;
        if (std::isnan(metric.value))
            sentences.push_back(message(metric.name, " is no number, the limit ", limit.value));
        else
            sentences.push_back(message(metric.name, " is ", metric.value, ", the limit ", limit.value, ": ",
                                        metric.higher_is_better ? "below it by " : "above it by ", excess));
    }
    return sentences;
}

} // namespace duet::compare
