// This file writes the results of `compare kernels` as JSON and as text.
#pragma once

#include "compare/kernels/hit_oracle.h"
#include "compare/kernels/interleave.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

/// Counts the rays of one workload that escaped from a closed room.
struct Leaks {
    std::int64_t ours = 0, peer = 0;
};

/// Holds the comparison of Duet with one setting of the peer, or Duet's measurement alone.
struct KernelRow {
    std::string work; ///< "camera", "camera-bulk", "bounce", "shadow", "build", "memory"
    int threads = 1;
    std::string peer_name; ///< "embree 3.13.5 medium packets 16"; empty: no peer
    /// These are million rays per second, seconds (build), or bytes per triangle (memory). The values are from the pair
    /// of adjacent measurements with the median ratio; without a peer, they are Duet's median.
    double ours = 0, peer = 0;
    MedianRange ratio;    ///< above 1: Duet is faster
    bool best = false;    ///< the peer's best setting for this workload and thread count, with the lowest median ratio
    std::size_t rays = 0; ///< rays of one measurement
    int repeats = 0;      ///< pairs of measurements
    std::optional<Mismatches> mismatches;
    std::optional<Leaks> leaks;
};

/// Holds all results of one scene.
struct KernelResults {
    std::string mesh, scene;
    std::size_t triangles = 0, omitted_spheres = 0;
    int width = 0, height = 0;
    std::vector<KernelRow> rows;
    struct Aimed {
        std::string kernel;
        std::int64_t misses;
        KernelErrors faults;
    };
    std::vector<Aimed> watertight; ///< Duet first; empty if the scene is not closed or no rays were requested
    struct CheckedWork {
        std::string work;
        KernelErrors found;
    };
    std::vector<CheckedWork> judged; ///< findings of the double-precision oracle on a sample of Duet's results
};

/// Marks the row with the lowest median ratio among rows of the same workload and thread count.
void mark_best(std::vector<KernelRow>& rows);

/// Returns "ahead" if every repeat was above 1, "behind" if every one was below, else "even"; "too few" for
/// fewer repeats than kMinRepeatsForVerdict.
std::string verdict(const MedianRange& ratio, int repeats);

/// Returns an array of objects with mesh, scene, triangles, work, threads, ours, peer, peer_name, ratio {min, median,
/// max} (null without a peer), best, repeats; for rays also rays and as_rendered; mismatches and leaks if they were
/// counted.
nlohmann::json rows_json(const KernelResults& table);
/// Returns one entry per kernel of the watertightness test: mesh, scene, triangles, kernel, misses, and its faults.
nlohmann::json watertight_json(const KernelResults& table);
/// Returns one entry per workload: mesh, scene, work, and the faults that the oracle found in a sample of Duet's
/// results.
nlohmann::json judged_json(const KernelResults& table);

/// Prints one line for each workload and thread count, with Duet against the peer's best setting. Then prints one line
/// for each workload with the mismatches and leaks, for the peer's setting with the most of them; lines with
/// unexplained mismatches come first.
void print_table(std::ostream& out, const KernelResults& table);

/// Returns Duet's errors, one line each: leaks, misses, edge faults, wrong results. The list is empty if there are
/// none.
std::vector<std::string> kernel_failures(const KernelResults& table);

} // namespace duet::compare
