#include "raytrace/integrator/plain_vertices.h"

#include "common/light/area_sampling.h"
#include "common/light/solid_angle.h"
#include "raytrace/integrator/light_sampling.h"
#include "raytrace/integrator/plain_bsdfs.h"
#include "raytrace/integrator/plain_points.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace duet::raytrace {

#if XSIMD_WITH_AVX

using namespace lanes;

namespace {

// `fours` reads consecutive numbers across these members.
static_assert(offsetof(Ray, direction) == 3 * sizeof(float) && offsetof(Ray, t_min) == 6 * sizeof(float));
static_assert(offsetof(PathState, refraction) == offsetof(PathState, throughput) + 3 * sizeof(float));
static_assert(offsetof(VertexNumbers, light) == offsetof(VertexNumbers, bsdf) + 2 * sizeof(float) &&
              offsetof(VertexNumbers, light_choice) == offsetof(VertexNumbers, light) + 2 * sizeof(float) &&
              offsetof(VertexNumbers, lobe) == offsetof(VertexNumbers, light) + 3 * sizeof(float) &&
              offsetof(VertexNumbers, roulette) == offsetof(VertexNumbers, light) + 4 * sizeof(float));

template <typename Points, typename Scattering> class Block {
public:
    Block(const RenderPlan& plan, std::span<PlainPath> paths, const Points& points)
        : plan_(plan), paths_(paths), points_(points), bsdf_(paths), frame_(frame_from_normal(points.ns())) {
        const auto [dx, dy, dz, t_min] =
            fours(paths, [](const PlainPath& path) -> const float& { return path.ray->direction.x; });
        const auto [r, g, b, refraction] =
            fours(paths, [](const PlainPath& path) -> const float& { return path.state->throughput.r; });
        const Vec w = -Vec(dx, dy, dz);
        const Floats side = select(dot(w, points.ng) < Floats(0.0f), Floats(-1.0f), Floats(1.0f));
        wo_ = lifted_above_horizon(frame_.to_local(w), side);
        throughput_ = {r, g, b};
        refraction_ = refraction;
    }

    // Draws light samples as Path::add_light_sample does. Their shadow rays are traced later.
    void add_light_samples(ShadowRays& shadows, RayCounts& counts) {
        Arrivals arrivals;
        receivers();
        std::array<std::optional<LightChoice>, kLanes> choices;
        for (std::size_t i = 0; i < paths_.size(); ++i)
            choices[i] = plan_.lights->sample(paths_[i].state->departure.receiver, paths_[i].numbers->light_choice);
        const unsigned drawn = sample_rectangles(choices, arrivals);
        for (std::size_t i = 0; i < paths_.size(); ++i)
            if (choices[i] && (drawn >> i & 1u) == 0)
                arrivals.set(i, sample_arrival(plan_.scene, *plan_.lights, paths_[i].state->departure.receiver,
                                               *choices[i], paths_[i].numbers->light));
        const Vec wi = arrivals.wi.floats(), local = frame_.to_local(wi);
        const Mask reflected = (wo_.z * local.z > Floats(0.0f)) & (dot(wi, points_.horizon()) * local.z > Floats(0.0f));
        const Color scattered = bsdf_.eval(wo_, local) * abs(local.z) * arrivals.radiance.colors();
        const Floats zero(0.0f);
        unsigned lit = arrivals.some & lane_bits(reflected) & ~lane_bits(is_black_lane(scattered));
        if (lit == 0) return;
        const Floats own = arrivals.pdf.floats(), other = bsdf_.pdf(wo_, local);
        const Floats weight = mis_weight(own, select(arrivals.delta.floats() > zero, zero, other));
        const Color sum = throughput_ * scattered * (weight / own);
        const Columns light(Vec(sum.r, sum.g, sum.b)), origins(points_.origin(wi)), p(points_.p);
        for (; lit != 0; lit &= lit - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(lit));
            ++counts.shadow;
            Ray ray{origins.vec(i), arrivals.all[i].wi};
            ray.time = paths_[i].ray->time;
            shadows.add(paths_[i].index, ray, p.vec(i), arrivals.all[i], light.rgb(i));
        }
    }

    // Does what Path::scatter and Path::survives do. It is flattened, because functions take batches by memory.
    [[gnu::flatten]] void scatter(int depth, RayCounts& counts) {
        const auto [ux, uy, lx, ly] =
            fours(paths_, [](const PlainPath& path) -> const float& { return path.numbers->bsdf.x; });
        const auto [y, choice, lobe, roulette] =
            fours(paths_, [](const PlainPath& path) -> const float& { return path.numbers->light.y; });
        const Floats zero(0.0f), one(1.0f);
        const LaneSample s = bsdf_.sample(wo_, {{ux, uy}, lobe});
        const Vec wi = normalize(frame_.to_world(s.wi));
        Vec horizon = points_.horizon();
        Floats refraction = refraction_;
        if constexpr (Scattering::kThrough) {
            horizon = select(wo_.z * s.wi.z > zero, horizon, points_.ng);
            refraction = select(s.transmitted, refraction * s.refraction, refraction);
        }
        Mask on = s.some & ~is_black_lane(s.weight) & (dot(wi, horizon) * s.wi.z > zero);
        Color throughput = throughput_ * s.weight;
        if (plan_.russian_roulette && depth > 0) {
            const Floats probability = survival(throughput, refraction, Floats(plan_.worth));
            const Mask stays = ~(probability < one), survives = stays | (roulette < probability);
            const unsigned mine = (1u << paths_.size()) - 1;
            counts.ended += std::popcount(lane_bits(on) & ~lane_bits(survives) & mine);
            on = on & survives;
            throughput = throughput * select(stays, one, one / probability);
        }
        const Columns origins(points_.origin(wi)), directions(wi),
            throughputs(Vec(throughput.r, throughput.g, throughput.b));
        const Column pdfs(s.pdf), refractions(refraction);
        const unsigned going = lane_bits(on);
        for (std::size_t i = 0; i < paths_.size(); ++i) {
            PlainPath& path = paths_[i];
            path.goes_on = (going >> i & 1u) != 0;
            if (!path.goes_on) continue;
            ++counts.indirect;
            path.ray->origin = origins.vec(i);
            path.ray->direction = directions.vec(i);
            path.ray->t_min = 0;
            path.state->throughput = throughputs.rgb(i);
            if constexpr (Scattering::kThrough) path.state->refraction = refractions.of[i];
            path.state->departure.pdf = pdfs.of[i];
            path.state->departure.certain = !Scattering::kLit || plan_.lights == nullptr;
        }
    }

private:
    struct Arrivals {
        std::array<Arrival, kLanes> all;
        unsigned some = 0; // bit mask of the paths that have a light sample
        Columns wi, radiance;
        Column pdf, delta;

        Arrivals() { pdf.of.fill(1); }
        void set(std::size_t i, const std::optional<Arrival>& arrival) {
            if (!arrival) return;
            all[i] = *arrival;
            some |= 1u << i;
            wi.set(i, arrival->wi);
            radiance.set(i, arrival->radiance);
            pdf.of[i] = arrival->pdf;
            delta.of[i] = arrival->delta ? 1.0f : 0.0f;
        }
    };

    // Draws the light samples of paths whose light is a rectangle that is not near, because those are sampled by
    // area. The results equal those of sample_arrival. Returns a bit mask of the paths that are done.
    unsigned sample_rectangles(const std::array<std::optional<LightChoice>, kLanes>& choices,
                               Arrivals& arrivals) const {
        if (plan_.scene.needs.lamp_textures) return 0;
        unsigned rectangles = 0;
        Columns corner, edge_u, edge_v;
        Column ux, uy, two_sided;
        for (std::size_t i = 0; i < paths_.size(); ++i) {
            const SurfaceLight* light = choices[i] ? surface_light(*choices[i]) : nullptr;
            const Quad* quad = light != nullptr ? std::get_if<Quad>(&light->shape) : nullptr;
            if (quad == nullptr || !is_rectangle(*quad)) continue;
            rectangles |= 1u << i;
            corner.set(i, quad->corner);
            edge_u.set(i, quad->u);
            edge_v.set(i, quad->v);
            ux.of[i] = paths_[i].numbers->light.x, uy.of[i] = paths_[i].numbers->light.y;
            two_sided.of[i] = light->two_sided ? 1.0f : 0.0f;
        }
        if (rectangles == 0) return 0;
        const Vecd du = edge_u.doubles(), dv = edge_v.doubles(),
                   to_plane = corner.doubles() - Columns(points_.p).doubles();
        const AreaSeen<Doubles> seen{cross(du, dv), to_plane};
        rectangles &= ~lane_bits(seen.near(to_plane + (du + dv) * Doubles(0.5)));
        const Vecd w = to_plane + du * ux.doubles() + dv * uy.doubles();
        const Doubles distance = length(w), pdf = seen.pdf(w), front = -dot(seen.area_vector, to_plane), zero(0.0);
        const auto emits = (front > zero) | ((front < zero) & (two_sided.doubles() > zero));
        const Columns wi(w / distance);
        const Column distances(distance), pdfs(pdf);
        unsigned some = rectangles & lane_bits(emits & (pdf > zero) & (pdf < Doubles(1e38)));
        for (; some != 0; some &= some - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(some));
            const LightChoice& choice = *choices[i];
            arrivals.set(i, Arrival{wi.vec(i), surface_light(choice)->radiance, pdfs.of[i] * choice.probability, false,
                                    distances.of[i], static_cast<std::int64_t>(choice.index)});
        }
        return rectangles;
    }
    const SurfaceLight* surface_light(const LightChoice& choice) const {
        const auto& lights = plan_.scene.lights;
        return choice.index < lights.size() ? std::get_if<SurfaceLight>(&lights[choice.index]) : nullptr;
    }

    // Sets the light receivers of the paths, on the visible side of the surface. Each is also the previous vertex of
    // the next ray, which MIS needs.
    void receivers() {
        const Columns p(points_.p), n(select(wo_.z < Floats(0.0f), -points_.ng, points_.ng));
        // The minimum avoids a GCC 12 warning about an overrun that cannot occur.
        const std::size_t count = std::min(paths_.size(), kLanes);
        for (std::size_t i = 0; i < count; ++i) paths_[i].state->departure.receiver = {p.vec(i), n.vec(i)};
    }

    const RenderPlan& plan_;
    const std::span<PlainPath> paths_;
    const Points points_;
    const Scattering bsdf_;
    const FrameT<Floats> frame_;
    Vec wo_;
    Color throughput_;
    Floats refraction_;
};

template <typename Scattering, typename Points>
void scatter_at(const Points& points, const RenderPlan& plan, std::span<PlainPath> paths, int depth,
                ShadowRays& shadows, RayCounts& counts) {
    Block<Points, Scattering> block(plan, paths, points);
    if constexpr (Scattering::kLit)
        if (plan.lights != nullptr) block.add_light_samples(shadows, counts);
    if (depth + 1 < plan.max_depth || plan.hits_find_light) block.scatter(depth, counts);
}

// Calls `visit` with the type that implements a scattering in lanes.
template <typename Lanes> struct TypeOf {
    using Type = Lanes;
};
template <typename Visit> auto visit_lanes(PlainSurfaces::Scattering scattering, const Visit& visit) {
    switch (scattering) {
    case PlainSurfaces::Scattering::kMetal: return visit(TypeOf<MetalLanes>());
    case PlainSurfaces::Scattering::kMirror: return visit(TypeOf<MirrorLanes>());
    case PlainSurfaces::Scattering::kGlass: return visit(TypeOf<GlassLanes>());
    default: return visit(TypeOf<MattLanes>());
    }
}

} // namespace

NumbersUsed numbers_used(const RenderPlan& plan, PlainSurfaces::Scattering scattering, int depth) {
    return visit_lanes(scattering, [&](auto lanes) {
        using Lanes = typename decltype(lanes)::Type;
        return NumbersUsed{Lanes::kDirection, Lanes::kLit && plan.lights != nullptr, Lanes::kLobe,
                           plan.russian_roulette && depth > 0};
    });
}

void scatter_plain(const RenderPlan& plan, PlainSurfaces::Kind kind, std::span<PlainPath> paths, int depth,
                   ShadowRays& shadows, RayCounts& counts) {
    const auto scatter = [&](const auto& points) {
        visit_lanes(kind.scattering, [&](auto lanes) {
            scatter_at<typename decltype(lanes)::Type>(points, plan, paths, depth, shadows, counts);
        });
    };
    switch (kind.form) {
    case PlainSurfaces::Form::kFlat: return scatter(flat_points(paths));
    case PlainSurfaces::Form::kSmooth: return scatter(smooth_points(paths));
    case PlainSurfaces::Form::kRound: return scatter(round_points(paths));
    }
}

#else // without AVX, RenderPlan::plain has no surfaces

NumbersUsed numbers_used(const RenderPlan&, PlainSurfaces::Scattering, int) { return {}; }
void scatter_plain(const RenderPlan&, PlainSurfaces::Kind, std::span<PlainPath>, int, ShadowRays&, RayCounts&) {}

#endif

} // namespace duet::raytrace
