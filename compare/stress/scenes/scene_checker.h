// This file checks scenes in other processes, which may crash or hang.
#pragma once

#include "common/system/object_pool.h"
#include "compare/peers/subprocess.h"

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

/// Holds the result of `compare check` for one scene.
struct SceneVerdict {
    bool refused = false;     ///< the scene cannot be loaded; `details` says why
    std::string failure{};    ///< the violated requirement (CheckResult), "crash" or "hang"; empty: nothing
    std::string details{};

    bool failed() const { return !failure.empty(); }
};

/// Holds how long a scene may take before it counts as one that hangs. The limit is on processor time, which does not
/// depend on other programs. A deadlocked process uses none, so there is also a limit on waiting.
struct SceneTimeLimits {
    std::chrono::milliseconds processor{10'000}; ///< of all threads together
    std::chrono::milliseconds waiting{60'000};   ///< by the clock, without any processor time
};

/// Runs processes that read names of scenes and print a line of JSON for each, as `compare check -` does. Each checks
/// many scenes, one after the other.
class SceneChecker {
public:
    /// Each process is started by `command`.
    SceneChecker(std::vector<std::string> command, SceneTimeLimits limits)
        : command_(std::move(command)), limits_(limits) {}

    /// Checks one scene file. Threads may call this at the same time.
    SceneVerdict check(const std::filesystem::path& scene);

private:
    std::vector<std::string> command_;
    SceneTimeLimits limits_;
    ObjectPool<Subprocess> processes_;
};

} // namespace duet::compare
