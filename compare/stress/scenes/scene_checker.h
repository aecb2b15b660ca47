// Checks scenes in other processes, which may crash or hang.
#pragma once

#include "common/system/object_pool.h"
#include "compare/peers/subprocess.h"

#include <filesystem>
#include <shared_mutex>
#include <string>
#include <vector>

namespace duet::compare {

/// The result of `compare check` for one scene.
struct SceneVerdict {
    bool refused = false;     ///< the scene cannot be loaded; `details` says why
    std::string failure{};    ///< what does not hold (CheckResult), "crash" or "hang"; empty: nothing
    std::string details{};

    bool failed() const { return !failure.empty(); }
};

/// Runs processes that read names of scenes and print a line of JSON for each, as `compare check -` does. Each checks
/// many scenes, one after the other.
class SceneChecker {
public:
    /// `command` starts a process. A scene hangs that takes more than `seconds` twice: among others, and then alone,
    /// when no other scene takes its processors.
    SceneChecker(std::vector<std::string> command, int seconds) : command_(std::move(command)), seconds_(seconds) {}

    /// Checks one scene file. Threads may call this at the same time.
    SceneVerdict check(const std::filesystem::path& scene);

private:
    SceneVerdict check_once(const std::filesystem::path& scene);

    std::vector<std::string> command_;
    int seconds_;
    std::shared_mutex alone_; ///< locked alone by a scene that is checked alone
    ObjectPool<Subprocess> processes_;
};

} // namespace duet::compare
