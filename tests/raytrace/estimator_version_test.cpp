#include "tests/raytrace/estimates.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

TEST_SUITE("statistical") {

    // What the estimators of kEstimatorVersion 7 converge to: the mean of models/everything.json and of
    // models/spheres.json at 16 × 16 pixels, all of whose materials, lights and textures have a part in it. Where this
    // fails and the change is meant, raise kEstimatorVersion (raytrace/render.h), or compare bench would go on using
    // references of before, and put the new means here. The odds of a failure by chance are below 1 in 5,000 (see
    // deviations()).
    TEST_CASE("estimates have not changed without a new version") {
        struct Known {
            const char* scene;
            Estimate green;
        };
        static_assert(kEstimatorVersion == 7);
        for (const Known& known :
             {Known{"everything.json", {0.27027, 1.1e-4}}, Known{"spheres.json", {0.33952, 2e-5}}}) {
            const Scene scene = load_scene(std::filesystem::path(DUET_SOURCE_DIR) / "models" / known.scene);
            Settings settings;
            settings.samples_per_pixel = 256;
            const Estimate now = estimate(scene, 16, settings);
            CAPTURE(now.mean);
            CAPTURE(now.error);
            CHECK_MESSAGE(deviations(now, known.green) < 6, known.scene);
        }
    }
}
