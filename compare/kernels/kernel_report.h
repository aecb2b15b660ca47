// What `compare kernels` found, for reading by people and by programs.
#pragma once

#include "compare/kernels/interleave.h"
#include "compare/kernels/judge.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

/// Rays of one work that got out of a closed room.
struct Leaks {
    std::int64_t ours = 0, peer = 0;
};

/// Ours against one setting of the peer, or ours alone.
struct KernelRow {
    std::string work; ///< "camera", "camera-bulk", "bounce", "shadow", "build", "memory"
    int threads = 1;
    std::string peer_name; ///< "embree 3.13.5 medium packets 16"; empty: no peer
    /// Million rays a second; seconds (build); bytes a triangle (memory). Of the pair of neighbouring measurements that
    /// has the median ratio; without a peer our median.
    double ours = 0, peer = 0;
    Range ratio;          ///< above 1: ours is ahead
    bool best = false;    ///< the peer's best setting for this work and number of threads: our lowest median ratio
    std::size_t rays = 0; ///< of one measurement
    int repeats = 0;      ///< pairs of measurements
    std::optional<Mismatches> mismatches;
    std::optional<Leaks> leaks;
};

/// All of one scene.
struct KernelTable {
    std::string mesh, scene;
    std::size_t triangles = 0, left_out = 0;
    int width = 0, height = 0;
    std::vector<KernelRow> rows;
    struct Aimed {
        std::string kernel;
        std::int64_t misses;
        Faults faults;
    };
    std::vector<Aimed> watertight; ///< ours first; empty where the scene is not closed, or no ray was asked for
    struct JudgedWork {
        std::string work;
        Faults found;
    };
    std::vector<JudgedWork> judged; ///< a sample of our answers, by the double-precision judge
};

/// Marks, among rows of the same work and threads, the one of our lowest median ratio.
void mark_best(std::vector<KernelRow>& rows);

/// "ahead" where every repeat was above 1, "behind" where every one was below, else "even"; of fewer repeats than
/// kLeastForVerdict "too few".
std::string verdict(const Range& ratio, int repeats);

/// Rows as in design: mesh, scene, triangles, work, threads, ours, peer, peer_name, ratio {min, median, max} (null
/// where there is no peer), best, rays, repeats, mismatches, leaks.
nlohmann::json rows_json(const KernelTable& table);
nlohmann::json watertight_json(const KernelTable& table);
nlohmann::json judged_json(const KernelTable& table);

/// One line for each work and number of threads, ours against the peer's best; then one for each work with what differs
/// and what leaks, of the peer's setting with the most to explain. Lines with something unexplained come first.
void print_table(std::ostream& out, const KernelTable& table);

/// What is wrong with ours, a line each: leaks, misses, edge faults, wrong answers. Empty: nothing.
std::vector<std::string> faults(const KernelTable& table);

} // namespace duet::compare
