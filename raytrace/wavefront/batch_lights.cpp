#include "raytrace/wavefront/batch_lights.h"

#include "common/light/solid_angle.h"

namespace duet::raytrace::lanes {

#if XSIMD_WITH_AVX

BatchLightSamples::BatchLightSamples(const RenderPlan& plan, std::span<const BatchPath> paths, const Vec& p) {
    pdf_.of.fill(1);
    Choices choices;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const auto choice = plan.lights->sample(paths[i].state->departure.receiver, paths[i].numbers->light_choice);
        if (!choice) continue;
        choices.some |= 1u << i;
        choices.index[i] = choice->index;
        choices.probability[i] = choice->probability;
    }
    for (unsigned left = choices.some & ~sample_far_rectangles(plan, paths, p, choices); left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        if (const auto light = sample_arrival(plan.scene, *plan.lights, paths[i].state->departure.receiver, choices[i],
                                              paths[i].numbers->light))
            set(i, *light);
    }
}

void BatchLightSamples::set(std::size_t i, const Arrival& arrival) {
    some_ |= 1u << i;
    wi_.set(i, arrival.wi);
    radiance_.set(i, arrival.radiance);
    pdf_.of[i] = arrival.pdf;
    delta_.of[i] = arrival.delta ? 1.0f : 0.0f;
    distance_[i] = arrival.distance;
    light_[i] = arrival.light;
}

// Samples the lights of the paths whose light is a rectangle that is sampled by area, all together. Returns a bit mask
// of these paths.
unsigned BatchLightSamples::sample_far_rectangles(const RenderPlan& plan, std::span<const BatchPath> paths,
                                                  const Vec& p, const Choices& choices) {
    if (plan.scene.needs.lamp_textures) return 0;
    const auto& lights = plan.scene.lights;
    unsigned rectangles = 0;
    Columns corner, edge_u, edge_v;
    Column ux, uy, two_sided;
    for (unsigned left = choices.some; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        if (choices.index[i] >= lights.size()) continue;
        const auto* light = std::get_if<SurfaceLight>(&lights[choices.index[i]]);
        const Quad* quad = light != nullptr ? std::get_if<Quad>(&light->shape) : nullptr;
        if (quad == nullptr || !is_rectangle(*quad)) continue;
        rectangles |= 1u << i;
        corner.set(i, quad->corner);
        edge_u.set(i, quad->u);
        edge_v.set(i, quad->v);
        ux.of[i] = paths[i].numbers->light.x, uy.of[i] = paths[i].numbers->light.y;
        two_sided.of[i] = light->two_sided ? 1.0f : 0.0f;
    }
    if (rectangles == 0) return 0;
    const QuadSeen<Doubles> seen(corner.doubles(), edge_u.doubles(), edge_v.doubles(), to_doubles(p));
    const unsigned far = rectangles & ~lane_bits(seen.near());
    const SolidAngleSampleT<Doubles> sample = seen.sample({ux.doubles(), uy.doubles()});
    const auto emits = seen.emits(two_sided.doubles() > Doubles(0.0));
    const Columns wi(sample.wi);
    const Column distances(sample.distance), pdfs(sample.pdf);
    for (unsigned left = far & lane_bits(emits & is_usable_pdf(sample.pdf)); left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        const Rgb radiance = std::get<SurfaceLight>(lights[choices.index[i]]).radiance;
        set(i, arrival({wi.vec(i), distances.of[i], radiance, pdfs.of[i], false}, choices[i]));
    }
    return far;
}

#endif

} // namespace duet::raytrace::lanes
