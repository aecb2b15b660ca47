#include "raster/output/statistics.h"

#include "common/system/control.h"
#include "common/system/error.h"
#include "raster/lighting/background.h"
#include "raster/probes/reflection_probes.h"
#include "raster/shading/deferred.h"
#include "raster/shadows/shadow_maps.h"

#include <algorithm>

namespace duet::raster {
namespace {

/// Lists the features that the scene does not need, and the numbers of culled primitives.
std::vector<SkippedWork> list_skipped(const RasterSceneData& data, const RasterSettings& settings,
                                      const CullCounts& culled) {
    const SceneNeeds& needs = data.scene.needs;
    std::vector<SkippedWork> result;
    const auto add_if = [&](bool skipped, const char* what, const char* why) {
        if (skipped) result.push_back({.what = what, .why = why, .count = -1});
    };
    add_if(!needs.textures, "textures", "no material has one");
    add_if(!needs.lens, "lens", "the camera is a pinhole: all samples share one view");
    add_if(!needs.motion, "motion", "nothing moves: all samples share one moment");
    add_if(!needs.footprints, "texture footprints", "no material has an image that is filtered");
    add_if(!needs.normal_maps, "normal maps", "no material has one");
    add_if(!needs.alpha, "transparent layers", "no material has an opacity below 1");
    add_if(!needs.spheres, "spheres", "the scene has none");
    add_if(!needs.instances, "instances", "every object stands in world space");
    if (settings.shading == Shading::kLit) {
        add_if(!needs.environment, "environment", "it is black");
        add_if(needs.environment && !settings.environment, "environment", "turned off");
        add_if(data.scene.lights.empty(), "lights", "the scene has none");
        add_if(data.scene.media.empty(), "media", "the scene has none");
        add_if(!data.scene.media.empty() && !settings.fog, "media", "turned off");
        add_if(!settings.components.emission, "emission", "turned off");
        add_if(!settings.components.direct, "direct light", "turned off");
        add_if(!settings.components.environment, "environment on diffuse surfaces", "turned off");
        add_if(!settings.components.reflection, "environment on metal and glass", "turned off");
    }
    add_if(settings.aovs.variance, "variance", "the samples are one pattern, the same in every pixel: no replicates");
    const auto count = [&](std::int64_t number, const char* what, const char* why) {
        if (number > 0) result.push_back({.what = what, .why = why, .count = number});
    };
    count(culled.backfaces, "backfaces", "of closed, opaque meshes seen from outside");
    count(culled.outside, "outside the frustum", "primitives that no pixel can see");
    count(culled.subpixel, "sub-pixel", "triangles between the samples");
    count(culled.degenerate, "degenerate", "triangles of no area on the sub-pixel grid");
    return result;
}

void list_shadow_approximations(const RasterSceneData& data, const RasterSettings& settings,
                                std::vector<std::string>& result) {
    const Scene& scene = data.scene;
    const bool direct = settings.components.direct && !scene.lights.empty(),
               sun = settings.components.environment && data.sun;
    if (!direct && !sun) return;
    if (sun)
        result.emplace_back(
            "The sun of the environment lights diffuse surfaces as if all its light came from its middle.");
    if (!settings.shadows || !data.shadows) {
        result.emplace_back("Direct light is unshadowed.");
        return;
    }
    if (scene.needs.delta_lights)
        result.emplace_back("Shadows of point, spot and sun lights are filtered over about three texels of a map.");
    if (scene.needs.surface_lights || sun)
        result.emplace_back(
            "Soft shadows are estimated from the depths that the light's center sees, by few taps per pixel that "
            "neighbors share.");
    if (std::any_of(scene.maps.begin(), scene.maps.end(),
                    [](const SurfaceMaps& maps) { return maps.has_transparency() && !(maps.cutoff > 0); }))
        result.emplace_back(
            "Shadows of partly transparent surfaces are dithered: they stop all light at that fraction of a map's "
            "texels.");
    if (data.shadows->moments() > 1)
        result.push_back(message("Shadows of moving objects are those of ", data.shadows->moments(), " moments."));
    if (data.shadows->coarser())
        result.emplace_back("Shadow maps are coarser than requested: there are too many of them.");
    if (data.shadows->unshadowed() > 0)
        result.push_back(message("The ", data.shadows->unshadowed(), " weakest lights are unshadowed."));
}

} // namespace

std::vector<std::string> approximations(const RasterSceneData& data, const RasterSettings& settings) {
    const Scene& scene = data.scene;
    const SceneNeeds& needs = scene.needs;
    std::vector<std::string> result;
    const auto add_if = [&](bool applies, const char* sentence) {
        if (applies) result.emplace_back(sentence);
    };
    const bool many = settings.samples_per_pixel > 1;
    const bool moving = needs.motion && scene.camera.shutter_open != scene.camera.shutter_close;
    add_if(needs.lens && !many, "The lens is a pinhole at its center: one sample per pixel sees no depth of field.");
    add_if(needs.lens && many,
           "Depth of field is the mean of one view a sample, through the same lens points in every pixel.");
    add_if(moving && !many,
           "Moving objects stand where they are when the shutter opens: one sample per pixel sees no motion.");
    add_if(moving && many, "Motion blur is the mean of one moment a sample, the same moments in every pixel.");
    if (settings.shading != Shading::kLit || scene.objects.empty()) return result;

    const LightComponentSet& parts = settings.components;
    const bool environment = settings.environment && needs.environment;
    list_shadow_approximations(data, settings, result);
    if (parts.environment && data.irradiance_probes && settings.indirect_light) {
        add_if(true, "Diffuse light between surfaces is interpolated from irradiance probes; caustics are left out.");
        add_if(settings.ambient_occlusion,
               "In creases finer than the probes' grid, occluders and their light are found in the image alone.");
    } else if (parts.environment) {
        add_if(!is_dark(data, settings), "Light that surfaces reflect onto each other is left out.");
        add_if(environment && settings.ambient_occlusion,
               "What hides the environment from diffuse surfaces is estimated from the image's depths.");
        add_if(environment && !settings.ambient_occlusion, "Light from the environment is unoccluded.");
        add_if(environment && std::holds_alternative<ImageEnvironment>(scene.environment),
               "Diffuse surfaces receive the environment image's spherical harmonics up to the second order.");
    }
    add_if(parts.reflection && data.reflection_probes != nullptr,
           "Reflections show probes that see the scene from one point per object.");
    add_if(parts.reflection && needs.transmission,
           "Glass refracts once on entry and once on exit, and casts no caustics.");
    add_if(parts.direct && needs.glossy && needs.surface_lights,
           "Area lights on rough metal and frosted glass are reflected by linearly transformed cosines.");
    add_if(parts.direct && needs.emitter_textures, "Textured area lights light other surfaces by their mean radiance.");
    add_if(parts.direct && data.unsampled_emitters,
           "Emissive surfaces that move, and stretched spheres, are visible but light nothing.");
    add_if(needs.subsurface && settings.subsurface,
           "Light that is scattered inside of solids is blurred over the image; none comes through thin parts.");
    add_if(needs.subsurface && !settings.subsurface, "Light leaves solids where it has entered them.");
    if (scene.media.empty() || !settings.fog) return result;
    add_if(true, "Light that media scatter is computed in cells of 8 x 8 pixels by 64 slices.");
    add_if(parts.direct && std::ranges::any_of(scene.media, [](const Medium& m) { return m.density != nullptr; }),
           "Light that clouds scatter more than once is estimated by octaves.");
    add_if(parts.direct && scene.lights.size() > FogGrid::kMostLights,
           "Where more than 64 lights reach a part of the media, as many stand for all.");
    add_if(parts.environment && data.irradiance_probes && settings.indirect_light,
           "Light that media scatter more than once is what irradiance probes see, from all directions alike.");
    add_if(environment && parts.environment && !settings.indirect_light,
           "Media attenuate the environment's light on diffuse surfaces as if it came along the normal.");
    add_if(parts.environment && !settings.indirect_light,
           "Light that media scatter more than once, and light of surfaces that they scatter, is left out.");
    add_if(parts.direct && needs.surface_lights, "Media scatter the light of area lights as if it came from their "
                                                 "middle.");
    add_if(needs.transmission, "Media are inside of glass, too.");
    return result;
}

void StatisticsCollector::add(const Geometry& geometry) {
    transform += geometry.transform_seconds;
    setup += geometry.setup_seconds;
    bin += geometry.bin_seconds;
    culled += geometry.culled;
    geometry_bytes = std::max(geometry_bytes, geometry.memory_bytes());
}

void StatisticsCollector::add(const DeferredFrame& frame) {
    gbuffer_bytes = std::max(gbuffer_bytes, frame.memory_bytes());
    for (const auto& [stage, seconds] : frame.seconds) add_stage(stage, seconds);
}

void StatisticsCollector::add_stage(std::string_view stage, double seconds) {
    const auto found = std::find_if(stages.begin(), stages.end(), [&](const auto& s) { return s.first == stage; });
    if (found == stages.end())
        stages.emplace_back(stage, seconds);
    else
        found->second += seconds;
}

std::vector<std::pair<std::string, double>> StatisticsCollector::seconds() const {
    const double cover = static_cast<double>(coverage_work), work = cover + static_cast<double>(shade_work);
    const double covering = work > 0 ? tiles * cover / work : 0;
    std::vector<std::pair<std::string, double>> result{{"transform", transform}, {"setup", setup}, {"bin", bin}};
    if (stages.empty())
        result.insert(result.end(), {{"cover", covering}, {"shade", tiles - covering}});
    else
        result.insert(result.end(), stages.begin(), stages.end());
    result.emplace_back("resolve", resolve);
    return result;
}

void Progress::step() {
    if (!control_.progress) return;
    const std::lock_guard lock(mutex_);
    control_.report(static_cast<double>(++done_) / static_cast<double>(steps_));
}

void fill_statistics(RenderStatistics& statistics, const RasterSceneData& data, const RasterSettings& settings,
                     const StatisticsCollector& collector, const std::vector<Pass>& passes, const TileGrid& grid) {
    const std::size_t passes_done = collector.tiles_done / grid.size();
    statistics.interrupted = collector.tiles_done < grid.size() * passes.size();
    statistics.passes = static_cast<int>(passes_done);
    for (std::size_t i = 0; i < passes_done; ++i)
        statistics.samples_per_pixel += static_cast<int>(passes[i].samples.size());
    statistics.seconds = collector.seconds();
    statistics.triangles = data.primitives;
    statistics.memory_bytes =
        data.memory_bytes +
        static_cast<std::int64_t>(collector.geometry_bytes + collector.gbuffer_bytes + collector.framebuffer_bytes);
    statistics.skipped = list_skipped(data, settings, collector.culled);
    statistics.approximations = approximations(data, settings);
}

} // namespace duet::raster
