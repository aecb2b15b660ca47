#include "compare/images.h"

#include "common/image/image_file.h"
#include "common/system/file.h"
#include "compare/metrics/limits.h"
#include "tests/compare/test_images.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <limits>

using namespace duet;
using namespace duet::compare;
using duet::test::ScratchFolder;
using nlohmann::json;

namespace {

namespace fs = std::filesystem;

/// Returns options that compare two files of the folder without a table and write the metrics to m.json.
ImagesOptions comparison(const ScratchFolder& scratch, const char* a, const char* b) {
    ImagesOptions options;
    options.a = scratch / a;
    options.reference = scratch / b;
    options.stats = (scratch / "m.json").string();
    options.quiet = true;
    return options;
}

json figures_of(const ImagesOptions& options) {
    REQUIRE(compare_images(options) == 0);
    return json::parse(read_file(options.stats));
}

/// Returns the error message of the comparison, which must have the exit code.
std::string refusal(const ImagesOptions& options, int exit_code = 2) {
    try {
        compare_images(options);
    } catch (const Error& error) {
        CHECK(error.exit_code() == exit_code);
        return error.what();
    }
    return "";
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("compare images: limits decide the exit code") {
        const ScratchFolder scratch;
        write_image(scratch / "a.pfm", ImageRgb(4, 4, Rgb(0.5f)));
        write_image(scratch / "b.pfm", ImageRgb(4, 4, Rgb(0.25f)));
        ImagesOptions options = comparison(scratch, "a.pfm", "b.pfm");
        CHECK(figures_of(options)["mse"].get<double>() == doctest::Approx(0.0625));
        options.limits = {"rmse=0.26", "mae=0.25", "psnr=12", "mean_signed_error=0.25", "nan=0", "flip=1"};
        CHECK(compare_images(options) == 0);
        for (const char* const over : {"rmse=0.24", "psnr=13", "mean_signed_error=0.2", "flip=0", "smape=0.3",
                                       // An image of 4 × 4 pixels has no SSIM, which exceeds any limit.
                                       "ssim=0.5"}) {
            options.limits = {"mae=0.25", over};
            CAPTURE(over);
            CHECK(compare_images(options) == 1);
        }
    }

    TEST_CASE("compare images: limits that cannot be used are refused before a file is read, with the list") {
        const ScratchFolder scratch;
        ImagesOptions options = comparison(scratch, "none.pfm", "none.pfm");
        for (const char* const bad : {"rmse", "rmse=", "rmse=x", "rmse=1x", "=1", "other=1", "rmse=nan"}) {
            options.limits = {bad};
            CAPTURE(bad);
            CHECK(refusal(options).find("mse, rmse, mae, psnr") != std::string::npos);
        }
    }

    TEST_CASE("an exceeded limit says by how much, and less is worse of psnr, ssim and z_p") {
        ImageMetrics metrics;
        metrics.errors.mse = 0.25;
        metrics.errors.psnr = 20;
        metrics.ssim = 0.75;
        const std::vector<MetricValue> found = metric_values(metrics);
        const auto said = [&](const char* limit) { return exceeded({parse_limit(limit)}, found); };
        CHECK(said("mse=0.25").empty());
        CHECK(said("psnr=20").empty());
        CHECK(said("psnr=19").empty());
        CHECK(said("ssim=0.5").empty());
        REQUIRE(said("mse=0.125").size() == 1);
        CHECK(said("mse=0.125")[0] == "mse is 0.25, the limit 0.125: above it by 0.125");
        CHECK(said("psnr=25").at(0) == "psnr is 20, the limit 25: below it by 5");
        CHECK(said("ssim=1").size() == 1);
        CHECK(said("z_p=0").size() == 1); // no z-test, so no value
        metrics.errors.psnr = std::numeric_limits<double>::infinity();
        CHECK(exceeded({parse_limit("psnr=1000")}, metric_values(metrics)).empty());
    }

    TEST_CASE("compare images: sizes that differ are refused with both") {
        const ScratchFolder scratch;
        write_image(scratch / "a.pfm", ImageRgb(4, 4));
        write_image(scratch / "b.pfm", ImageRgb(4, 3));
        const std::string text = refusal(comparison(scratch, "a.pfm", "b.pfm"));
        CHECK(text.find("4x4") != std::string::npos);
        CHECK(text.find("4x3") != std::string::npos);
    }

    TEST_CASE("compare images: an 8-bit file against a float one needs --decode, which makes all linear") {
        const ScratchFolder scratch;
        const ImageRgb a = linear_pair(24, 20).test;
        write_image(scratch / "a.png", a);
        write_image(scratch / "a.exr", a);
        ImagesOptions options = comparison(scratch, "a.png", "a.exr");
        CHECK(refusal(options).find("--decode") != std::string::npos);
        std::swap(options.a, options.reference);
        CHECK(refusal(options).find("--decode") != std::string::npos);
        options = comparison(scratch, "a.png", "a.png");
        CHECK(figures_of(options).contains("flip_exposures") == false);
        options.decode = true;
        CHECK(figures_of(options).contains("flip_exposures") == true);
        options = comparison(scratch, "a.png", "a.exr");
        options.decode = true;
        const json found = figures_of(options);
        const json expected = [&] {
            write_image(scratch / "decoded.pfm", read_image(scratch / "a.png"));
            return figures_of(comparison(scratch, "decoded.pfm", "a.exr"));
        }();
        CHECK(found == expected);
    }

    TEST_CASE("compare images: NaN and infinity are counted apart") {
        const ScratchFolder scratch;
        ImageRgb a(12, 12, Rgb(0.5f)), b = a;
        a(1, 1).r = std::numeric_limits<float>::quiet_NaN();
        a(2, 1).r = std::numeric_limits<float>::infinity();
        b(2, 1) = {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity(), 0};
        write_image(scratch / "a.pfm", a);
        write_image(scratch / "b.pfm", b);
        const json found = figures_of(comparison(scratch, "a.pfm", "b.pfm"));
        CHECK(found["nan"] == json{{"a", 1}, {"b", 1}});
        CHECK(found["infinite"] == json{{"a", 1}, {"b", 1}});
        CHECK(found["pixels"] == 142);
        CHECK(found["mse"] == 0);
    }

    TEST_CASE("compare images: alpha is not compared, and where there is one other than 1 the figures say so") {
        const ScratchFolder scratch;
        const std::vector<float> value{0.5f, 0.25f, 1.0f};
        const auto write = [&](const char* name, const std::vector<float>& alpha) {
            write_exr(scratch / name, 3, 1, {{"A", alpha, {}}, {"B", value, {}}, {"G", value, {}}, {"R", value, {}}});
        };
        write("a.exr", {1, 0.5f, 0});
        write("b.exr", {1, 1, 1});
        const json figures = figures_of(comparison(scratch, "a.exr", "b.exr"));
        CHECK(figures["mse"] == 0);
        CHECK(figures["transparent"]["a"] == 2);
        CHECK(figures["transparent"]["b"] == 0);
    }

    TEST_CASE("compare images: variances of an EXR file lead to a z-test") {
        const ScratchFolder scratch;
        const TestPair pair = linear_pair(24, 20);
        std::vector<ExrChannel> channels = rgb_channels("", pair.test);
        for (ExrChannel& channel : rgb_channels("variance.", ImageRgb(24, 20, Rgb(1e-4f))))
            channels.push_back(std::move(channel));
        write_exr(scratch / "a.exr", 24, 20, channels);
        write_image(scratch / "b.exr", pair.reference);
        ImagesOptions options = comparison(scratch, "a.exr", "b.exr");
        const json found = figures_of(options);
        CHECK(found["z_test"]["pixels"] == 24 * 20);
        CHECK(found["z_test"]["tests"] == 6);
        options.limits = {"z_over_3=0"};
        CHECK(compare_images(options) == 1);
        options = comparison(scratch, "b.exr", "b.exr");
        CHECK_FALSE(figures_of(options).contains("z_test"));
        options.limits = {"z_p=0.01"};
        CHECK(refusal(options).find("variance.R") != std::string::npos);
    }

    TEST_CASE("compare images -o: the page, its figures and the difference; equal names are told apart by their "
              "paths") {
        const ScratchFolder scratch;
        for (const char* const side : {"old", "new"}) {
            fs::create_directories(scratch / side);
            write_image(scratch / side / "x.png", ImageRgb(6, 4, Rgb(side[0] == 'o' ? 0.5f : 0.25f)));
        }
        ImagesOptions options = comparison(scratch, "old/x.png", "new/x.png");
        options.folder = scratch / "deep" / "out";
        const json figures = figures_of(options);
        CHECK(json::parse(read_file(options.folder / "report.json"))["metrics"] == figures);
        CHECK(read_image(options.folder / "difference.png").width() == 6);
        const std::string page = read_file(options.folder / "index.html");
        CHECK(page.find("old/x.png against ") != std::string::npos);
        CHECK(page.find("\"eight_bit\":true") != std::string::npos);
        write_file(scratch / "file", "x");
        options.folder = scratch / "file";
        CHECK_FALSE(refusal(options, 1).empty());
        options.folder.clear();
        options.stats = (scratch / "none" / "m.json").string();
        CHECK_FALSE(refusal(options).empty());
    }
}
