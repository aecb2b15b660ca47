// This file declares the command line of a program: its options, their help and their checks. CLI11 parses it, but only
// command_line.cpp includes CLI11, because its header takes four seconds of every file that includes it.
#pragma once

#include "common/image/stored_image.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace duet {

/// Parses an image size such as "640x480". Throws Error unless each side is in [1, kMaxRenderSide].
ImageSize parse_image_size(std::string_view text);

/// An Option is a handle to an option of a CommandLine. Its functions say which values the option accepts.
class Option {
public:
    Option(CLI::App& app, CLI::Option& option) : app_(&app), option_(&option) {}

    /// The command line is refused without this option.
    Option& required();
    /// The values may be separated by commas: "1,4,16".
    Option& comma_separated();
    /// Each use of the option takes one value, and the option may be used several times.
    Option& repeatable();
    /// The command line is refused if this option is used without the one named `other`, which must exist already.
    Option& needs(const std::string& other);
    /// Accepts integers from `low` to `high`.
    Option& range(std::int64_t low, std::int64_t high);
    /// Accepts finite numbers from `low` to `high`; `expected` describes them in the error message.
    Option& number_range(double low, double high, const char* expected);
    /// Accepts finite numbers above 0.
    Option& positive();
    /// Accepts finite numbers of at least 0.
    Option& nonnegative();

private:
    CLI::App* app_;
    CLI::Option* option_;
};

/// A CommandLine holds the options of a program or of one of its subcommands, and writes their values into variables.
/// The variables keep their initial values where an option is not given, and must outlive the parsing.
class CommandLine {
public:
    /// The name and description are printed by --help.
    CommandLine(const std::string& name, const std::string& description);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// Adds an option; `names` is "-o,--output", or "SCENE" for a positional argument. T is std::string, int,
    /// std::uint64_t (decimal digits only), std::int64_t, double, std::optional<double>, std::filesystem::path,
    /// ImageSize, or a std::vector of strings, paths, ints or doubles.
    template <typename T> Option add(const std::string& names, T& value, const std::string& help);
    /// Adds an option whose values are passed to `parse`, all at once. `parse` throws Error for values that it refuses.
    Option add_parsed(const std::string& names, const std::function<void(const std::vector<std::string>&)>& parse,
                      const std::string& help);
    /// Adds an option without a value, which sets `value` to true. "--shadows,!--no-shadows" has a negation, which sets
    /// it to false.
    Option add_flag(const std::string& names, bool& value, const std::string& help);
    /// Adds a flag for a program that must distinguish whether it was given; if not, `value` stays empty.
    Option add_flag(const std::string& names, std::optional<bool>& value, const std::string& help);
    /// Adds a subcommand, one of which is then required. This command line owns it.
    CommandLine& add_subcommand(const std::string& name, const std::string& description);
    /// Sets the function that run_subcommand() calls if this subcommand was given. The function returns the exit code.
    void set_action(const std::function<int()>& action) { action_ = action; }
    /// Sets the text below the options in --help.
    void set_footer(const std::string& text);

    /// Parses a command line. Returns nothing if the program shall proceed, and after --help or --version the exit
    /// code. Throws Error for unusable arguments, which ends the program with exit code 2.
    std::optional<int> parse(int argc, char** argv);
    /// Runs the action of the subcommand that was given, after parse(). Returns its exit code.
    int run_subcommand() const;

private:
    explicit CommandLine(CLI::App& subcommand);
    std::string unknown_argument(std::string_view first) const;

    std::unique_ptr<CLI::App> program_; ///< empty for a subcommand, which belongs to its program
    CLI::App* app_;
    std::vector<std::unique_ptr<CommandLine>> subcommands_;
    std::function<int()> action_;
};

} // namespace duet
