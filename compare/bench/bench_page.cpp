#include "compare/bench/bench_report.h"
#include "compare/report/html.h"

#include <nlohmann/json.hpp>

namespace duet::compare {

std::string bench_page(const nlohmann::json& report) {
    return make_page(kBenchSource, "Run time against error", report);
}

} // namespace duet::compare
