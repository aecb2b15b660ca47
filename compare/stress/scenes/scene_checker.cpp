#include "compare/stress/scenes/scene_checker.h"

#include "common/system/error.h"

#include <chrono>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

/// Returns the next line of JSON, or the reason why there is none. Other lines, such as a sanitizer's, go to `output`.
Subprocess::Read read_result(Subprocess& process, int seconds, std::string& output) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    for (;;) {
        const auto left = deadline - std::chrono::steady_clock::now();
        const Subprocess::Read read = process.read_line(std::chrono::duration_cast<std::chrono::milliseconds>(left));
        if (read.status != Subprocess::Status::kLine || read.line.starts_with('{')) return read;
        output += (output.empty() ? "" : " | ") + read.line;
    }
}

} // namespace

SceneVerdict SceneChecker::check(const std::filesystem::path& scene) {
    {
        const std::shared_lock beside_others(alone_);
        SceneVerdict verdict = check_once(scene);
        if (verdict.failure != "hang") return verdict;
    }
    const std::unique_lock alone(alone_);
    return check_once(scene);
}

SceneVerdict SceneChecker::check_once(const std::filesystem::path& scene) {
    auto process = processes_.take(command_);
    std::string output;
    process->write_line(scene.string());
    const Subprocess::Read read = read_result(*process, seconds_, output);
    if (read.status != Subprocess::Status::kLine) {
        const std::unique_ptr<Subprocess> ended(process.release()); // cannot check another scene
        if (read.status == Subprocess::Status::kEnd) return {.failure = "crash", .details = output};
        return {.failure = "hang", .details = message("more than ", seconds_, " s")};
    }
    const auto result = nlohmann::json::parse(read.line);
    if (result["verdict"] == "refused") return {.refused = true, .failure = {}, .details = result["details"]};
    return {.failure = result["failure"], .details = result["details"]};
}

} // namespace duet::compare
