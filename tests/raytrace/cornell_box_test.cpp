// These tests compare the Cornell box with mean radiances on which two independent renderers agree
// (tests/golden/README.md).
#include "common/scene/scene.h"
#include "raytrace/render.h"
#include "tests/support/cornell_means.h"

#include <cmath>

using namespace duet;

namespace {

Rgbd block_mean(const ImageRgb& image, int row, int column) {
    Rgbd sum;
    for (int y = row * 32; y < row * 32 + 32; ++y)
        for (int x = column * 32; x < column * 32 + 32; ++x) sum += Rgbd(image(x, y));
    return sum / 1024.0;
}

} // namespace

TEST_SUITE("statistical") {

    // Each block's mean is over a million paths. Its standard error, measured between seeds, is below 0.1 % for every
    // block above 0.005, so a false alarm at 1 % would be ten standard errors. The published means agree with each
    // other to 0.5 % per block.
    TEST_CASE("Cornell box, 512 x 512 at 35 degrees, 1024 samples: the published means") {
        Scene scene = load_scene(DUET_SOURCE_DIR "/models/cornell.json");
        scene.camera.fov_degrees = 35;
        raytrace::PathTracerSettings settings;
        settings.samples_per_pixel = 1024;
        settings.max_depth = 64;
        Control control;
        const Rendering rendering =
            raytrace::render(raytrace::prepare(scene, settings), {scene.camera, 512, 512}, settings, control);
        CHECK(rendering.statistics.invalid_samples == 0);

        const std::vector<CornellBlock> blocks = published_means();
        REQUIRE(blocks.size() > 50);
        Rgbd ours, theirs, ours_without_area_light, theirs_without_area_light;
        for (const CornellBlock& block : blocks) {
            const Rgbd mean = block_mean(rendering.radiance, block.row, block.column);
            ours += mean;
            theirs += block.mean;
            if (!block.holds_light()) {
                ours_without_area_light += mean;
                theirs_without_area_light += block.mean;
            }
            for (std::size_t channel = 0; channel < 3; ++channel) {
                if (block.mean[channel] <= 0.005) continue;
                INFO("block row ", block.row, " column ", block.column, " channel ", channel);
                CHECK(mean[channel] == doctest::Approx(block.mean[channel]).epsilon(0.01));
            }
        }
        // The image is black outside the listed blocks, so sums over the blocks compare whole images.
        const Rgbd published(0.058420, 0.037953, 0.010739);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            INFO("channel ", channel);
            MESSAGE("channel ", channel, ": whole ", ours[channel] / 256, " of ", published[channel],
                    ", without light ratio ", ours_without_area_light[channel] / theirs_without_area_light[channel]);
            CHECK(std::abs(ours[channel] / 256 / published[channel] - 1) <= 0.001);
            CHECK(std::abs(ours[channel] / theirs[channel] - 1) <= 0.001);
            CHECK(std::abs(ours_without_area_light[channel] / theirs_without_area_light[channel] - 1) <= 0.001);
        }
        Rgbd outside;
        for (const Rgb& pixel : rendering.radiance) outside += Rgbd(pixel);
        CHECK(outside.r / (512.0 * 512.0) == doctest::Approx(ours.r / 256).epsilon(1e-6));
    }

} // TEST_SUITE
