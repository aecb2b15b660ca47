#include "compare/kernels/kernels.h"

#include "common/program/program.h"
#include "common/program/statistics.h"
#include "common/system/parallel.h"
#include "common/system/stopwatch.h"
#include "common/system/suggestion.h"

#include <iostream>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

constexpr const char* kEmbreeMissing =
    "no peer: this program was built without Embree. Install it (Debian, Ubuntu: apt install libembree-dev), then "
    "configure and build again";

std::vector<std::string> chosen_works(const std::vector<std::string>& works) {
    for (const std::string& work : works) name_index("--work", work, {kWorks.begin(), kWorks.end()});
    return works.empty() ? kWorks : works;
}

std::vector<EmbreeQuality> chosen_peers(const std::vector<std::string>& names) {
    if (names == std::vector<std::string>{"none"}) return {};
    const std::vector<EmbreeQuality> all = embree_qualities();
    if (all.empty()) {
        if (!names.empty()) throw Error("--peers: found " + names.front() + ", but " + kEmbreeMissing);
        return {};
    }
    std::vector<std::string> known;
    for (const EmbreeQuality& quality : all) known.push_back(name_of(quality));
    std::vector<EmbreeQuality> chosen;
    for (const std::string& name : names)
        chosen.push_back(all[name_index("--peers", name, {known.begin(), known.end()})]);
    return names.empty() ? all : chosen;
}

/// A Case to measure is a file in one of its possible arrangements.
struct Case {
    std::filesystem::path file;
    Arrangement arrangement;
};

std::vector<Case> cases_of(const KernelsOptions& options) {
    std::vector<Arrangement> arrangements;
    for (const std::string& name : options.scenes) arrangements.push_back(parse_arrangement(name));
    std::vector<Case> cases;
    for (const std::filesystem::path& file : options.meshes) {
        if (!is_bare_mesh(file))
            cases.push_back({file, Arrangement::kAlone});
        else
            for (const Arrangement arrangement : arrangements) cases.push_back({file, arrangement});
    }
    return cases;
}

json report_json(const KernelSettings& settings, const std::vector<KernelResults>& tables) {
    json rows = json::array(), watertight = json::array(), judged = json::array();
    for (const KernelResults& table : tables) {
        for (json& row : rows_json(table)) rows.push_back(std::move(row));
        for (json& row : watertight_json(table)) watertight.push_back(std::move(row));
        for (json& row : judged_json(table)) judged.push_back(std::move(row));
    }
    const bool peer = !settings.peers.empty();
    return {{"program", "compare kernels"},
            {"version", DUET_VERSION},
            {"peer", peer ? json(embree_version()) : json(nullptr)},
            {"width", settings.size.width},
            {"height", settings.size.height},
            {"threads", settings.threads},
            {"seed", settings.seed},
            {"rows", rows},
            {"watertight", watertight},
            {"judged", judged}};
}

} // namespace

int kernels(const KernelsOptions& options) {
    check_json_path(options.stats);
    KernelSettings settings = options.settings;
    settings.works = chosen_works(settings.works);
    settings.peers = chosen_peers(options.peers);
    if (settings.threads == 0) settings.threads = available_threads();
    const std::vector<Case> cases = cases_of(options);
    const bool table_wanted = !options.quiet && options.stats != "-";

    const InterruptFlag interrupt;
    std::vector<KernelResults> tables;
    ProgressBar bar("kernels", options.quiet);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Control control = bar.control(interrupt, i, cases.size());
        const KernelScene scene = load_kernel_scene(cases[i].file, cases[i].arrangement);
        tables.push_back(measure_kernels(scene, settings, control));
        if (interrupt.raised()) return kExitInterrupted;
        bar.finish();
        if (table_wanted) print_table(std::cout, tables.back());
        std::cout.flush();
    }
    if (!options.quiet && embree_version().empty()) std::cerr << "compare: " << kEmbreeMissing << '\n';
    if (!options.stats.empty()) write_json(options.stats, report_json(settings, tables));
    int code = kExitOk;
    for (const KernelResults& table : tables)
        for (const std::string& fault : kernel_failures(table)) {
            std::cerr << "compare: " << fault << '\n';
            code = kExitFailed;
        }
    return code;
}

} // namespace duet::compare
