#include "common/program/command_line.h"

#include "common/image/stored_image.h"
#include "common/system/error.h"
#include "common/system/escape.h"
#include "common/system/suggestion.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <type_traits>

namespace duet {

namespace {

// Returns a check for which accepts() decides on a whole text. `name` stands in the help. CLI11's own checks do not say
// what they expect, print the largest double as a bound, and accept NaN.
template <typename Accepts>
CLI::Validator check(const std::string& name, const std::string& expected, const Accepts& accepts) {
    return {[=](std::string& text) -> std::string {
                return accepts(text) ? std::string() : message("found ", text, ", expected ", expected);
            },
            name};
}

// Returns a check that the text is a finite number for which accepts() is true.
template <typename Accepts>
CLI::Validator number_check(const std::string& name, const std::string& expected, const Accepts& accepts) {
    return check(name, expected, [=](const std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        return end != text.c_str() && *end == '\0' && std::isfinite(value) && accepts(value);
    });
}

// Returns a check for the digits of a number from low to high. A conversion alone would skip, wrap or truncate other
// text.
template <typename Integer> CLI::Validator integer_check(const std::string& name, Integer low, Integer high) {
    return check(name, message("a whole number from ", low, " to ", high), [=](const std::string& text) {
        Integer value = 0;
        const char *const begin = text.data(), *const end = begin + text.size();
        const auto [rest, error] = std::from_chars(begin, end, value);
        return error == std::errc() && rest == end && value >= low && value <= high;
    });
}

} // namespace

Option& Option::required() {
    option_->required();
    return *this;
}
Option& Option::comma_separated() {
    option_->delimiter(',');
    return *this;
}
Option& Option::repeatable() {
    option_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return *this;
}
Option& Option::needs(const std::string& other) {
    option_->needs(app_->get_option(other));
    return *this;
}
Option& Option::range(std::int64_t low, std::int64_t high) {
    option_->check(integer_check(message("in [", low, " - ", high, "]"), low, high));
    return *this;
}
Option& Option::number_range(double low, double high, const char* expected) {
    option_->check(number_check("", expected, [=](double x) { return x >= low && x <= high; }));
    return *this;
}
Option& Option::positive() {
    option_->check(number_check("POSITIVE", "a finite number above 0", [](double x) { return x > 0; }));
    return *this;
}
Option& Option::nonnegative() {
    option_->check(number_check("NONNEGATIVE", "a finite number of at least 0", [](double x) { return x >= 0; }));
    return *this;
}

CommandLine::CommandLine(const std::string& name, const std::string& description)
    : program_(std::make_unique<CLI::App>(description, name)), app_(program_.get()) {
    app_->set_version_flag("--version", std::string(DUET_VERSION));
}
CommandLine::CommandLine(CLI::App& subcommand) : app_(&subcommand) {}
CommandLine::~CommandLine() = default;

template <typename T> Option CommandLine::add(const std::string& names, T& value, const std::string& help) {
    if constexpr (std::is_same_v<T, ImageSize>) {
        const auto parse = [&value](const std::string& text) { value = parse_image_size(text); };
        return {*app_, *app_->add_option_function<std::string>(names, parse, help)};
    } else {
        CLI::Option* const option = app_->add_option(names, value, help);
        if constexpr (std::is_same_v<T, std::uint64_t>)
            option->check(integer_check<T>("", 0, std::numeric_limits<T>::max()));
        return {*app_, *option};
    }
}
template Option CommandLine::add(const std::string&, std::string&, const std::string&);
template Option CommandLine::add(const std::string&, int&, const std::string&);
template Option CommandLine::add(const std::string&, std::uint64_t&, const std::string&);
template Option CommandLine::add(const std::string&, std::int64_t&, const std::string&);
template Option CommandLine::add(const std::string&, double&, const std::string&);
template Option CommandLine::add(const std::string&, std::optional<double>&, const std::string&);
template Option CommandLine::add(const std::string&, std::filesystem::path&, const std::string&);
template Option CommandLine::add(const std::string&, ImageSize&, const std::string&);
template Option CommandLine::add(const std::string&, std::vector<std::string>&, const std::string&);
template Option CommandLine::add(const std::string&, std::vector<std::filesystem::path>&, const std::string&);
template Option CommandLine::add(const std::string&, std::vector<int>&, const std::string&);
template Option CommandLine::add(const std::string&, std::vector<double>&, const std::string&);

Option CommandLine::add_parsed(const std::string& names,
                               const std::function<void(const std::vector<std::string>&)>& parse,
                               const std::string& help) {
    return {*app_, *app_->add_option_function<std::vector<std::string>>(names, parse, help)};
}

Option CommandLine::add_flag(const std::string& names, bool& value, const std::string& help) {
    return {*app_, *app_->add_flag(names, value, help)};
}

// CLI11 would set an optional flag that is not given to false.
Option CommandLine::add_flag(const std::string& names, std::optional<bool>& value, const std::string& help) {
    return {*app_, *app_->add_flag_function(
                       names, [&value](std::int64_t times) { value = times > 0; }, help)};
}

CommandLine& CommandLine::add_subcommand(const std::string& name, const std::string& description) {
    app_->require_subcommand(1);
    CLI::App& subcommand = *app_->add_subcommand(name, description);
    return *subcommands_.emplace_back(new CommandLine(subcommand)); // make_unique cannot call a private constructor
}

void CommandLine::set_footer(const std::string& text) { app_->footer(text); }

// Returns a message on the first argument that is neither an option nor a subcommand, or an empty text. CLI11 says only
// that a subcommand is missing, or lists all arguments that are left over.
std::string CommandLine::unknown_argument(std::string_view first) const {
    const auto given = std::ranges::find_if(subcommands_, [](const auto& one) { return one->app_->parsed(); });
    if (given != subcommands_.end()) return (*given)->unknown_argument({});
    std::vector<std::string> names;
    if (!subcommands_.empty() && !first.empty() && !first.starts_with('-')) {
        for (const auto& one : subcommands_) names.push_back(one->app_->get_name());
        return "unknown subcommand " + quoted_text(first) + suggestion_or_list(first, {names.begin(), names.end()});
    }
    for (const CLI::Option* option : app_->get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& argument : app_->remaining())
        if (argument.starts_with("-")) {
            const std::string option = argument.substr(0, argument.find('='));
            return "unknown option " + quoted_text(option) + suggestion(option, {names.begin(), names.end()});
        }
    return {};
}

std::optional<int> CommandLine::parse(int argc, char** argv) {
    try {
        app_->parse(argc, argv);
        return std::nullopt;
    } catch (const CLI::Success& help) { // --help and --version throw this exception
        return app_->exit(help);
    } catch (const CLI::ParseError& error) {
        const std::string unknown = unknown_argument(argc > 1 ? argv[1] : "");
        throw Error(message(unknown.empty() ? error.what() : unknown, " (", app_->get_name(), " --help explains)"));
    }
}

int CommandLine::run_subcommand() const {
    const auto given = std::find_if(subcommands_.begin(), subcommands_.end(),
                                    [](const auto& subcommand) { return subcommand->app_->parsed(); });
    return (*given)->action_(); // parse() has refused a command line without a subcommand
}

ImageSize parse_image_size(std::string_view text) {
    ImageSize size{};
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.width);
    const auto valid = [&] {
        if (width.ec != std::errc() || width.ptr == end || *width.ptr != 'x') return false;
        const auto height = std::from_chars(width.ptr + 1, end, size.height);
        return height.ec == std::errc() && height.ptr == end && size.width >= 1 && size.width <= kMaxRenderSide &&
               size.height >= 1 && size.height <= kMaxRenderSide;
    };
    if (!valid())
        throw Error(message("--size: found ", text, ", expected WIDTHxHEIGHT such as 640x480, each from 1 to ",
                            kMaxRenderSide));
    return size;
}

} // namespace duet
