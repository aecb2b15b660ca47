#include "compare/run.h"

#include "common/image/image_file.h"
#include "common/system/file.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace duet;
using namespace duet::compare;
using duet::test::ScratchFolder;
using nlohmann::json;

namespace {

namespace fs = std::filesystem;

RunOptions small_run(const fs::path& folder) {
    RunOptions options;
    options.scene = fs::path(DUET_SOURCE_DIR) / "models" / "cornell.json";
    options.folder = folder;
    options.scene_options.size = {24, 20};
    options.settings.raster_spp = 1;
    options.settings.raytrace_spp = 2;
    options.quiet = true;
    return options;
}

json without_times(json report) {
    for (const char* const side : {"raster", "raytrace"}) {
        report[side].erase("seconds");
        report[side].erase("stages");
        report[side].erase("threads");
        report[side].erase("memory_bytes"); // each thread has its own working memory
        report[side].erase("peak_memory_bytes");
    }
    return report;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a run writes its five files, report.json has the promised keys, --stats the same figures") {
        const ScratchFolder scratch;
        RunOptions options = small_run(scratch / "deep" / "report");
        options.stats = (scratch / "stats.json").string();
        REQUIRE(run(options) == 0);
        std::size_t files = 0;
        for (const fs::directory_entry& entry : fs::directory_iterator(options.folder))
            files += entry.is_regular_file() ? 1 : 0;
        CHECK(files == 5);
        for (const char* const name : {"raster.png", "raytrace.png", "difference.png"}) {
            const ImageRgb shown_image = read_image(options.folder / name);
            CHECK(shown_image.width() == 24);
            CHECK(shown_image.height() == 20);
        }
        CHECK(read_file(options.folder / "index.html").find("cornell.json") != std::string::npos);
        const json report = json::parse(read_file(options.folder / "report.json"));
        CHECK(report == json::parse(read_file(options.stats)));
        for (const char* const side : {"raster", "raytrace"})
            for (const char* const key :
                 {"program", "version", "scene", "width", "height", "threads", "samples_per_pixel", "seed", "seconds",
                  "rays", "triangles", "approximations", "skipped"})
                CHECK_MESSAGE(report[side].contains(key), side, " lacks ", key);
        CHECK(report["raster"]["program"] == "raster");
        CHECK(report["raytrace"]["samples_per_pixel"] == 2);
        for (const char* const key :
             {"mse", "rmse", "mae", "psnr", "relmse", "mean_signed_error", "smape", "ssim", "flip"})
            CHECK(report["metrics"].contains(key));
        const json& hits = report["hits"];
        CHECK(hits["pixels"] == 24 * 20);
        CHECK(hits["unexplained"] == 0);
        CHECK(hits["same"].get<int>() + hits["edge"].get<int>() + hits["depth_tie"].get<int>() == 24 * 20);
    }

    TEST_CASE("the same figures for any number of threads") {
        const ScratchFolder scratch;
        std::vector<json> reports;
        for (const int threads : {1, 2, 7}) {
            RunOptions options = small_run(scratch.path());
            options.settings.threads = threads;
            REQUIRE(run(options) == 0);
            reports.push_back(without_times(json::parse(read_file(scratch / "report.json"))));
        }
        CHECK(reports[0] == reports[1]);
        CHECK(reports[0] == reports[2]);
    }

    TEST_CASE("a folder that cannot be made is refused before anything is rendered") {
        const ScratchFolder scratch;
        write_file(scratch / "file", "x");
        CHECK_THROWS_AS(run(small_run(scratch / "file")), Error);
        CHECK_THROWS_AS(run(small_run(scratch / "file" / "below")), Error);
    }
}
