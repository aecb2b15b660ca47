#include "compare/check/check.h"

#include "common/program/program.h"
#include "common/program/render_program.h"
#include "common/system/error.h"
#include "common/system/stopwatch.h"

#include <cerrno>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sys/resource.h>

namespace duet::compare {

namespace {

using nlohmann::json;

void limit_memory(int mebibytes) {
    const rlim_t bytes = static_cast<rlim_t>(mebibytes) << 20;
    const rlimit limit{bytes, bytes};
    if (::setrlimit(RLIMIT_AS, &limit) != 0)
        throw Error(message("--memory ", mebibytes, ": the limit cannot be set: ", std::strerror(errno)), 1);
}

/// Checks a scene that has been loaded. Such a scene must be renderable, so an Error counts as a failure.
CheckResult check_loaded(const Scene& scene, const ComparisonSettings& settings) {
    try {
        return check_scene(scene, settings);
    } catch (const Error& error) {
        return {"error", error.what()};
    }
}

/// Checks the scene and prints the result. Returns the exit code that it stands for.
int check_file(const std::string& name, const CheckOptions& options) {
    const Stopwatch watch;
    json line = {{"scene", name}};
    int exit_code = kExitOk;
    std::optional<Scene> scene;
    try {
        scene = load_scene(name, SceneOptions{options.size});
    } catch (const Error& error) {
        line["verdict"] = "refused";
        line["details"] = error.what();
        exit_code = kExitUnusable;
    }
    if (scene) {
        const CheckResult result = check_loaded(*scene, options.settings);
        line["verdict"] = result.failed() ? "failed" : "ok";
        line["failure"] = result.failure;
        line["details"] = result.details;
        if (result.failed()) exit_code = kExitFailed;
    }
    line["seconds"] = watch.seconds();
    std::cout << line.dump(-1, ' ', true, json::error_handler_t::replace) << std::endl;
    return exit_code;
}

} // namespace

int check(const CheckOptions& options) {
    if (options.memory_limit > 0) limit_memory(options.memory_limit);
    bool failed = false, refused = false;
    const auto add = [&](const std::string& name) {
        const int exit_code = check_file(name, options);
        failed |= exit_code == kExitFailed;
        refused |= exit_code == kExitUnusable;
    };
    for (const std::string& scene : options.scenes) {
        if (scene != "-") {
            add(scene);
            continue;
        }
        for (std::string name; std::getline(std::cin, name);) add(name);
    }
    return failed ? kExitFailed : refused ? kExitUnusable : kExitOk;
}

} // namespace duet::compare
