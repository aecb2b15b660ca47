// The program that examines one lab: runs its items and writes what came of them as JSON.
#include "tests/grading/channel.h"
#include "tests/grading/judge.h"
#include "tests/grading/sandbox.h"

#include <nlohmann/json.hpp>

#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iostream>
#include <sys/prctl.h>
#include <sys/wait.h>

namespace {

using namespace duet::grading;
using Json = nlohmann::ordered_json;

struct Arguments {
    std::string worker, out;
    std::string until; ///< ends the examination with the item that fails with this text; items of 0 points are left out
    std::uint64_t seed = 1;
    bool shown = false; ///< examines items of 0 points alone, which show images
    double seconds = 0; ///< the time that a call may take, where the item doesn't say it; 0 for the usual time
    bool trusted = false;
};

Arguments read_arguments(int count, char** values) {
    Arguments arguments;
    for (int i = 1; i < count; ++i) {
        const std::string option = values[i];
        if (option == "--trusted")
            arguments.trusted = true;
        else if (option == "--shown")
            arguments.shown = true;
        else if (i + 1 == count)
            throw duet::Error("judge: " + option + " needs a value");
        else if (option == "--worker")
            arguments.worker = values[++i];
        else if (option == "--out")
            arguments.out = values[++i];
        else if (option == "--seed")
            arguments.seed = std::stoull(values[++i]);
        else if (option == "--until")
            arguments.until = values[++i];
        else if (option == "--seconds")
            arguments.seconds = std::stod(values[++i]);
        else
            throw duet::Error("judge: unknown option " + option +
                              "; expected --worker, --out, --seed, --until, --seconds, --shown or --trusted");
    }
    if (arguments.out.empty())
        throw duet::Error("usage: judge --out FOLDER [--worker PROGRAM] [--seed N] [--until TEXT] [--seconds N] "
                          "[--shown] [--trusted]");
    return arguments;
}

/// Text of unknown origin as valid UTF-8, which JSON asks for.
std::string valid_utf8(const std::string& text) {
    return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

Json failed_result(const ItemDefinition& definition, const std::string& text) {
    return {{"title", definition.title},
            {"points", definition.points},
            {"earned", 0},
            {"status", "failed"},
            {"message", text}};
}

/// A function that says not_attempted() has no answer yet: not even where what the starter returns happens to be right.
void mark_not_attempted(Json& result, const std::vector<std::string>& functions) {
    if (functions.empty() || (result["status"] == "passed" && result["points"] == 0)) return;
    std::string text = "Not attempted yet: ";
    for (const std::string& function : functions) text += (&function == &functions[0] ? "" : ", ") + function;
    if (result["status"] == "passed") {
        text += ". What the starter returns happens to be right here. Remove not_attempted() where you have begun.";
    } else {
        text += ". " + result["message"].get<std::string>();
    }
    result["status"] = "not_attempted";
    result["message"] = text;
    result["not_attempted"] = functions;
}

/// Runs one item in a worker of its own.
Json run_item(const Arguments& arguments, int index, const ItemDefinition& definition) {
    Limits limits;
    limits.sandbox = !arguments.trusted;
    if (arguments.seconds > 0) limits.seconds = arguments.seconds;
    Session session(arguments.worker, limits);
    set_session(&session);
    Item item(arguments.seed * 1'000'003 + static_cast<std::uint64_t>(index), arguments.out, index);
    Json result{{"title", definition.title},
                {"points", definition.points},
                {"earned", definition.points},
                {"status", "passed"}};
    try {
        definition.run(item);
    } catch (const ItemFailed& failed) {
        result = failed_result(definition, valid_utf8(failed.text));
        for (const auto& [key, text] :
             {std::pair{"expected", &failed.expected}, {"found", &failed.found}, {"map", &failed.map}})
            if (!text->empty()) result[key] = valid_utf8(*text);
    } catch (const CallFailed& failed) {
        result = failed_result(definition, valid_utf8(failed.text + (item.about().empty() ? "" : " " + item.about())));
    }
    mark_not_attempted(result, session.not_attempted());
    if (result["status"] != "passed") result["earned"] = 0;
    if (const std::string printed = valid_utf8(session.printed()); !printed.empty()) result["printed"] = printed;
    for (const ShownImage& image : item.images())
        result["images"].push_back({{"name", valid_utf8(image.name)}, {"file", image.file}});
    return result;
}

/// Runs the item's process: writes its result to the pipe. What an answer could do to the examiner (an index that is
/// out of range, a list without end) ends this process alone.
[[noreturn]] void run_item_process(const Arguments& arguments, int index, const ItemDefinition& definition, int pipe) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    try {
        const std::string text = run_item(arguments, index, definition).dump();
        ::_exit(send(pipe, text) ? 0 : 1);
    } catch (const std::exception& error) {
        std::cerr << "judge: " << definition.title << ": " << error.what() << '\n';
        ::_exit(1);
    }
}

Json run_item_in_process(const Arguments& arguments, int index, const ItemDefinition& definition) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw duet::Error("the grader can't make a pipe", 1);
    const pid_t child = ::fork();
    if (child < 0) throw duet::Error("the grader can't start a process", 1);
    if (child == 0) run_item_process(arguments, index, definition, ends[1]);
    ::close(ends[1]);
    std::string text;
    const bool complete = receive(ends[0], text);
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (complete) return Json::parse(text);
    const std::string how = WIFSIGNALED(status) ? ::strsignal(WTERMSIG(status)) : "an error";
    return failed_result(definition, "The examiner could not judge this answer (" + how +
                                         "). Does a list or an image that you return have the wrong size?");
}

/// Whether an item fails with the text that is waited for.
bool fails_with(const Json& result, const std::string& text) {
    return !text.empty() && result["status"] != "passed" && result["points"] > 0 &&
           result["message"].get<std::string>().find(text) != std::string::npos;
}

int judge(const Arguments& arguments) {
    Json report{{"lab", lab_title().id},
                {"title", lab_title().title},
                {"seed", arguments.seed},
                {"earned", 0},
                {"points", 0},
                {"guarded", arguments.trusted || sandbox_available()},
                {"items", Json::array()}};
    int earned = 0, points = 0, index = 0;
    bool done = arguments.worker.empty();
    for (const ItemDefinition& definition : items()) {
        const bool skipped =
            done || (definition.points == 0 && !arguments.until.empty()) || (definition.points > 0 && arguments.shown);
        Json result =
            skipped ? failed_result(definition, "Not examined.") : run_item_in_process(arguments, index, definition);
        ++index;
        done = done || fails_with(result, arguments.until);
        earned += result["earned"].get<int>();
        points += definition.points;
        report["items"].push_back(std::move(result));
    }
    report["earned"] = earned;
    report["points"] = points;
    std::ofstream file(arguments.out + "/result.json");
    file << report.dump(1) << '\n';
    return file.good() ? 0 : 1;
}

} // namespace

int main(int count, char** values) {
    std::signal(SIGPIPE, SIG_IGN); // a worker that ended is found out by its silence
    try {
        return judge(read_arguments(count, values));
    } catch (const duet::Error& error) {
        std::cerr << error.what() << '\n';
        return error.exit_code();
    } catch (const std::exception& error) {
        std::cerr << "judge: " << error.what() << '\n';
        return 1;
    }
}
