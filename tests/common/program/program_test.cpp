#include "common/program/command_line.h"
#include "common/program/program.h"
#include "common/program/render_program.h"
#include "common/program/statistics.h"
#include "common/system/error.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <iostream>
#include <sstream>

using namespace duet;

TEST_SUITE("unit") {

    TEST_CASE("image sizes are parsed whole or refused") {
        const ImageSize size = parse_image_size("640x480");
        CHECK(size.width == 640);
        CHECK(size.height == 480);
        CHECK(parse_image_size("16384x16384").height == kMaxRenderSide); // more pixels than files may have
        for (const char* bad :
             {"", "x", "640", "640x", "x480", "0x5", "5x0", "-5x5", "5x5x5", "640X480", "16385x5", "5 x5", "1e3x5"})
            CHECK_THROWS_AS(parse_image_size(bad), Error);
    }

    TEST_CASE("lists of auxiliary images") {
        const AovSet set = parse_aovs("depth,hit,samples");
        CHECK((set.depth && set.hit && set.samples));
        CHECK_FALSE((set.normal || set.albedo || set.variance));
        CHECK_FALSE(parse_aovs("").any());
        CHECK_THROWS_AS(parse_aovs("depth,,hit"), Error);
        CHECK_THROWS_AS(parse_aovs("Depth"), Error);
    }

    TEST_CASE("an unknown option or subcommand is named, with the nearest known one") {
        const auto error_of = [](std::vector<std::string> arguments) -> std::string {
            CommandLine program("test", "");
            int samples = 0;
            CommandLine& run = program.add_subcommand("run", "");
            run.add("--spp", samples, "");
            program.add_subcommand("render", "");
            std::vector<char*> argv;
            for (std::string& argument : arguments) argv.push_back(argument.data());
            try {
                program.parse(static_cast<int>(argv.size()), argv.data());
                return "accepted";
            } catch (const Error& error) {
                return error.what();
            }
        };
        CHECK(error_of({"test", "run", "--spp", "3"}) == "accepted");
        CHECK(error_of({"test", "run", "--ssp", "3"}).starts_with("unknown option \"--ssp\"; did you mean \"--spp\"?"));
        CHECK(error_of({"test", "run", "--ssp=3"}).starts_with("unknown option \"--ssp\"; did you mean"));
        CHECK(error_of({"test", "rum"}).starts_with("unknown subcommand \"rum\"; did you mean \"run\"?"));
        CHECK(error_of({"test", "scene.json"})
                  .starts_with("unknown subcommand \"scene.json\"; expected one of \"run\", \"render\""));
        CHECK(error_of({"test"}).starts_with("A subcommand is required"));
    }

    TEST_CASE("errors become exit codes") {
        CHECK(run_program("test", [] { return 7; }) == 7);
        CHECK(run_program("test", []() -> int { throw Error("expected here by a test"); }) == kExitUnusable);
        CHECK(run_program("test", []() -> int { throw Error("expected here by a test", 1); }) == kExitFailed);
    }

    TEST_CASE("an error is one line, and shows control characters instead of sending them") {
        std::ostringstream printed;
        std::streambuf* const before = std::cerr.rdbuf(printed.rdbuf());
        run_program("test", []() -> int { throw Error("a\x1b[31m\nb\x7f, ü"); });
        std::cerr.rdbuf(before);
        CHECK(printed.str() == "test: a\\x1b[31m\\x0ab\\x7f, ü\n");
    }

    TEST_CASE("an error has at most 300 characters and shows how it starts and ends") {
        std::ostringstream printed;
        std::streambuf* const before = std::cerr.rdbuf(printed.rdbuf());
        std::string path = "/";
        for (int i = 0; i < 300; ++i) path += "ü/";
        run_program("test", [&]() -> int { throw Error(path + ": found 1, expected 2"); });
        std::cerr.rdbuf(before);
        CHECK(printed.str().size() < sizeof "test: " + 2 * 300);
        CHECK(printed.str().starts_with("test: /ü/ü"));
        CHECK(printed.str().ends_with("ü/: found 1, expected 2\n"));
    }

    TEST_CASE("seconds are readable") {
        CHECK(format_duration(0.0123) == "12 ms");
        CHECK(format_duration(0.9996) == "1.0 s");
        CHECK(format_duration(59.96) == "1 min 00 s");
        CHECK(format_duration(3599.6) == "1 h 00 min");
    }

    TEST_CASE("statistics have their keys; unknown errors are null, counts are numbers") {
        RenderStatistics statistics;
        statistics.skipped = {{"textures", "no material has one", -1}, {"backfaces", "", 17}};
        const nlohmann::json json = statistics_json({"raster", "a.json", 4, 3, 2, 5, 1, 2, 3, 4}, statistics);
        CHECK(json["seconds"]["total"] == 10);
        CHECK(json["skipped"]["backfaces"] == 17);
        CHECK(json["skipped"]["textures"] == "no material has one");
        CHECK(json["estimated_relmse"].is_null());
    }

} // TEST_SUITE
