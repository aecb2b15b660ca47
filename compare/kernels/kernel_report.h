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

/// Rays that got out of a closed room.
struct Leaks {
    std::int64_t ours = 0, peer = 0;
};

/// Ours against one setting of the peer, or ours alone.
struct KernelRow {
    std::string work; ///< "camera", "camera-bulk", "bounce", "shadow", "build", "memory"
    int threads = 1;
    double ours = 0;       ///< million rays a second; seconds (build); bytes a triangle (memory)
    std::string peer_name; ///< "embree 3.13.5 medium packets 16"; empty: no peer
    double peer = 0;
    Range ratio;          ///< above 1: ours is ahead
    bool best = false;    ///< of the peer's settings for this work and number of threads
    std::size_t rays = 0; ///< of one measurement
    int repeats = 0;      ///< measurements of the peer
    std::optional<Mismatches> mismatches;
    std::optional<Leaks> leaks;
};

/// All of one scene.
struct KernelTable {
    std::string mesh, scene;
    std::size_t triangles = 0, left_out = 0;
    int width = 0, height = 0;
    std::vector<KernelRow> rows;
    struct Missed {
        std::string kernel;
        std::int64_t rays, misses;
    };
    std::vector<Missed> watertight; ///< ours first; empty where the mesh is not closed, or no ray was asked for
    struct JudgedWork {
        std::string work;
        Judged found;
    };
    std::vector<JudgedWork> judged; ///< a sample of our answers, by the double-precision judge
    std::int64_t our_leaks = 0;     ///< of camera and bounce rays in a closed room
};

/// Marks, among rows of the same work and threads, the one in which the peer did best.
void mark_best(std::vector<KernelRow>& rows);

/// "ahead" where every repeat was above 1, "behind" where every one was below, else "even".
std::string verdict(const Range& ratio);

/// Rows as in design: mesh, scene, triangles, work, threads, ours, peer, peer_name, ratio {min, median, max} (null
/// where there is no peer), best, rays, repeats, mismatches, leaks.
nlohmann::json rows_json(const KernelTable& table);
nlohmann::json watertight_json(const KernelTable& table);
nlohmann::json judged_json(const KernelTable& table);

/// One line for each work and number of threads: ours against the peer's best.
void print_table(std::ostream& out, const KernelTable& table);

/// What is wrong with ours, a line each: leaks, misses, wrong answers. Empty: nothing.
std::vector<std::string> faults(const KernelTable& table);

} // namespace duet::compare
