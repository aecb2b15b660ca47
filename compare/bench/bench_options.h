// This file defines the options of `compare bench`.
#pragma once

#include "common/program/command_line.h"
#include "compare/bench/bench_renderer.h"
#include "compare/bench/exclusion.h"
#include "compare/bench/measure.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

/// Holds the options of `compare bench`.
struct BenchOptions {
    std::vector<std::filesystem::path> scenes;
    std::filesystem::path folder;     ///< output folder for the reports and plots; empty: none
    std::filesystem::path baseline;   ///< report.json of an earlier run to compare with; empty: none
    std::filesystem::path references; ///< cache folder; empty: default_reference_folder()
    ImageSize size{0, 0};             ///< 0 × 0: the scene's aspect ratio with about 65,536 pixels
    RendererChoice choice;
    std::string peer;            ///< "cycles" or "eevee"; empty: none
    std::vector<double> equal_times_seconds; ///< times in seconds at which errors are compared; empty: none
    BenchMeasureSettings measure;
    std::string reference_by = "path"; ///< the integrator that renders references
    int reference_spp = 0; ///< 0: 16 × the maximum of choice.spps
    int check_spp = 0;     ///< spp of the references by independent estimators; 0: reference_spp
    std::vector<ExcludedRectangle> excluded;
    double drift = 0.15; ///< relative change of a CPU's speed between runs; smaller differences are not findings
    std::string stats;   ///< file for a copy of report.json; "-" for standard output; empty: none
    bool quiet = false;  ///< no progress bar, no tables
};

} // namespace duet::compare
