// Checks scenes in other processes, which may crash or hang.
#pragma once

#include "compare/peers/subprocess.h"

#include <filesystem>
#include <memory>
#include <mutex>
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
    /// `command` starts a process. A scene that takes more than `seconds` hangs.
    SceneChecker(std::vector<std::string> command, int seconds) : command_(std::move(command)), seconds_(seconds) {}

    /// Checks one scene file. Threads may call this at the same time.
    SceneVerdict check(const std::filesystem::path& scene);

private:
    std::unique_ptr<Subprocess> take_process();

    std::vector<std::string> command_;
    int seconds_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<Subprocess>> idle_;
};

} // namespace duet::compare
