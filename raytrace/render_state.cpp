#include "raytrace/render_state.h"

#include "common/system/error.h"
#include "raytrace/bidirectional/bidirectional_pass.h"

namespace duet::raytrace {

namespace {

void check(const View& view, const PathTracerSettings& settings) {
    if (view.width < 1 || view.height < 1)
        throw Error(message("image of ", view.width, " x ", view.height, " pixels: expected at least 1 x 1"));
    if (settings.samples_per_pixel < 1)
        throw Error(message(settings.samples_per_pixel, " samples per pixel: expected at least 1"));
    if (settings.denoise && settings.samples_per_pixel < 2)
        throw Error("the denoiser compares samples of a pixel: found 1, expected at least 2 samples per pixel");
    if (!settings.film.empty() &&
        (settings.aovs.depth || settings.aovs.normal || settings.aovs.albedo || settings.aovs.hit))
        throw Error("a film keeps no depth, normal, albedo or hit: expected none of these auxiliary images with it");
    if (settings.first_sample > 0 && needs_sample_count(settings.sampler))
        throw Error(message("samples of the ", sampler_name(settings.sampler),
                            " sampler depend on how many there are, and are not taken in parts: expected another"));
    if (settings.adaptive && (settings.first_sample > 0 || needs_sample_count(settings.sampler)))
        throw Error(
            "adaptive sampling gives pixels different numbers of samples: expected no shard, and a sampler whose "
            "samples do not depend on how many there are");
    if (settings.max_depth < 0 || settings.max_depth > PathTracerSettings::kMostDepth)
        throw Error(message("depth ", settings.max_depth, ": expected 0 to ", PathTracerSettings::kMostDepth));
}

// Returns the view after checking it, for use in an initializer list.
const View& checked(const Scene& scene, const View& view, const PathTracerSettings& settings) {
    check(view, settings);
    if (traces_light_paths(settings.integrator)) check_bidirectional(scene, settings);
    return view;
}

} // namespace

RenderState::RenderState(const PathTracerSceneData& prepared, const View& view_, const PathTracerSettings& settings_)
    : view(checked(prepared.scene, view_, settings_)), settings(settings_), plan(prepared, view, settings),
      checkpoint(plan.scene, view, settings), aovs(plan, view, settings) {}

bool RenderState::run_pass(Control& control, double begin, double end) {
    const PassContext context{plan, view, settings, control, checkpoint, aovs, rays, first_invalid};
    return (traces_light_paths(settings.integrator) ? render_bidirectional_pass : render_pass)(context, begin, end);
}

} // namespace duet::raytrace
