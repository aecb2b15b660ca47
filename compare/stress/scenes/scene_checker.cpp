#include "compare/stress/scenes/scene_checker.h"

#include "common/system/error.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

namespace duet::compare {

namespace {

/// Returns the next line of JSON, or the reason why there is none. Other lines, such as a sanitizer's, go to `output`.
Subprocess::Read read_result(Subprocess& process, SceneTimeLimits limits, std::string& output) {
    constexpr std::chrono::milliseconds kPoll{50}; // interval at which the processor time is read
    auto processor_time = process.processor_time();
    const auto processor_limit = processor_time + limits.processor;
    auto last_progress = std::chrono::steady_clock::now();
    for (;;) {
        Subprocess::Read read = process.read_line(kPoll);
        const auto now = std::chrono::steady_clock::now();
        const auto before = std::exchange(processor_time, process.processor_time());
        if (processor_time > before) last_progress = now;
        const bool in_time = processor_time < processor_limit && now - last_progress < limits.waiting;
        const bool line = read.status == Subprocess::Status::kLine;
        if (read.status == Subprocess::Status::kEnd || (line && read.line.starts_with('{'))) return read;
        if (!in_time) return {Subprocess::Status::kTimeout};
        if (line) output += (output.empty() ? "" : " | ") + read.line;
    }
}

} // namespace

SceneVerdict SceneChecker::check(const std::filesystem::path& scene) {
    auto process = processes_.take(command_);
    std::string output;
    process->write_line(scene.string());
    const Subprocess::Read read = read_result(*process, limits_, output);
    if (read.status != Subprocess::Status::kLine) {
        const std::unique_ptr<Subprocess> ended(process.release()); // the process cannot check another scene
        if (read.status == Subprocess::Status::kEnd) return {.failure = "crash", .details = output};
        const std::chrono::duration<double> processor = limits_.processor, waiting = limits_.waiting;
        return {.failure = "hang",
                .details = message(processor.count(), " processor seconds, or ", waiting.count(), " s without any")};
    }
    const auto result = nlohmann::json::parse(read.line);
    if (result["verdict"] == "refused") return {.refused = true, .failure = {}, .details = result["details"]};
    return {.failure = result["failure"], .details = result["details"]};
}

} // namespace duet::compare
