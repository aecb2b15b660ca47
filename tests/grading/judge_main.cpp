// The program that examines one lab: runs its items and writes what came of them as JSON.
#include "tests/grading/judge.h"

#include <nlohmann/json.hpp>

#include <csignal>
#include <fstream>
#include <iostream>

namespace {

using namespace duet::grading;
using Json = nlohmann::ordered_json;

struct Arguments {
    std::string worker, out;
    std::uint64_t seed = 1;
    bool trusted = false;
};

Arguments read_arguments(int count, char** values) {
    Arguments arguments;
    for (int i = 1; i < count; ++i) {
        const std::string option = values[i];
        if (option == "--trusted")
            arguments.trusted = true;
        else if (i + 1 == count)
            throw duet::Error("judge: " + option + " needs a value");
        else if (option == "--worker")
            arguments.worker = values[++i];
        else if (option == "--out")
            arguments.out = values[++i];
        else if (option == "--seed")
            arguments.seed = std::stoull(values[++i]);
        else
            throw duet::Error("judge: unknown option " + option + "; expected --worker, --out, --seed or --trusted");
    }
    if (arguments.worker.empty() || arguments.out.empty())
        throw duet::Error("usage: judge --worker PROGRAM --out FOLDER [--seed N] [--trusted]");
    return arguments;
}

/// Text of unknown origin as valid UTF-8: JSON refuses other bytes, and terminals obey control characters.
std::string clean(const std::string& text) {
    const Json repaired = Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace));
    std::string result;
    for (const char c : repaired.get<std::string>())
        if (c == '\n' || c == '\t' || !(static_cast<unsigned char>(c) < 0x20 || c == 0x7f)) result += c;
    return result;
}

/// Runs one item in a worker of its own.
Json run_item(const Arguments& arguments, int index, const ItemDefinition& definition) {
    Limits limits;
    limits.sandbox = !arguments.trusted;
    Session session(arguments.worker, limits);
    set_session(&session);
    Item item(arguments.seed * 1'000'003 + static_cast<std::uint64_t>(index), arguments.out, index);
    Json result{{"title", definition.title}, {"points", definition.points}, {"status", "passed"}};
    try {
        definition.run(item);
    } catch (const ItemFailed& failed) {
        result["status"] = "failed";
        result["message"] = clean(failed.text);
        for (const auto& [key, text] :
             {std::pair{"expected", &failed.expected}, {"found", &failed.found}, {"map", &failed.map}})
            if (!text->empty()) result[key] = clean(*text);
    } catch (const CallFailed& failed) {
        result["status"] = "failed";
        result["message"] = clean(failed.text);
    }
    if (result["status"] == "failed" && session.not_attempted()) result["status"] = "not_attempted";
    if (session.not_attempted() && result["status"] == "passed" && definition.points > 0) {
        result["status"] = "not_attempted"; // a starter that happens to be right isn't an answer
        result["message"] =
            "What the starter returns happens to be right here; remove not_attempted() where you have begun.";
    }
    result["earned"] = result["status"] == "passed" ? definition.points : 0;
    if (const std::string printed = clean(session.printed()); !printed.empty()) result["printed"] = printed;
    for (const ShownImage& image : item.images())
        result["images"].push_back({{"name", image.name}, {"file", image.file}});
    result["guarded"] = session.guarded();
    return result;
}

int judge(const Arguments& arguments) {
    Json report{
        {"lab", lab_title().id}, {"title", lab_title().title}, {"seed", arguments.seed}, {"items", Json::array()}};
    int earned = 0, points = 0;
    for (const ItemDefinition& definition : items()) {
        report["items"].push_back(run_item(arguments, static_cast<int>(report["items"].size()), definition));
        earned += report["items"].back()["earned"].get<int>();
        points += definition.points;
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
