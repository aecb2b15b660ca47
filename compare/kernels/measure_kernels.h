// This file declares all measurements of one scene: builds, memory, and each kind of ray, with one thread and with
// many.
#pragma once

#include "common/program/command_line.h"
#include "common/system/control.h"
#include "compare/kernels/kernel_report.h"
#include "compare/kernels/kernel_scene.h"
#include "compare/peers/embree.h"

#include <string>
#include <vector>

namespace duet::compare {

/// These are the names of the workloads: build, camera, camera-bulk, bounce, shadow.
extern const std::vector<std::string> kWorks;

/// Says what is measured, and for how long.
struct KernelSettings {
    std::vector<std::string> works;   ///< some of kWorks
    std::vector<EmbreeQuality> peers; ///< empty: Duet alone
    ImageSize size{1920, 1080};
    int threads = 0; ///< threads of the second set of rows; 1: no second set
    int repeats = 7;
    double seconds = 0.15;               ///< duration of one measurement of rays
    std::int64_t watertight = 1'000'000; ///< number of rays of the watertightness test; 0: none
    std::uint64_t seed = 0;
};

/// Measures the scene. The result is meaningless if `control` was stopped.
KernelResults measure_kernels(const KernelScene& scene, const KernelSettings& settings, const Control& control);

} // namespace duet::compare
