// These tests render random valid scenes with both pipelines.
#include "common/system/error.h"
#include "common/system/file.h"
#include "compare/peers/temporary_folder.h"
#include "compare/stress/scenes/reduce_scene.h"
#include "compare/stress/scenes/scene_checker.h"
#include "compare/stress/scenes/scene_files.h"
#include "compare/stress/scenes/schema_values.h"

#include <algorithm>
#include <mutex>
#include <span>

namespace duet::compare {

extern const std::string_view kSceneSchema; // models/scene.schema.json, embedded by CMakeLists.txt

namespace {

namespace fs = std::filesystem;

constexpr int kAttempts = 8; ///< attempts to draw a scene that is neither refused nor empty
constexpr double kReduceSeconds = 120;

/// Returns the process that checks scenes, with its budget of memory and time for each.
SceneChecker scene_checker() {
    std::vector<std::string> command{"/proc/self/exe", "check", "-", "--size", "32x32"};
#ifdef DUET_SANITIZED // slow, and with a large address space of its own
    constexpr std::chrono::seconds kLimit{200};
#else
    constexpr std::chrono::seconds kLimit{10};
    command.insert(command.end(), {"--memory", "4096"});
#endif
    return SceneChecker(std::move(command), {.processor = kLimit});
}

/// Draws the sizes of a scene. Most scenes are of ordinary size about the origin. The others are tiny, huge or far
/// away, or have numbers from anywhere in their ranges.
SceneSizes random_sizes(TrialRandom& random) {
    SceneSizes sizes;
    if (random.below(4) == 0) sizes.unit = static_cast<double>(random.log_uniform(1e-6f, 1e6f));
    if (random.below(4) == 0)
        for (double& x : sizes.middle)
            x = sizes.unit * static_cast<double>(random.sign() * random.log_uniform(1, 1e3f));
    if (random.below(3) == 0) sizes.extreme = static_cast<double>(random.log_uniform(1e-3f, 0.1f));
    return sizes;
}

/// Returns whether a scene shows a shape that is not part of an instance. In a scene without such a shape, the check
/// finds almost nothing.
bool shows_shape(const Json& objects) {
    return std::any_of(objects.begin(), objects.end(), [](const Json& object) {
        if (object["type"] == "group") return !object.value("hidden", false) && shows_shape(object["objects"]);
        return object["type"] != "instance";
    });
}

/// Holds what all trials share: the files that scenes use, and the processes that check them.
class SceneTrials {
public:
    SceneTrials() : files_(write_scene_files(folder_.path())) {}

    void run(Trial& trial) {
        const fs::path file = folder_.path() / message("scene-", trial.number(), ".json");
        Json scene;
        SceneVerdict verdict;
        bool judged = false;
        for (int i = 0; i < kAttempts && !judged; ++i) {
            const SceneSizes sizes = random_sizes(trial.random);
            scene = SchemaValues(schema_, files_, sizes, trial.random).scene();
            write_file(file, scene.dump(1));
            verdict = checker_.check(file);
            judged = verdict.failed() || (!verdict.refused && shows_shape(scene["objects"]));
        }
        // A tenth of the scenes is refused and fewer are empty. It practically never happens that all kAttempts of them
        // are.
        if (!judged) verdict.failure = verdict.refused ? "refused" : "empty";
        trial.record_failure_if(verdict.failed());
        if (verdict.failed())
            keep({trial.number(), std::move(scene), std::move(verdict)});
        else
            fs::remove(file);
    }

    /// Returns a message about the first scene of each kind of failure, with a reduced scene that fails in the same
    /// way. A request to stop ends the reduction.
    std::string explain(const Control& control) {
        std::string text;
        for (const auto& entry : first_) {
            const Failure& failure = entry.second;
            const fs::path file = folder_.path() / message("reduced-", failure.number, ".json");
            const Json reduced = reduce_scene(failure.scene, kReduceSeconds, [&](const Json& part) {
                if (control.stopped()) return false;
                write_file(file, part.dump(1));
                return checker_.check(file).failure == failure.verdict.failure;
            });
            write_file(file, reduced.dump(1));
            text += message("\n  number ", failure.number, ": ", failure.verdict.failure, " (", failure.verdict.details,
                            "); this part of the scene fails alike: ", reduced.dump());
        }
        return text + "\n  the scenes that failed are in " + folder_.path().string();
    }

private:
    struct Failure {
        std::int64_t number = 0; ///< number of the trial
        Json scene;
        SceneVerdict verdict;
    };
    void keep(Failure failure) {
        const std::lock_guard lock(mutex_);
        folder_.keep();
        const auto [first, is_new] = first_.try_emplace(failure.verdict.failure, failure);
        if (failure.number < first->second.number) first->second = std::move(failure);
    }

    const Json schema_ = Json::parse(kSceneSchema);
    TemporaryFolder folder_{"duet-scenes"};
    const std::map<std::string, std::vector<std::string>> files_;
    std::mutex mutex_;
    std::map<std::string, Failure> first_; ///< key: kind of failure
    SceneChecker checker_ = scene_checker();
};

StressResult valid_scenes(const StressTest& test, const StressSetting& setting) {
    SceneTrials trials;
    StressResult result = run_trials(test, setting, [&](Trial& trial) { trials.run(trial); });
    if (result.library.failures > 0) result.details = trials.explain(setting.control);
    return result;
}

constexpr StressTest kTests[] = {
    {.name = "scenes/valid",
     .what = "both programs render any scene that the format allows, at 32x32 pixels in 10 processor seconds and "
             "4 GiB: explained hits, valid samples, the same bits for 1 and 3 threads",
     .bound = 0,
     .unit = "failed",
     .source = "the requirements of `compare check`; scenes are drawn by models/scene.schema.json",
     .naive = "",
     .trials = 100,
     .run = valid_scenes},
};

} // namespace

std::span<const StressTest> scene_tests() { return kTests; }

} // namespace duet::compare
