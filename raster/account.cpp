#include "raster/account.h"

#include "common/system/control.h"
#include "common/system/error.h"
#include "raster/light/prefiltered.h"
#include "raster/screen/glass.h"
#include "raster/screen/needs.h"
#include "raster/screen/screen.h"
#include "raster/shadow/shadows.h"

#include <algorithm>

namespace duet::raster {
namespace {

/// Lists the features that the scene does not need, and the numbers of culled primitives.
std::vector<Skipped> list_skipped(const PreparedData& data, const Settings& settings, const CullCounts& culled) {
    const SceneNeeds& needs = data.scene.needs;
    std::vector<Skipped> result;
    const auto because = [&](bool skipped, const char* what, const char* why) {
        if (skipped) result.push_back({.what = what, .why = why, .count = -1});
    };
    because(!needs.textures, "textures", "no material has one");
    because(!needs.lens, "lens", "the camera is a pinhole: all samples share one view");
    because(!needs.motion, "motion", "nothing moves: all samples share one moment");
    because(!needs.footprints, "texture footprints", "no material has a picture that is filtered");
    because(!needs.normal_maps, "normal maps", "no material has one");
    because(!needs.alpha, "transparent layers", "no material has holes or lets light through");
    because(!needs.spheres, "spheres", "the scene has none");
    because(!needs.instances, "instances", "every object stands in world space");
    if (settings.shading == Shading::kLit) {
        because(!needs.environment, "environment", "it is black");
        because(needs.environment && !settings.environment, "environment", "turned off");
        because(data.scene.lights.empty(), "lights", "the scene has none");
        because(!settings.parts.emission, "emission", "turned off");
        because(!settings.parts.direct, "direct light", "turned off");
        because(!settings.parts.environment, "environment on diffuse surfaces", "turned off");
        because(!settings.parts.reflection, "environment on metal and glass", "turned off");
    }
    because(settings.aovs.variance, "variance", "the samples are one pattern, the same in every pixel: no replicates");
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
bool has_mixed_glass(const PreparedData& data) {
    for (std::uint32_t i = 0; i < data.scene.objects.size(); ++i)
        for (const std::uint32_t material : data.scene.objects[i].materials)
            if (std::holds_alternative<Dielectric>(data.scene.materials[material]) && !is_glass(data, i)) return true;
    return false;
}

void list_shadow_approximations(const PreparedData& data, const Settings& settings, std::vector<std::string>& result) {
    const Scene& scene = data.scene;
    if (!settings.parts.direct || scene.lights.empty()) return;
    if (!settings.shadows || !data.shadows) {
        result.emplace_back("Direct light is unshadowed.");
        return;
    }
    if (scene.needs.delta_lights)
        result.emplace_back("Shadows of point, spot and sun lights are filtered over about three texels of a map.");
    if (scene.needs.surface_lights)
        result.emplace_back(
            "Soft shadows are estimated from the depths that the light's centre sees, with one width of "
            "penumbra a point.");
    if (std::any_of(scene.maps.begin(), scene.maps.end(),
                    [](const SurfaceMaps& maps) { return maps.cuts_out() && !(maps.cutoff > 0); }))
        result.emplace_back(
            "Shadows of what stops a part of the light are dithered: it stops all of that part of a map's texels.");
    if (data.shadows->moments() > 1)
        result.push_back(message("Shadows of moving objects are those of ", data.shadows->moments(), " moments."));
    if (data.shadows->coarser())
        result.emplace_back("Shadow maps are coarser than asked for: there are too many of them.");
    if (data.shadows->unshadowed() > 0)
        result.push_back(message("The ", data.shadows->unshadowed(), " weakest lights are unshadowed."));
}

std::vector<std::string> list_approximations(const PreparedData& data, const Settings& settings) {
    const Scene& scene = data.scene;
    const SceneNeeds& needs = scene.needs;
    std::vector<std::string> result;
    const auto name = [&](bool applies, const char* sentence) {
        if (applies) result.emplace_back(sentence);
    };
    const bool many = settings.samples_per_pixel > 1;
    const bool moving = needs.motion && scene.camera.shutter_open != scene.camera.shutter_close;
    name(needs.lens && !many, "The lens is a pinhole at its centre: one sample a pixel sees no depth of field.");
    name(needs.lens && many,
         "Depth of field is the mean of one view a sample, through the same lens points in every pixel.");
    name(moving && !many,
         "Moving objects stand where they are when the shutter opens: one sample a pixel sees no motion.");
    name(moving && many, "Motion blur is the mean of one moment a sample, the same moments in every pixel.");
    if (settings.shading != Shading::kLit || scene.objects.empty()) return result;

    const PartSet& parts = settings.parts;
    const bool environment = settings.environment && needs.environment;
    name(parts.emission && parts.direct && parts.environment && parts.reflection,
         "Light that surfaces reflect onto each other is left out.");
    list_shadow_approximations(data, settings, result);
    name(parts.environment && environment && settings.ambient_occlusion == AmbientOcclusion::kNone,
         "Light from the environment is unoccluded.");
    if (parts.environment && environment && settings.ambient_occlusion != AmbientOcclusion::kNone) {
        const bool even = settings.ambient_occlusion == AmbientOcclusion::kSsao;
        result.push_back(message(
            "What hides the environment from diffuse surfaces is guessed from the picture's depths, up to ",
            occlusion_radius(data, settings), even ? " m away, as if all of it were equally bright." : " m away."));
    }
    name(parts.environment && environment && !data.irradiance.is_closed_form(),
         "Diffuse surfaces receive the environment picture's spherical harmonics up to the second order.");
    const bool refracts = needs_screen_behind(data, settings);
    const bool mirrors = needs_screen_radiance(data, settings),
               any = parts.reflection && (needs.specular || needs.glossy);
    const bool plain = needs.transmission && (!refracts || has_mixed_glass(data));
    const char* plain_glass = refracts ? "Glass with holes, or in one object with other materials," : "Glass";
    name(any && !mirrors && !refracts,
         "Metal and glass mirror the environment alone, no surfaces and no lights that have one.");
    if (any && (mirrors || refracts) && plain)
        result.push_back(
            message(plain_glass, " mirrors the environment alone, no surfaces and no lights that have one."));
    if ((mirrors || refracts) && data.unmirrored_lamps > 0)
        result.push_back(
            message("The ", data.unmirrored_lamps, " weakest lamps are mirrored only where the picture shows them."));
    name(any && (mirrors || refracts) && needs.glossy,
         "Rougher metal mirrors the environment alone, no surfaces and no lights that have one.");
    name(
        mirrors,
        "Smooth and moderately rough metal mirrors what the picture shows, and in that no reflections; past its edge and behind "
        "things what is seen there is taken to go on.");
    const bool prefiltered = settings.prefiltered_environment && data.prefiltered;
    name(parts.reflection && needs.glossy && environment && !prefiltered,
         "Rough metal and frosted glass show the environment as smooth ones do.");
    name(parts.reflection && needs.glossy && environment && prefiltered,
         "Rough metal and frosted glass show the environment blurred as by a surface that faces the viewer.");
    name(
        parts.direct && needs.glossy && needs.surface_lights && settings.transformed_cosines,
        "Light surfaces shine on rough metal and frosted glass by linearly transformed cosines that look like its lobe.");
    name(parts.direct && needs.glossy && needs.surface_lights && !settings.transformed_cosines,
         "Rough metal and frosted glass see each light surface as a distant light in its centre's direction.");
    if (refracts)
        result.push_back(
            message("Glass mirrors and refracts what the picture shows without it, up to ", kGlassDeep,
                    " objects of glass deep, its far side found in the picture's depths, and casts no caustics."));
    name(refracts && needs.insides, "Glass overlaps as if it did not.");
    if (parts.reflection && plain)
        result.push_back(message(
            plain_glass, " shows the environment refracted once at its front, not the surfaces behind it, and casts "
                         "no caustics."));
    if (parts.reflection && needs.insides && plain)
        result.push_back(message(
            plain_glass, " absorbs as over the mean way through a ball of its size, and overlaps as if it did not."));
    name(
        needs.layers,
        "The layers of principled and coated surfaces are shaded each by itself, by as much as the viewer sees of it.");
    name(parts.direct && needs.lamp_textures, "Surfaces that emit a picture light others by its mean.");
    name(parts.direct && data.unsampled_emitters,
         "Light surfaces that move, and stretched spheres, are seen but light nothing.");
    return result;
}

} // namespace

std::vector<std::string> approximations(const Prepared& prepared, const Settings& settings) {
    return list_approximations(prepared.data(), settings);
}

void Account::add(const Geometry& geometry) {
    transform += geometry.transform_seconds;
    setup += geometry.setup_seconds;
    bin += geometry.bin_seconds;
    culled += geometry.culled;
    geometry_bytes = std::max(geometry_bytes, geometry.memory_bytes());
}

void Account::add(const Screen& screen, GeometryPool& pool) {
    look_bytes = std::max(look_bytes, screen.memory_bytes() + pool.memory_bytes());
}

void Account::add_stage(std::string_view stage, double seconds) {
    const auto found = std::find_if(stages.begin(), stages.end(), [&](const auto& s) { return s.first == stage; });
    if (found == stages.end())
        stages.emplace_back(stage, seconds);
    else
        found->second += seconds;
}

std::vector<std::pair<std::string, double>> Account::seconds() const {
    const double cover = static_cast<double>(cover_work), work = cover + static_cast<double>(shade_work);
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

void fill_statistics(RenderStatistics& statistics, const PreparedData& data, const Settings& settings,
                     const Account& account, const std::vector<Pass>& passes, const TileGrid& grid) {
    const std::size_t passes_done = account.tiles_done / grid.size();
    statistics.interrupted = account.tiles_done < grid.size() * passes.size();
    statistics.passes = static_cast<int>(passes_done);
    for (std::size_t i = 0; i < passes_done; ++i)
        statistics.samples_per_pixel += static_cast<int>(passes[i].samples.size());
    statistics.seconds = account.seconds();
    statistics.triangles = data.primitives;
    statistics.memory_bytes = data.memory_bytes + static_cast<std::int64_t>(account.geometry_bytes +
                                                                            account.look_bytes + account.picture_bytes);
    statistics.skipped = list_skipped(data, settings, account.culled);
    statistics.approximations = list_approximations(data, settings);
}

} // namespace duet::raster
