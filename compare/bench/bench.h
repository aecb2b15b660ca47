// `compare bench`: run time against error.
#pragma once

#include "common/program/render_program.h"
#include "compare/bench/contender.h"
#include "compare/bench/exclusion.h"
#include "compare/bench/measure.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

struct BenchOptions {
    std::vector<std::filesystem::path> scenes;
    std::filesystem::path folder;     ///< for index.html, report.json and bench.csv; empty: none
    std::filesystem::path baseline;   ///< an earlier report.json to compare with; empty: none
    std::filesystem::path references; ///< the cache; empty: default_reference_folder()
    PictureSize size{0, 0};           ///< 0 × 0: the scene's shape with about 65,536 pixels
    ContenderChoice choice;
    std::string peer;            ///< "cycles", or empty: none
    std::vector<double> moments; ///< seconds at which errors are compared; empty: none
    MeasureSettings measure;
    int reference_spp = 0; ///< 0: 16 × the largest of choice.spps
    int check_spp = 0;     ///< of the independent estimators' references, which check it; 0: as many
    std::vector<ExcludedRectangle> excluded;
    double drift = 0.15; ///< what a machine's speed may change by between runs: slower by no more is no finding
    std::string stats;   ///< a file for report.json's figures too, "-": standard output, empty: none
    bool quiet = false;  ///< no progress bar, no tables
};

/// Measures the scenes one after the other, prints tables, writes the report. Returns 0; 1 where two independent
/// references of a scene disagree or the baseline finds a row slower or less accurate; 130 where a signal came (no
/// report is written; finished references stay). Throws Error for scenes, options and files that cannot be used.
int bench(const BenchOptions& options);

} // namespace duet::compare
