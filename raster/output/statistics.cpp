#include "raster/output/statistics.h"

#include "common/system/control.h"
#include "common/system/error.h"
#include "raster/gbuffer/screen_gbuffer.h"
#include "raster/lighting/prefiltered_environment.h"
#include "raster/screen_space/required_passes.h"
#include "raster/screen_space/screen_space_refraction.h"
#include "raster/shadows/shadows.h"

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
    add_if(!needs.footprints, "texture footprints", "no material has a picture that is filtered");
    add_if(!needs.normal_maps, "normal maps", "no material has one");
    add_if(!needs.alpha, "transparent layers", "no material has holes or lets light through");
    add_if(!needs.spheres, "spheres", "the scene has none");
    add_if(!needs.instances, "instances", "every object stands in world space");
    if (settings.shading == Shading::kLit) {
        add_if(!needs.environment, "environment", "it is black");
        add_if(needs.environment && !settings.environment, "environment", "turned off");
        add_if(data.scene.lights.empty(), "lights", "the scene has none");
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

/// Returns true if an object has glass together with other materials or with an alpha mask. Rays through such glass
/// are not traced.
bool has_mixed_glass(const RasterSceneData& data) {
    for (std::uint32_t i = 0; i < data.scene.objects.size(); ++i)
        for (const std::uint32_t material : data.scene.objects[i].materials)
            if (std::holds_alternative<Dielectric>(data.scene.materials[material]) && !is_glass(data, i)) return true;
    return false;
}

void list_shadow_approximations(const RasterSceneData& data, const RasterSettings& settings,
                                std::vector<std::string>& result) {
    const Scene& scene = data.scene;
    if (!settings.components.direct || scene.lights.empty()) return;
    if (!settings.shadows || !data.shadows) {
        result.emplace_back("DirectRadiance light is unshadowed.");
        return;
    }
    if (scene.needs.delta_lights)
        result.emplace_back("Shadows of point, spot and sun lights are filtered over about three texels of a map.");
    if (scene.needs.surface_lights)
        result.emplace_back(
            "Soft shadows are estimated from the depths that the light's centre sees, with one width of "
            "penumbra a point.");
    if (std::any_of(scene.maps.begin(), scene.maps.end(),
                    [](const SurfaceMaps& maps) { return maps.has_transparency() && !(maps.cutoff > 0); }))
        result.emplace_back(
            "Shadows of what stops a part of the light are dithered: it stops all of that part of a map's texels.");
    if (data.shadows->moments() > 1)
        result.push_back(message("Shadows of moving objects are those of ", data.shadows->moments(), " moments."));
    if (data.shadows->coarser())
        result.emplace_back("Shadow maps are coarser than asked for: there are too many of them.");
    if (data.shadows->unshadowed() > 0)
        result.push_back(message("The ", data.shadows->unshadowed(), " weakest lights are unshadowed."));
}

std::vector<std::string> list_approximations(const RasterSceneData& data, const RasterSettings& settings) {
    const Scene& scene = data.scene;
    const SceneNeeds& needs = scene.needs;
    std::vector<std::string> result;
    const auto add_if = [&](bool applies, const char* sentence) {
        if (applies) result.emplace_back(sentence);
    };
    const bool many = settings.samples_per_pixel > 1;
    const bool moving = needs.motion && scene.camera.shutter_open != scene.camera.shutter_close;
    add_if(needs.lens && !many, "The lens is a pinhole at its centre: one sample a pixel sees no depth of field.");
    add_if(needs.lens && many,
           "Depth of field is the mean of one view a sample, through the same lens points in every pixel.");
    add_if(moving && !many,
           "Moving objects stand where they are when the shutter opens: one sample a pixel sees no motion.");
    add_if(moving && many, "Motion blur is the mean of one moment a sample, the same moments in every pixel.");
    if (settings.shading != Shading::kLit || scene.objects.empty()) return result;
    if (data.irradiance_probes) {
        add_if(true, "Light between surfaces is interpolated from irradiance probes; caustics are left out.");
        add_if(!scene.lights.empty() && settings.shadows,
               "Shadows come from shadow maps; those of area lights use few taps per pixel.");
        add_if(data.reflection_probes != nullptr,
               "Reflections and glass show the image, or probes that see the scene from one point per object.");
        return result;
    }

    const LightComponentSet& parts = settings.components;
    const bool environment = settings.environment && needs.environment;
    add_if(parts.emission && parts.direct && parts.environment && parts.reflection,
           "Light that surfaces reflect onto each other is left out.");
    list_shadow_approximations(data, settings, result);
    add_if(parts.environment && environment && settings.ambient_occlusion == AmbientOcclusion::kNone,
           "Light from the environment is unoccluded.");
    if (parts.environment && environment && settings.ambient_occlusion != AmbientOcclusion::kNone) {
        const bool even = settings.ambient_occlusion == AmbientOcclusion::kSsao;
        result.push_back(message(
            "What hides the environment from diffuse surfaces is guessed from the picture's depths, up to ",
            occlusion_radius(data, settings), even ? " m away, as if all of it were equally bright." : " m away."));
    }
    add_if(parts.environment && environment && !data.irradiance.is_closed_form(),
           "Diffuse surfaces receive the environment picture's spherical harmonics up to the second order.");
    const bool refracts = needs_glass_layers(data, settings);
    const bool mirrors = needs_color_prepass(data, settings),
               any = parts.reflection && (needs.specular || needs.glossy);
    const bool has_fallback = needs.transmission && (!refracts || has_mixed_glass(data));
    const char* fallback_glass = refracts ? "Glass with holes, or in one object with other materials," : "Glass";
    add_if(any && !mirrors && !refracts,
           "Metal and glass mirror the environment alone, no surfaces and no lights that have one.");
    if (any && (mirrors || refracts) && has_fallback)
        result.push_back(
            message(fallback_glass, " mirrors the environment alone, no surfaces and no lights that have one."));
    if ((mirrors || refracts) && data.unreflected_lights > 0)
        result.push_back(
            message("The ", data.unreflected_lights, " weakest lamps are mirrored only where the picture shows them."));
    add_if(any && (mirrors || refracts) && needs.glossy,
           "Rougher metal mirrors the environment alone, no surfaces and no lights that have one.");
    add_if(mirrors, "Smooth and moderately rough metal mirrors what the picture shows, and in that no reflections; "
                    "past its edge and behind "
                    "things what is seen there is taken to go on.");
    const bool prefiltered = settings.prefiltered_environment && data.prefiltered;
    add_if(parts.reflection && needs.glossy && environment && !prefiltered,
           "Rough metal and frosted glass show the environment as smooth ones do.");
    add_if(parts.reflection && needs.glossy && environment && prefiltered,
           "Rough metal and frosted glass show the environment blurred as by a surface that faces the viewer.");
    add_if(parts.direct && needs.glossy && needs.surface_lights && settings.transformed_cosines,
           "Light surfaces shine on rough metal and frosted glass by linearly transformed cosines that look like its "
           "lobe.");
    add_if(parts.direct && needs.glossy && needs.surface_lights && !settings.transformed_cosines,
           "Rough metal and frosted glass see each light surface as a distant light in its centre's direction.");
    if (refracts)
        result.push_back(
            message("Glass mirrors and refracts what the picture shows without it, up to ", kMaxGlassDepth,
                    " objects of glass deep, its far side found in the picture's depths, and casts no caustics."));
    add_if(refracts && needs.media, "Glass overlaps as if it did not.");
    if (parts.reflection && has_fallback)
        result.push_back(message(
            fallback_glass, " shows the environment refracted once at its front, not the surfaces behind it, and casts "
                            "no caustics."));
    if (parts.reflection && needs.media && has_fallback)
        result.push_back(
            message(fallback_glass,
                    " absorbs as over the mean way through a ball of its size, and overlaps as if it did not."));
    add_if(
        needs.layers,
        "The layers of principled and coated surfaces are shaded each by itself, by as much as the viewer sees of it.");
    add_if(parts.direct && needs.emitter_textures, "Surfaces that emit a picture light others by its mean.");
    add_if(parts.direct && data.unsampled_emitters,
           "Light surfaces that move, and stretched spheres, are seen but light nothing.");
    return result;
}

} // namespace

std::vector<std::string> approximations(const RasterScene& prepared, const RasterSettings& settings) {
    return list_approximations(prepared.data(), settings);
}

void StatisticsCollector::add(const Geometry& geometry) {
    transform += geometry.transform_seconds;
    setup += geometry.setup_seconds;
    bin += geometry.bin_seconds;
    culled += geometry.culled;
    geometry_bytes = std::max(geometry_bytes, geometry.memory_bytes());
}

void StatisticsCollector::add(const ScreenGBuffer& gbuffer, GeometryPool& pool) {
    gbuffer_bytes = std::max(gbuffer_bytes, gbuffer.memory_bytes() + pool.memory_bytes());
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
        result.insert(result.end(), {{"prepass", prepass}, {"cover", covering}, {"shade", tiles - covering}});
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
    statistics.approximations = list_approximations(data, settings);
}

} // namespace duet::raster
