#include "compare/metrics/limits.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace duet::compare {

namespace {

const Figure* find(const std::vector<Figure>& list, const std::string& name) {
    const auto at = std::find_if(list.begin(), list.end(), [&](const Figure& f) { return f.name == name; });
    return at == list.end() ? nullptr : &*at;
}

} // namespace

std::string metric_names() {
    std::string names;
    for (const Figure& figure : figures({})) names += (names.empty() ? "" : ", ") + figure.name;
    return names;
}

Limit parse_limit(const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const char* const begin = text.c_str() + (equals == std::string::npos ? text.size() : equals + 1);
    char* end = nullptr;
    const double value = std::strtod(begin, &end);
    if (find(figures({}), name) == nullptr || end == begin || *end != '\0' || !std::isfinite(value))
        throw Error(
            message("--fail-above: found ", text, ", expected METRIC=VALUE, METRIC being one of ", metric_names()));
    return {name, value};
}

std::vector<std::string> exceeded(const std::vector<Limit>& limits, const std::vector<Figure>& found) {
    std::vector<std::string> sentences;
    for (const Limit& limit : limits) {
        const Figure& figure = *find(found, limit.metric);
        const double excess = figure.less_is_worse ? limit.value - figure.value : figure.value - limit.value;
        if (excess <= 0 || figure.value == limit.value) continue;
        if (std::isnan(figure.value))
            sentences.push_back(message(figure.name, " is no number, the limit ", limit.value));
        else
            sentences.push_back(message(figure.name, " is ", figure.value, ", the limit ", limit.value, ": ",
                                        figure.less_is_worse ? "below it by " : "above it by ", excess));
    }
    return sentences;
}

} // namespace duet::compare
