// Draws the light samples of the paths of a batch.
#pragma once

#include "common/light/solid_angle.h"
#include "raytrace/integrator/light_sampling.h"
#include "raytrace/wavefront/lanes.h"

namespace duet::raytrace::lanes {

/// Draws a light sample for each path of a batch. Choices and samples are copied component by component. If a whole one
/// were copied right after its components were written, the load would stall on store forwarding.
class BatchLightSamples {
public:
    /// `p` holds the points of the paths. Their light receivers must be in the paths' states.
    BatchLightSamples(const RenderPlan& plan, std::span<const BatchPath> paths, const Vec& p) {
        pdf_.values.fill(1);
        for (std::size_t i = 0; i < paths.size(); ++i) {
            const auto choice =
                plan.lights->sample(paths[i].state->previous_vertex.receiver, paths[i].random_samples->light_choice);
            if (!choice) continue;
            chosen_ |= 1u << i;
            choices_[i].index = choice->index;
            choices_[i].probability = choice->probability;
        }
        const unsigned done = plan.scene.needs.emitter_textures ? 0 : sample_quads(plan.scene.lights, paths, p);
        for (const std::size_t i : SetBits(chosen_ & ~done)) {
            if (const auto light = sample_li(plan.scene, *plan.lights, paths[i].state->previous_vertex.receiver,
                                             choices_[i], paths[i].random_samples->light))
                set(i, *light);
        }
    }

    /// Returns a bit mask of the paths that have a light sample.
    unsigned valid() const { return valid_; }
    /// Returns the light sample of path i, which must have one.
    LightLiSample operator[](std::size_t i) const {
        return {{wi_.vec(i), radiance_.rgb(i), pdf_.values[i], delta_.values[i] > 0}, distance_[i], light_[i]};
    }
    /// Returns the light samples, one per lane. Lanes without one have a black sample.
    LightLiSampleT<Floats> lanes() const {
        return {wi_.floats(), radiance_.colors(), pdf_.floats(), delta_.floats() > Floats(0.0f)};
    }

private:
    void set(std::size_t i, const LightLiSample& light) {
        valid_ |= 1u << i;
        wi_.set(i, light.wi);
        radiance_.set(i, light.radiance);
        pdf_.values[i] = light.pdf;
        delta_.values[i] = light.delta ? 1.0f : 0.0f;
        distance_[i] = light.distance;
        light_[i] = light.light;
    }

    // Draws the light samples of all paths whose light is a quad together. Returns a bit mask of these paths.
    unsigned sample_quads(const std::vector<Light>& lights, std::span<const BatchPath> paths, const Vec& p) {
        unsigned quads = 0;
        LaneVectors corner, edge_u, edge_v;
        LaneValues ux, uy, two_sided;
        for (const std::size_t i : SetBits(chosen_)) {
            if (choices_[i].index >= lights.size()) continue;
            const auto* light = std::get_if<SurfaceLight>(&lights[choices_[i].index]);
            const Quad* quad = light != nullptr ? std::get_if<Quad>(&light->shape) : nullptr;
            if (quad == nullptr) continue;
            quads |= 1u << i;
            corner.set(i, quad->corner);
            edge_u.set(i, quad->u);
            edge_v.set(i, quad->v);
            ux.values[i] = paths[i].random_samples->light.x, uy.values[i] = paths[i].random_samples->light.y;
            two_sided.values[i] = light->two_sided ? 1.0f : 0.0f;
        }
        if (quads == 0) return 0;
        const QuadSeen<Doubles> seen(corner.doubles(), edge_u.doubles(), edge_v.doubles(), to_doubles(p));
        const SolidAngleSampleT<Doubles> sample = seen.sample({ux.doubles(), uy.doubles()});
        const auto emits = seen.emits(two_sided.doubles() > Doubles(0.0));
        const LaneVectors wi(sample.wi);
        const LaneValues distances(sample.distance), pdfs(sample.pdf);
        for (const std::size_t i : SetBits(quads & lane_bits(emits & is_usable_pdf(sample.pdf)))) {
            const Rgb radiance = std::get<SurfaceLight>(lights[choices_[i].index]).radiance;
            set(i, light_sample({wi.vec(i), distances.values[i], radiance, pdfs.values[i], false}, choices_[i]));
        }
        return quads;
    }

    unsigned chosen_ = 0, valid_ = 0; // bit masks of paths: with a chosen light, and with a light sample
    std::array<SampledLight, kLanes> choices_;
    LaneVectors wi_, radiance_;
    LaneValues pdf_, delta_;
    std::array<float, kLanes> distance_;
    std::array<std::int64_t, kLanes> light_;
};

} // namespace duet::raytrace::lanes
