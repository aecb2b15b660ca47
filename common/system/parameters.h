// This file reads the numbers that a reader of a lesson may change from the command line of the lesson's program.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace duet {

/// A parameter is a number of a program, with its range. Before it is read, its variable holds the default value. It is
/// a whole number if its variable is an int. The name may have spaces; the option has hyphens instead: "field of view"
/// is set by `--field-of-view 50`. Least, greatest and default are given with at most 6 digits. The unit may be empty.
struct Parameter {
    Parameter(std::string name_, float& variable_, float least_, float greatest_, std::string unit_ = "")
        : name(std::move(name_)), variable(&variable_), least(least_), greatest(greatest_), unit(std::move(unit_)) {}
    Parameter(std::string name_, int& variable_, int least_, int greatest_, std::string unit_ = "")
        : name(std::move(name_)), variable(&variable_), least(static_cast<float>(least_)),
          greatest(static_cast<float>(greatest_)), unit(std::move(unit_)) {}

    std::string name;
    std::variant<float*, int*> variable;
    float least = 0, greatest = 0; ///< both ends belong to the range
    std::string unit;              ///< in the plural, such as "degrees"
};

/// Sets the variables that the arguments name: `--NAME VALUE` each. Throws an Error of one line for an unknown name, a
/// missing value, a value that is no number, and a value out of range; variables of earlier arguments are set then.
void set_parameters(const std::vector<Parameter>& parameters, const std::vector<std::string>& arguments);

/// Returns the help text of a program with these parameters, which names their ranges and their present values.
std::string parameters_help(const std::string& program, const std::vector<Parameter>& parameters);

/// Returns the parameters as a JSON array on one line. Each element has "name", "option", "value" (the present one),
/// "least", "greatest", "unit" and "whole", which is true for whole numbers.
std::string parameters_json(const std::vector<Parameter>& parameters);

/// Sets parameters from the command line of main(). Given `--help` it prints parameters_help(), and given
/// `--parameters` parameters_json(), and ends the program with exit code 0. An Error is printed as one line after the
/// program's name, and ends the program with exit code 2. For example:
///
///     int main(int argc, char** argv) {
///         int samples = 64;
///         float fuzz = 0.1f;
///         read_parameters(argc, argv, {{"samples", samples, 1, 256}, {"fuzz", fuzz, 0, 1}});
void read_parameters(int argc, char** argv, const std::vector<Parameter>& parameters);

} // namespace duet
