#include "tests/raytrace/estimates.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

TEST_SUITE("statistical") {

    // These are the values to which the estimators of kEstimatorVersion 7 converge: the means of
    // models/everything.json and models/spheres.json at 16 × 16 pixels. All materials, lights and textures of these
    // scenes contribute. If this test fails after an intended change, raise kEstimatorVersion (raytrace/render.h) and
    // put the new means here. Otherwise compare bench would continue to use outdated references. A failure by chance
    // has odds below 1 in 5,000 (see check_equal_means()).
    TEST_CASE("estimates have not changed without a new version") {
        struct Known {
            const char* scene;
            Estimate green;
        };
        static_assert(kEstimatorVersion == 7);
        for (const Known& known :
             {Known{"everything.json", {0.27027, 1.1e-4}}, Known{"spheres.json", {0.33952, 2e-5}}}) {
            const Scene scene = load_scene(std::filesystem::path(DUET_SOURCE_DIR) / "models" / known.scene);
            PathTracerSettings settings;
            settings.samples_per_pixel = 256;
            CAPTURE(known.scene);
            check_equal_means(estimate(scene, 16, settings), known.green);
        }
    }
}
