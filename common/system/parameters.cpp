#include "common/system/parameters.h"

#include "common/system/error.h"
#include "common/system/escape.h"
#include "common/system/suggestion.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <iostream>

namespace duet {

namespace {

std::string option_of(const Parameter& parameter) {
    std::string option = "--" + parameter.name;
    std::replace(option.begin(), option.end(), ' ', '-');
    return option;
}

/// Returns the value of a parameter as text.
std::string value_of(const Parameter& parameter) {
    return std::visit([](const auto* variable) { return message(*variable); }, parameter.variable);
}

/// Returns the range of a parameter, such as "10 to 120 degrees".
std::string range_of(const Parameter& p) {
    return message(p.least, " to ", p.greatest, p.unit.empty() ? "" : " ", p.unit);
}

template <typename Number> void set(Number& variable, const Parameter& parameter, const std::string& text) {
    Number number = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    const auto value = static_cast<float>(number);
    // The comparison is false for NaN.
    if (error != std::errc() || rest != end || !(value >= parameter.least && value <= parameter.greatest)) {
        const char* const kind = std::is_same_v<Number, int> ? "a whole number" : "a number";
        throw Error(message(option_of(parameter), ": found ", quoted_text(text), "; expected ", kind, " from ",
                            range_of(parameter)));
    }
    variable = number;
}

} // namespace

void set_parameters(const std::vector<Parameter>& parameters, const std::vector<std::string>& arguments) {
    std::vector<std::string> options;
    for (const Parameter& parameter : parameters) options.push_back(option_of(parameter));
    const std::vector<std::string_view> known(options.begin(), options.end());
    for (std::size_t i = 0; i < arguments.size(); i += 2) {
        const Parameter& parameter = parameters[name_index("unknown option", arguments[i], known)];
        if (i + 1 == arguments.size())
            throw Error(message(arguments[i], ": found no value; expected a number from ", range_of(parameter)));
        std::visit([&](auto* variable) { set(*variable, parameter, arguments[i + 1]); }, parameter.variable);
    }
}

std::string parameters_help(const std::string& program, const std::vector<Parameter>& parameters) {
    std::size_t width = 0;
    for (const Parameter& parameter : parameters) width = std::max(width, option_of(parameter).size());
    std::string text = message("usage: ", program, " [--NAME VALUE]…\n",
                               "Runs the program of a lesson, which writes its images into the current folder.\n\n");
    for (const Parameter& p : parameters)
        text += message("  ", option_of(p), " VALUE", std::string(width - option_of(p).size() + 2, ' '), range_of(p),
                        " (default: ", value_of(p), ")\n");
    const std::string space(width + 1, ' ');
    return text + message("  --help ", space, "print this text\n  --parameters ", space.substr(6),
                          "print the parameters as JSON\n\ne.g.   ", program, " ", option_of(parameters.at(0)), " ",
                          parameters[0].greatest, "\n");
}

std::string parameters_json(const std::vector<Parameter>& parameters) {
    std::string text;
    for (const Parameter& p : parameters)
        text += message(text.empty() ? "[" : ", ", "{\"name\": ", quoted_text(p.name),
                        ", \"option\": ", quoted_text(option_of(p)), ", \"value\": ", value_of(p),
                        ", \"least\": ", p.least, ", \"greatest\": ", p.greatest, ", \"unit\": ", quoted_text(p.unit),
                        ", \"whole\": ", std::holds_alternative<int*>(p.variable) ? "true" : "false", "}");
    return text + "]";
}

void read_parameters(int argc, char** argv, const std::vector<Parameter>& parameters) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const std::string program = std::filesystem::path(argv[0]).filename().string();
    const auto given = [&](const char* option) {
        return std::find(arguments.begin(), arguments.end(), option) != arguments.end();
    };
    if (given("--help")) {
        std::cout << parameters_help(program, parameters);
        std::exit(0);
    }
    if (given("--parameters")) {
        std::cout << parameters_json(parameters) << "\n";
        std::exit(0);
    }
    try {
        set_parameters(parameters, arguments);
    } catch (const Error& error) {
        std::cerr << program << ": " << error.what() << "\n";
        std::exit(error.exit_code());
    }
}

} // namespace duet
