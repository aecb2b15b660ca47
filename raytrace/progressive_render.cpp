#include "raytrace/progressive_render.h"

#include "common/system/error.h"
#include "raytrace/render_state.h"

namespace duet::raytrace {

struct ProgressiveRender::State {
    State(const PathTracerScene& prepared_, const View& view_, const PathTracerSettings& settings_)
        : prepared(prepared_), view(view_), settings(settings_), render(prepared.data(), view, settings) {}

    const PathTracerScene prepared;
    const View view;
    const PathTracerSettings settings;
    RenderState render;
};

ProgressiveRender::ProgressiveRender(const PathTracerScene& prepared, const View& view,
                                     const PathTracerSettings& settings) {
    if (!settings.film.empty() || settings.adaptive || needs_sample_count(settings.sampler))
        throw Error("a progressive render adds samples to all pixels alike, in memory: expected no film, no adaptive "
                    "sampling, and a sampler whose samples do not depend on how many there are");
    state_ = std::make_unique<State>(prepared, view, settings);
}

ProgressiveRender::~ProgressiveRender() = default;

bool ProgressiveRender::add_samples(std::uint32_t samples, Control& control) {
    Film& pixels = state_->render.checkpoint.film();
    if (pixels.complete())
        for (Film::Pixel& pixel : pixels.pixels().pixels()) pixel.target += samples;
    return state_->render.run_pass(control, 0, 1);
}

const Film& ProgressiveRender::film() const { return state_->render.checkpoint.film(); }

} // namespace duet::raytrace
