#include "raytrace/render_plan.h"

#include "common/system/error.h"
#include "raytrace/integrator/russian_roulette.h"

#include <algorithm>

namespace duet::raytrace {

namespace {

bool computes_light(Integrator integrator) {
    return integrator != Integrator::kNormal && integrator != Integrator::kAlbedo;
}
bool samples_lights(Integrator integrator) { return computes_light(integrator) && integrator != Integrator::kNaive; }

int depth(const PathTracerSettings& settings) {
    const int requested = std::max(settings.max_depth, 0);
    switch (settings.integrator) {
    case Integrator::kPath:
    case Integrator::kNaive:
    case Integrator::kBidirectional:
    case Integrator::kVcm:
    case Integrator::kPhotons:
    case Integrator::kMetropolis:
    case Integrator::kWhitted:
    case Integrator::kReflection:
        return requested;
    case Integrator::kDirect:
    case Integrator::kUnshadowed:
    case Integrator::kLights:
    case Integrator::kEnvironment:
        return std::min(requested, 1);
    case Integrator::kNormal:
    case Integrator::kAlbedo:
        break;
    }
    return 0;
}

// Returns whether paths enter solids. Other integrators cannot follow light from its point of entry to its point of
// exit.
bool enters_solids(Integrator integrator) {
    return integrator == Integrator::kPath || integrator == Integrator::kNaive;
}

} // namespace

RenderPlan::RenderPlan(const PathTracerSceneData& prepared_, const View& view, const PathTracerSettings& settings)
    : prepared(prepared_), scene(prepared_.scene), filter(settings.filter), batched(scene.objects.size()),
      max_depth(depth(settings)),
      russian_roulette(settings.russian_roulette && max_depth > 1 && settings.integrator != Integrator::kWhitted) {
    const SkipFlags& skips = settings.skips;
    const CameraModel camera(view);
    camera_needs.lens = camera.has_lens() || !skips.lens;
    if (scene.needs.footprints) pixel_footprint.emplace(camera.pinhole(), 1);
    camera_needs.time = scene.needs.motion || !skips.motion;
    bsdfs = skips.textures ? &prepared.bsdfs : &no_bsdfs_;
    if (!skips.textures) no_bsdfs_.resize(prepared.bsdfs.size());
    for (std::uint32_t i = 0; i < scene.materials.size(); ++i) details.push_back(surface_detail(scene, i));
    emission = prepared.emitters || !skips.emission;
    specular_light_samples = !skips.mirror_light;
    subsurface = scene.needs.subsurface && enters_solids(settings.integrator);
    random_distances = subsurface || scene.needs.media;
    needs_medium_stack = scene.needs.interiors || random_distances;
    black_shadow_rays = !skips.shadow_rays;
    const bool with_environment =
        settings.environment && (prepared.environment || !skips.environment) && computes_light(settings.integrator);
    if (with_environment) environment = &scene.environment;
    const bool media_emit =
        std::ranges::any_of(scene.media, [](const Medium& m) { return !is_black(m.absorption * m.radiance); });
    hits_find_light = with_environment || prepared.emitters || media_emit || !skips.last_bounce;
    const bool environment_only = with_environment && settings.integrator == Integrator::kEnvironment;
    const LightSampler& chooser = environment_only   ? prepared.environment_light
                                  : with_environment ? prepared.lights
                                                     : prepared.finite_lights;
    const bool lights_useful = (prepared.scatters_diffusely && !chooser.empty()) || !skips.light_samples;
    if (samples_lights(settings.integrator) && max_depth > 0 && lights_useful) lights = &chooser;
    if (lights != nullptr && !environment_only && scene.needs.media) delta_lights = scene.first_surface_light;
    // Paths are scattered in batches only if they need no medium stack, no footprints, and none of the shadow rays and
    // light samples that tests request, because batches do not support these.
    if (!needs_medium_stack && !pixel_footprint && !black_shadow_rays && !specular_light_samples)
        batched = BatchedSurfaces(scene, *bsdfs);
}

std::vector<SkippedWork> skipped(const RenderPlan& plan, const PathTracerSettings& settings) {
    std::vector<SkippedWork> list;
    const auto skip = [&](std::string what, std::string why) { list.push_back({std::move(what), std::move(why)}); };
    const auto constant = std::count_if(plan.prepared.bsdfs.begin(), plan.prepared.bsdfs.end(),
                                        [](const auto& bsdf) { return bsdf.has_value(); });
    if (constant == static_cast<std::ptrdiff_t>(plan.prepared.bsdfs.size()))
        skip("textures", "no material has one: each BSDF is made once, not at each hit");
    else if (constant > 0)
        list.push_back({"textures", "materials without one, whose BSDF is made once", constant});
    if (!plan.scene.needs.alpha) skip("opacity tests", "no material has an opacity below 1");
    if (!plan.scene.needs.normal_maps) skip("normal maps", "no material has one");
    if (!plan.needs_medium_stack)
        skip("medium stack", "what a ray is inside of does not matter: there are no media, and no glass absorbs or "
                             "stands in other glass");
    if (!plan.pixel_footprint) skip("texture footprints", "no material has an image that is filtered");
    if (!plan.camera_needs.lens) skip("lens samples", "the camera has no aperture");
    if (!plan.camera_needs.time) skip("time samples", "nothing moves");
    if (!plan.scene.needs.instances && !plan.camera_needs.time)
        skip("instance transforms", "all objects stand in the world");
    if (!settings.aovs.any()) skip("auxiliary images", "not requested");
    if (!computes_light(settings.integrator)) {
        skip("bounces", "the integrator shows surfaces, not light");
        return list;
    }
    if (plan.environment == nullptr)
        skip("environment", settings.environment ? "it is black" : "left out by the settings");
    if (plan.lights == nullptr && samples_lights(settings.integrator)) {
        if (plan.max_depth == 0)
            skip("light samples", "only emission is requested");
        else if (!plan.prepared.scatters_diffusely)
            skip("light samples", "all materials are mirrors or glass, which they cannot reach");
        else
            skip("light samples", plan.environment != nullptr
                                      ? "only the environment emits, so evenly that rays find it best"
                                      : "nothing emits");
    } else if (plan.lights != nullptr && plan.environment != nullptr && sampled_irradiance(*plan.environment) == 0) {
        skip("light samples of the environment", "it is so even that rays find it best");
    }
    if (!plan.hits_find_light && settings.integrator != Integrator::kUnshadowed)
        skip("last bounce", "rays cannot find the lights: point, spot and sun");
    if (plan.russian_roulette)
        skip("dim paths", message("Russian roulette ends some paths that carry less than ", 1 / kSurvivalFactor,
                                  " of their light, and weights the others up, so that the mean stays"));
    if (settings.integrator == Integrator::kUnshadowed) skip("shadow rays", "the integrator leaves visibility out");
    return list;
}

/// A depth limit of at least this many scatterings, the default of PathTracerSettings::max_depth, is reported as no
/// limit.
constexpr int kUnlimitedDepth = 64;

std::vector<std::string> approximations(const RenderPlan& plan, const PathTracerSettings& settings) {
    std::vector<std::string> list;
    if (settings.integrator == Integrator::kNaive && plan.scene.needs.delta_lights)
        list.emplace_back("point, spot and sun lights are missing: rays that follow the materials cannot find them");
    if (merges(settings.integrator))
        list.emplace_back("photons blur light over a radius that shrinks with every sample");
    if (settings.integrator == Integrator::kWhitted)
        list.emplace_back("lights shine from their centers with their mean radiance, and surfaces do not light each "
                          "other");
    if (settings.integrator == Integrator::kWhitted && plan.scene.needs.interiors)
        list.emplace_back("glass does not absorb, and glass inside glass bends light as in air");
    if (settings.integrator == Integrator::kDirect) list.emplace_back("light arrives after one scattering at most");
    const bool leaves_out_media =
        settings.integrator == Integrator::kUnshadowed || settings.integrator == Integrator::kWhitted;
    if (leaves_out_media && plan.scene.needs.media)
        list.emplace_back("media are left out");
    if (plan.scene.needs.subsurface && !plan.subsurface)
        list.emplace_back("light leaves solids with subsurface scattering where it has entered them");
    if (settings.integrator == Integrator::kUnshadowed)
        list.emplace_back("direct light only, and nothing casts a shadow");
    if (settings.integrator == Integrator::kLights)
        list.emplace_back("only emission, and direct light of lights by diffuse surfaces and rough metal");
    if (settings.integrator == Integrator::kEnvironment)
        list.emplace_back("only what the environment sends to diffuse surfaces");
    if (settings.integrator == Integrator::kReflection)
        list.emplace_back("only what is seen by way of metal and glass");
    if (settings.denoise) list.emplace_back("the denoised image blurs what the samples do not tell from noise");
    const bool whole_paths = settings.integrator == Integrator::kPath || settings.integrator == Integrator::kNaive ||
                             traces_light_paths(settings.integrator) || settings.integrator == Integrator::kReflection;
    if (whole_paths && plan.max_depth < kUnlimitedDepth)
        list.emplace_back(
            message("paths end after ", plan.max_depth, plan.max_depth == 1 ? " scattering" : " scatterings"));
    if (!settings.environment && plan.prepared.environment) list.emplace_back("the environment is left out");
    return list;
}

} // namespace duet::raytrace
