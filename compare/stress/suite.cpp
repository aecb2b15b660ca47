#include "compare/stress/suite.h"

#include "common/program/program.h"
#include "common/program/statistics.h"
#include "common/system/error.h"
#include "common/system/stopwatch.h"
#include "compare/report/text.h"
#include "compare/stress/stress.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

std::string readable(double value) { return significant(value, 3); }

/// Prints the terminal's table; its column widths fit the selected names.
class Table {
public:
    Table(const std::vector<StressTest>& tests, bool visible) : visible_(visible) {
        for (const StressTest& test : tests) {
            name_ = std::max(name_, static_cast<int>(test.name.size()));
            bound_ = std::max(bound_, static_cast<int>(bound_text(test).size()));
        }
    }

    void head() const {
        row({"", "test", "trials", "failures", "worst", "", "bound", "books' failures", "worst", "",
             "source of the bound; the books' way"});
    }
    void add(const StressTest& test, const StressResult& result) const {
        row({result.failed() ? "FAILED" : "ok", std::string(test.name), message(result.trials),
             message(result.library.failures), readable(result.library.worst), "", bound_text(test),
             result.naive ? message(result.naive->failures) : "", result.naive ? readable(result.naive->worst) : "", "",
             std::string(test.source) + (test.naive.empty() ? "" : ". Books: " + std::string(test.naive))});
    }

private:
    static std::string bound_text(const StressTest& test) {
        return readable(test.bound) + " " + std::string(test.unit);
    }
    void row(const std::vector<std::string>& cells) const {
        if (!visible_) return;
        print_cells(std::cout, {-7, -name_, 9, 9, 10, 2, -bound_, 16, 10, 2, 0}, cells);
        std::cout.flush();
    }

    bool visible_;
    int name_ = 4, bound_ = 5; ///< widths
};

/// Prints the information that is needed to reproduce a failure.
void explain(const StressTest& test, const StressResult& result, const StressOptions& options) {
    std::cerr << "compare: " << test.name << ": ";
    if (result.trials < result.least_trials)
        std::cerr << result.trials << " trials judged anything, expected " << result.least_trials << " at least"
                  << (result.library.failures > 0 ? "; " : "\n");
    if (result.library.failures == 0) return;
    std::cerr << result.library.failures << " of " << result.trials << " trials failed, the first being number "
              << result.library.first_failure << " of seed " << options.seed;
    if (!result.details.empty()) std::cerr << ": " << result.details;
    std::cerr << "\n  what must hold: " << test.what << "\n  the bound's source: " << test.source << '\n';
}

/// Returns a number as JSON; a non-finite one becomes a string.
json number(double value) { return std::isfinite(value) ? json(value) : json(readable(value)); }

json as_json(const StressTest& test, const StressResult& result) {
    json row = {{"name", test.name},
                {"what", test.what},
                {"trials", result.trials},
                {"least_trials", result.least_trials},
                {"failures", result.library.failures},
                {"worst", number(result.library.worst)},
                {"bound", test.bound},
                {"unit", test.unit},
                {"source", test.source}};
    if (result.library.failures > 0) {
        row["first_failure"] = result.library.first_failure;
        row["account"] = result.details;
    }
    if (result.naive)
        row["naive"] = {
            {"what", test.naive}, {"failures", result.naive->failures}, {"worst", number(result.naive->worst)}};
    return row;
}

void print_list(const std::vector<StressTest>& tests) {
    for (const StressTest& test : tests) {
        std::cout << test.name << "\n  " << test.what << "\n  bound: " << readable(test.bound) << ' ' << test.unit
                  << " (" << test.source << ")\n";
        if (!test.naive.empty()) std::cout << "  the books' way: " << test.naive << '\n';
        std::cout << "  trials: " << test.trials << '\n';
    }
}

} // namespace

int stress(const StressOptions& options) {
    const std::vector<StressTest> tests = select_stress_tests(options.only);
    if (options.list) {
        print_list(tests);
        return kExitOk;
    }
    check_json_path(options.stats); // fails before a long run rather than after it
    const InterruptFlag interrupt;
    const Stopwatch watch;
    const Table table(tests, !options.quiet && options.stats != "-");
    table.head();
    json rows = json::array();
    std::size_t failed = 0;
    ProgressBar bar("stress", options.quiet);
    for (std::size_t i = 0; i < tests.size(); ++i) {
        const StressSetting setting{options.seed, options.factor, options.threads,
                                    bar.control(interrupt, i, tests.size())};
        const StressResult result = tests[i].run(tests[i], setting);
        bar.finish();
        if (interrupt.raised()) return kExitInterrupted;
        table.add(tests[i], result);
        if (result.failed()) {
            explain(tests[i], result, options);
            ++failed;
        }
        rows.push_back(as_json(tests[i], result));
    }
    if (!options.stats.empty()) {
        const json statistics = {{"program", "compare stress"},
                                 {"version", DUET_VERSION},
                                 {"seed", options.seed},
                                 {"factor", options.factor},
                                 {"tests", rows}};
        write_json(options.stats, statistics);
    }
    if (!options.quiet)
        std::cerr << tests.size() << " tests in " << format_duration(watch.seconds()) << ", " << failed << " failed\n";
    return failed > 0 ? kExitFailed : kExitOk;
}

} // namespace duet::compare
