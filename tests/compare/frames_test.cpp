#include "compare/frames/frames.h"

#include "common/system/file.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace duet;
using namespace duet::compare;

namespace {

namespace fs = std::filesystem;

const fs::path kMesh = fs::path(DUET_SOURCE_DIR) / "models/meshes/pear.obj";
const fs::path kScene = fs::path(DUET_SOURCE_DIR) / "models/cornell.json";

/// Returns whether llvmpipe is available here. Otherwise there is nothing to compare with.
bool has_peer(const Scene& scene) {
    if (!LlvmpipeRenderer::built()) return false;
    try {
        const LlvmpipeRenderer peer(scene, frame_view(scene, FrameView::kWhole, {16, 16}), 1);
        return true;
    } catch (const Error&) {
        return false;
    }
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a frame's views show all of the mesh, and much more of it close up") {
        const Scene scene = frame_scene(kMesh);
        raster::RasterSettings settings;
        settings.output = raster::Output::kReversedDepth;
        const raster::RasterScene prepared = raster::prepare(scene, settings);
        Control control;
        const auto seen = [&](FrameView kind) {
            const View view = frame_view(scene, kind, {160, 90});
            const ImageFloat reversed_depth = raster::render(prepared, view, settings, control).reversed_depth;
            int inside = 0, border = 0;
            for (int y = 0; y < 90; ++y)
                for (int x = 0; x < 160; ++x)
                    (x == 0 || y == 0 || x == 159 || y == 89 ? border : inside) += reversed_depth(x, y) > 0;
            return std::pair(inside, border);
        };
        const auto [whole, touching] = seen(FrameView::kWhole);
        const auto [close, beyond] = seen(FrameView::kClose);
        CHECK(whole > 160 * 90 / 12);
        CHECK(touching == 0);
        CHECK(close > 2 * whole);
        CHECK(beyond > 0);
    }

    TEST_CASE("the peer draws the same image, and another one is told from it") {
        const Scene scene = frame_scene(kMesh);
        if (!has_peer(scene)) {
            MESSAGE("no llvmpipe here: skipped");
            return;
        }
        FrameSettings settings;
        settings.size = {320, 180};
        settings.repeats = 1;
        settings.burst_seconds = 1e-4;
        const raster::RasterScene prepared = raster::prepare(scene, {});
        for (const FrameView view : {FrameView::kWhole, FrameView::kClose})
            for (const FrameRow& row :
                 measure_frames(scene, prepared, view, 1, {FrameWork::kPhong, FrameWork::kDepth}, settings)) {
                REQUIRE(row.difference.has_value());
                CAPTURE(row.difference->coverage);
                CAPTURE(row.difference->mean);
                CAPTURE(row.difference->flip);
                CHECK(row.difference->same());
                CHECK(row.ours > 0);
                CHECK(row.peer > 0);
                CHECK(row.ratio.min <= row.ratio.median);
                CHECK(row.ratio.median <= row.ratio.max);
                CHECK(row.peer_name.find("llvmpipe") != std::string::npos);
            }
        // The rasterizer renders a weaker sun, so its image must fail the comparison with the peer.
        Scene darker = frame_scene(kMesh);
        std::get<SunLight>(darker.lights[0]).irradiance = Rgb(2.0f);
        const raster::RasterScene other = raster::prepare(darker, {});
        const std::vector<FrameRow> rows =
            measure_frames(scene, other, FrameView::kWhole, 1, {FrameWork::kPhong}, settings);
        CHECK_FALSE(rows.at(0).difference->same());
    }

    TEST_CASE("rows are written as JSON") {
        const test::ScratchFolder folder;
        FramesOptions options;
        options.files = {kMesh, kScene};
        options.views = {FrameView::kWhole};
        options.threads = {1};
        options.settings.size = {64, 48};
        options.settings.repeats = 2;
        options.settings.burst_seconds = 1e-4;
        options.settings.no_peer = true;
        options.folder = folder.path();
        options.stats = (folder / "rows.json").string();
        options.quiet = true;
        CHECK(frames(options) == 0);
        const nlohmann::json all = nlohmann::json::parse(read_file(folder / "rows.json")), &rows = all.at("rows");
        REQUIRE(rows.size() == 2);
        CHECK(rows[0].at("work") == "phong");
        CHECK(rows[1].at("work") == "depth");
        for (const nlohmann::json& row : rows) {
            CHECK(row.at("mesh") == "pear");
            CHECK(row.at("threads") == 1);
            CHECK(row.at("ours").get<double>() > 0);
            CHECK(row.at("covered").get<double>() > 0.05);
            CHECK(row.at("ratio").is_null());
            CHECK(row.at("peer").is_null());
        }
        CHECK(fs::exists(folder / "pear-whole-ours.png"));
        const nlohmann::json lit = all.at("lit").at(0), row = lit.at("rows").at(0);
        CHECK(lit.at("scene") == "cornell");
        CHECK(lit.at("prepare_seconds").get<double>() > 0);
        CHECK(row.at("threads") == 1);
        CHECK(row.at("frame_seconds").get<double>() > 0);
        CHECK(row.at("stages").at("direct light and shadows").get<double>() > 0);
        CHECK(row.at("stages").at("other").get<double>() > 0); // no stage counts twice
        CHECK(fs::exists(folder / "cornell-lit.png"));
    }
}
