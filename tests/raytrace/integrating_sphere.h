// The integrating sphere is the inside of a sphere with a point light in its center. Each point receives the same
// light from all others, whatever the path, so the radiance is ρ E / (π (1 − ρ)) everywhere, with E = I/r². Roulette
// is the only source of noise.
#pragma once

#include "tests/raytrace/scene_builder.h"

namespace duet::raytrace {

inline Scene integrating_sphere() {
    constexpr float kIntensity = 3, kRadius = 1.5f, kWhite = 0.75f;
    SceneBuilder builder;
    builder.add(Sphere{{0, 0, 0}, kRadius}, builder.material(Diffuse{{Rgb(kWhite)}}));
    builder.scene.lights.push_back(PointLight{{0, 0, 0}, Rgb(kIntensity)});
    builder.scene.camera.eye = {0.3, 0.2, 0.5};
    builder.scene.camera.look_at = {0, 0, -1};
    return builder.finish();
}
inline constexpr double kIntegratingSphere = 0.75 * 3 / (1.5 * 1.5) / (kPiDouble * (1 - 0.75)); ///< radiance of the
                                                                                                ///< sphere

} // namespace duet::raytrace
