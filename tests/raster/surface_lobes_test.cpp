// These tests check that the lobes of a material whose color is an image are computed without the image, and agree with
// those of its BSDF.
#include "raster/gbuffer/surface_lobes.h"

#include "common/material/metal.h"

#include <doctest/doctest.h>

using namespace duet;

namespace {

/// Returns a slot with the first texture of a scene.
RgbSlot textured() {
    RgbSlot slot;
    slot.texture = 0;
    return slot;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a color from an image is not looked up: the table holds for all colors") {
        Metal metal{textured(), {0.5f}};
        Dielectric glass;
        glass.tint = textured();
        Principled principled;
        principled.base_color = textured();
        Coated coated;
        coated.albedo = textured();
        for (const Material& material : {Material(metal), Material(glass), Material(principled), Material(coated)}) {
            CAPTURE(material.index());
            CHECK(raster::LobesOfColor::of(material).has_value());
        }
    }

    TEST_CASE("an image as metal's reflectance leaves its lobe as wide as its roughness says") {
        const Rgb color(0.9f, 0.5f, 0.2f);
        const auto lobes = raster::LobesOfColor::of(Metal{textured(), {0.5f}});
        REQUIRE(lobes);
        const raster::SurfaceLobes exact = raster::surface_lobes(MetalBsdf(color, 0.25f), 0.7f);
        CHECK(lobes->alpha == exact.alpha);
        CHECK(lobes->specular(color).g == doctest::Approx(exact.specular.g));
        CHECK(lobes->diffuse(color, 0.7f).g == doctest::Approx(exact.diffuse.g));
    }
}
