// This program generates the procedural models.
#include "common/system/error.h"
#include "models/generate.h"

#include <algorithm>
#include <iostream>

namespace {

using duet::models::all_models;
using duet::models::Model;

constexpr const char* kUsage = R"(usage: generate OUTPUT_DIR [NAME...]
Makes models by code: those named, or all but the ones marked "on request".

example: generate models amphora
names:
)";

void print_usage(std::ostream& out) {
    out << kUsage;
    for (const Model& model : all_models()) {
        out << "  " << model.name << ":";
        for (const std::string& file : model.files) out << " " << file;
        out << (model.kind == Model::Kind::kOnRequest ? " (on request)\n" : "\n");
    }
}

const Model& model_named(const std::string& name) {
    const auto models = all_models();
    const auto found = std::ranges::find(models, name, &Model::name);
    if (found == models.end()) throw duet::Error("\"" + name + "\" is no model; generate --help lists them");
    return *found;
}

int run(const std::vector<std::string>& arguments) {
    if (arguments.empty() || arguments.front() == "--help" || arguments.front() == "-h") {
        print_usage(arguments.empty() ? std::cerr : std::cout);
        return arguments.empty() ? 2 : 0;
    }
    for (const std::string& argument : arguments)
        if (argument.starts_with("-")) throw duet::Error(argument + ": generate has no such option, only --help");
    const std::filesystem::path folder = arguments.front();
    std::vector<const Model*> chosen;
    for (std::size_t i = 1; i < arguments.size(); ++i) chosen.push_back(&model_named(arguments[i]));
    if (chosen.empty())
        for (const Model& model : all_models())
            if (model.kind != Model::Kind::kOnRequest) chosen.push_back(&model);
    for (const Model* model : chosen) generate_model(*model, folder);
    return 0;
}

} // namespace

int main(int count, char** values) {
    try {
        return run(std::vector<std::string>(values + 1, values + count));
    } catch (const duet::Error& error) {
        std::cerr << "generate: " << error.what() << "\n";
        return error.exit_code();
    } catch (const std::exception& error) {
        std::cerr << "generate: " << error.what() << "\n";
        return 1;
    }
}
