#include "compare/ladder/rungs.h"

#include "compare/report/text.h"

namespace duet::compare {

namespace {

RungRenderers make_renderers(std::string name, const PreparedPair& pair, const raster::RasterSettings& raster,
                             const raytrace::PathTracerSettings& raytrace) {
    return {std::move(name), raster, raytrace, render_function(pair.raster, raster),
            render_function(pair.raytrace, raytrace)};
}

RungRenderers hit_renderers(const PreparedPair& pair) {
    return make_renderers("hits", pair, hit_settings(pair.raster_settings), hit_settings(pair.raytrace_settings));
}

RungRenderers surface_renderers(const char* name, const PreparedPair& pair, raster::Shading shading,
                                raytrace::Integrator integrator) {
    raster::RasterSettings raster = pair.raster_settings;
    raster.shading = shading;
    raytrace::PathTracerSettings raytrace = pair.raytrace_settings;
    raytrace.integrator = integrator;
    return make_renderers(name, pair, raster, raytrace);
}

/// Renders some components of the light alone. `environment` sets the settings of that name.
RungRenderers light_renderers(const char* name, const PreparedPair& pair, const raster::LightComponentSet& parts,
                              raytrace::Integrator integrator, bool environment) {
    raster::RasterSettings raster = pair.raster_settings;
    raster.components = parts;
    raster.environment = environment;
    const bool paths = integrator == raytrace::Integrator::kPath;
    raster.fog = raster.subsurface = paths; // the others leave media out, and draw solids as diffuse surfaces
    raytrace::PathTracerSettings raytrace = pair.raytrace_settings;
    raytrace.integrator = integrator;
    raytrace.environment = environment;
    return make_renderers(name, pair, raster, raytrace);
}

/// Returns the rung, or only the note `absent` if the scene does not have the quantity.
RungPlan rung_if_present(bool present, RungPlan rung, const char* absent) {
    if (present) return rung;
    return {{}, "", "", absent};
}

constexpr const char* kNoLights = "The scene has no light but, perhaps, its environment.";

} // namespace

PreparedPair prepare_pair(const Scene& scene, const ComparisonSettings& common) {
    const raster::RasterSettings raster = raster_settings(common);
    raytrace::PathTracerSettings raytrace = path_tracer_settings(common);
    raytrace.samples_per_pixel += raytrace.samples_per_pixel % 2; // must be even, for two halves
    raytrace.aovs.variance = true; // makes the halves replicates
    return {raster::prepare(scene, raster), raster, raytrace::prepare(scene, raytrace), raytrace};
}

std::array<RungPlan, kRungCount> plan_rungs(const Scene& scene, const PreparedPair& pair) {
    using raytrace::Integrator;
    const SceneNeeds& needs = scene.needs;
    const bool lights = !scene.lights.empty();
    const RungPlan visibility{{hit_renderers(pair)},
                              "Projects each primitive onto the pixels and keeps the nearest.",
                              "Sends a ray through each pixel's center into a bounding volume hierarchy.",
                              ""};
    const RungPlan normals{{surface_renderers("normals", pair, raster::Shading::kNormal, Integrator::kNormal),
                            surface_renderers("albedo", pair, raster::Shading::kAlbedo, Integrator::kAlbedo)},
                           "Surface point and texture of its hits.",
                           "Surface point and texture of its hits.",
                           "Shared code: from a hit on, both are the same. Where these images differ, samples lie "
                           "elsewhere in the pixel."};
    PreparedPair open = pair; // renders without shadows
    open.raster_settings.shadows = false;
    const RungPlan direct{{light_renderers("direct", open, kLightsAlone, Integrator::kUnshadowed, false)},
                          "Each light in closed form; on rough metal by a linearly transformed cosine.",
                          "One light sample a camera ray, its visibility left out.",
                          ""};
    raster::RasterSettings raster_lights = pair.raster_settings;
    raster_lights.components = kLightsAlone;
    const RungPlan shadows{{light_renderers("shadows", pair, kLightsAlone, Integrator::kLights, false)},
                           "The same light, times the part that shadow maps let pass.",
                           "Light and BSDF samples with shadow rays, combined by multiple importance sampling.",
                           joined(raster::approximations(pair.raster, raster_lights), " ")};
    PreparedPair sky = pair; // renders without light between surfaces
    sky.raster_settings.indirect_light = false;
    const RungPlan environment{
        {light_renderers("environment", sky, kEnvironmentAlone, Integrator::kEnvironment, true)},
        "Irradiance in closed form or by spherical harmonics, times the fraction of the environment that the image's "
        "depths leave visible. The sun of an environment image is a light with shadow maps.",
        "Light and BSDF samples of the environment, with shadow rays.",
        ""};
    const RungPlan reflections{
        {light_renderers("reflections", pair, kReflectionAlone, Integrator::kReflection, true)},
        "Looks up the mirrored and the refracted ray in the image, else in probes that see the scene from one point "
        "per object, blurred where metal is rough.",
        "Follows the path on from metal and glass to whatever it meets.",
        ""};
    const RungPlan everything{{light_renderers("everything", pair, {}, Integrator::kPath, true)},
                              "All of the above, and diffuse light between surfaces from irradiance probes.",
                              "Whole paths.",
                              ""};
    return {visibility,
            normals,
            rung_if_present(lights, direct, kNoLights),
            rung_if_present(lights, shadows, kNoLights),
            rung_if_present(needs.environment, environment, "The scene has no environment."),
            rung_if_present(needs.specular || needs.glossy, reflections, "The scene has no metal and no glass."),
            everything};
}

} // namespace duet::compare
