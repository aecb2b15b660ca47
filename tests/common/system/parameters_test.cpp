#include "common/system/error.h"
#include "common/system/parameters.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace duet;

TEST_SUITE("unit") {

    TEST_CASE("parameters are set by their options, and keep their defaults otherwise") {
        float view = 26, bias = 0.005f;
        int samples = 64;
        const std::vector<Parameter> parameters{
            {"field of view", view, 5, 120, "degrees"}, {"bias", bias, 0, 1}, {"samples", samples, 1, 256}};
        set_parameters(parameters, {});
        CHECK(view == 26);
        set_parameters(parameters, {"--field-of-view", "120", "--samples", "1"});
        CHECK(view == 120);
        CHECK(bias == 0.005f);
        CHECK(samples == 1);
    }

    TEST_CASE("what is no value of a parameter is refused on one line that says what was expected") {
        float view = 26, x = 0;
        int samples = 64;
        const std::vector<Parameter> parameters{
            {"field of view", view, 5, 120, "degrees"}, {"x", x, -1, 1}, {"samples", samples, 1, 256}};
        const auto refused = [&](const std::vector<std::string>& arguments) {
            try {
                set_parameters(parameters, arguments);
            } catch (const Error& error) {
                CHECK(error.exit_code() == 2);
                return std::string(error.what());
            }
            return std::string("accepted");
        };
        CHECK(refused({"--field-of-view", "121"}) ==
              "--field-of-view: found \"121\"; expected a number from 5 to 120 degrees");
        CHECK(refused({"--samples", "1.5"}) == "--samples: found \"1.5\"; expected a whole number from 1 to 256");
        CHECK(refused({"--samples", "0"}) == "--samples: found \"0\"; expected a whole number from 1 to 256");
        for (const char* text : {"nan", "inf", "", "1x", "-1.01"})
            CHECK(refused({"--x", text}).find("expected a number from -1 to 1") != std::string::npos);
        CHECK(refused({"--samples"}) == "--samples: found no value; expected a number from 1 to 256");
        CHECK(refused({"--sample", "3"}) == "unknown option: found \"--sample\"; did you mean \"--samples\"?");
        CHECK(refused({"--x", "-1"}) == "accepted");
        CHECK(x == -1);
    }

    TEST_CASE("the help text and the JSON have the ranges and the defaults") {
        float view = 26;
        int samples = 64;
        const std::vector<Parameter> parameters{{"field of view", view, 5, 120, "degrees"},
                                                {"samples", samples, 1, 256}};
        const std::string help = parameters_help("lesson", parameters);
        CHECK(help.find("  --field-of-view VALUE  5 to 120 degrees (default: 26)\n") != std::string::npos);
        CHECK(help.find("  --samples VALUE        1 to 256 (default: 64)\n") != std::string::npos);
        const auto json = nlohmann::json::parse(parameters_json(parameters));
        CHECK(json.size() == 2);
        CHECK(json[0] == nlohmann::json{{"name", "field of view"},
                                        {"option", "--field-of-view"},
                                        {"value", 26},
                                        {"least", 5},
                                        {"greatest", 120},
                                        {"unit", "degrees"},
                                        {"whole", false}});
        CHECK(json[1]["whole"] == true);
    }
}
