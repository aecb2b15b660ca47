#include "compare/stress/stress.h"

#include "common/system/error.h"
#include "compare/stress/errors.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

std::int64_t StressSetting::trials(std::int64_t by_default) const {
    return std::max<std::int64_t>(1, std::llround(static_cast<double>(by_default) * factor));
}

void StressOutcome::add(std::int64_t trial, double error, double bound) {
    worst = larger_error(error, worst);
    if (error <= bound) return; // false for a NaN
    ++failures;
    if (first_failure < 0 || trial < first_failure) first_failure = trial;
}

StressOutcome& StressOutcome::operator+=(const StressOutcome& other) {
    failures += other.failures;
    worst = larger_error(other.worst, worst);
    if (other.first_failure >= 0 && (first_failure < 0 || other.first_failure < first_failure))
        first_failure = other.first_failure;
    return *this;
}

std::vector<StressTest> all_stress_tests() {
    std::vector<StressTest> all;
    for (const auto group : {arithmetic_tests(), leak_tests(), intersection_tests(), ray_origin_tests(),
                             material_tests(), light_tests(), medium_tests(), coverage_tests(), projection_tests(),
                             pipeline_tests(), scene_tests()})
        all.insert(all.end(), group.begin(), group.end());
    return all;
}

namespace {

/// Returns whether the name begins with `part` at a word boundary.
bool begins(std::string_view name, std::string_view part) {
    return name.starts_with(part) &&
           (name.size() == part.size() || name[part.size()] == '/' || name[part.size()] == '-');
}

/// Returns the tests of exactly that name or, if there are none, those that begin with it.
std::vector<bool> meant(const std::vector<StressTest>& tests, const std::string& name) {
    std::vector<bool> whole, part;
    for (const StressTest& test : tests) {
        whole.push_back(test.name == name);
        part.push_back(begins(test.name, name));
    }
    return std::find(whole.begin(), whole.end(), true) != whole.end() ? whole : part;
}

} // namespace

std::vector<StressTest> select_stress_tests(const std::vector<std::string>& names) {
    const std::vector<StressTest> all = all_stress_tests();
    if (names.empty()) return all;
    std::vector<bool> chosen(all.size());
    for (const std::string& name : names) {
        const std::vector<bool> fit = meant(all, name);
        if (std::find(fit.begin(), fit.end(), true) == fit.end()) {
            std::string groups, last;
            for (const StressTest& test : all) {
                const std::string group(test.name.substr(0, test.name.find('/')));
                if (group != last) groups += (groups.empty() ? "" : ", ") + group;
                last = group;
            }
            throw Error(message("--only: found ", name, ", expected a test (--list names them), or one of the groups ",
                                groups));
        }
        for (std::size_t i = 0; i < all.size(); ++i) chosen[i] = chosen[i] || fit[i];
    }
    std::vector<StressTest> selected;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (chosen[i]) selected.push_back(all[i]);
    return selected;
}

} // namespace duet::compare
