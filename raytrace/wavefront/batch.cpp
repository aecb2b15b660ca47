#include "raytrace/wavefront/batch.h"

#include "common/vec/simd.h"
#include "raytrace/integrator/path.h"
#if XSIMD_WITH_AVX2
#include "raytrace/wavefront/batch_lights.h"
#include "raytrace/wavefront/batch_points.h"
#endif

#include <algorithm>
#include <cstddef>

namespace duet::raytrace {

namespace {

bool is_specular(BatchedSurfaces::BsdfKind scattering) {
    return scattering == BatchedSurfaces::BsdfKind::kMirror || scattering == BatchedSurfaces::BsdfKind::kGlass;
}

} // namespace

UsedDimensions used_dimensions(const RenderPlan& plan, BatchedSurfaces::BsdfKind scattering, int depth) {
    using Scattering = BatchedSurfaces::BsdfKind;
    const bool rough = !is_specular(scattering);
    return {rough, rough && plan.lights != nullptr,
            scattering == Scattering::kMetal || scattering == Scattering::kGlass, plan.russian_roulette && depth > 0};
}

#if XSIMD_WITH_AVX2 // without AVX2, wavefront.cpp uses no batches

using namespace lanes;

namespace {

// `load_four` reads consecutive floats across these members.
static_assert(offsetof(Ray, direction) == 3 * sizeof(float) && offsetof(Ray, t_min) == 6 * sizeof(float));
static_assert(offsetof(PathThroughputT<float>, refraction) == 3 * sizeof(float));
static_assert(offsetof(VertexRandomSamples, light) == offsetof(VertexRandomSamples, bsdf) + 2 * sizeof(float) &&
              offsetof(VertexRandomSamples, light_choice) == offsetof(VertexRandomSamples, light) + 2 * sizeof(float) &&
              offsetof(VertexRandomSamples, lobe) == offsetof(VertexRandomSamples, light) + 3 * sizeof(float) &&
              offsetof(VertexRandomSamples, roulette) == offsetof(VertexRandomSamples, light) + 4 * sizeof(float));

// Holds the members of a Vertex that the formulas of path.h use, one path per lane.
template <typename BsdfType> struct BatchVertex {
    const SurfaceGeometryT<Floats> point;
    const FrameT<Floats> frame;
    const Vec wo;
    const BsdfType bsdf;

    BatchVertex(std::span<const BatchPath> paths, BatchedSurfaces::Geometry form, const BsdfType& bsdf_)
        : point(surface_points(paths, form)), frame(frame_from_normal(point.ns)),
          wo(direction_to_viewer(frame, point.ng, directions(paths))), bsdf(bsdf_) {}

private:
    static Vec directions(std::span<const BatchPath> paths) {
        const auto [x, y, z, t_min] =
            load_four(paths, [](const BatchPath& path) -> const float& { return path.ray->direction.x; });
        return {x, y, z};
    }
};

// Loads the BSDFs of the paths, which all have the type BsdfT<float>, as arrays of floats.
template <template <typename> typename BsdfT> auto numbers_of_bsdfs(std::span<const BatchPath> paths) {
    // The floats are loaded in rows of four. The last row overlaps the one before, or ends behind a smaller BSDF, but
    // within the variant Bsdf.
    constexpr std::size_t kRow = 4, kNumbers = std::max(sizeof(BsdfT<float>) / sizeof(float), kRow);
    static_assert(kNumbers * sizeof(float) <= sizeof(Bsdf));
    std::array<const float*, kLanes> first;
    for_lanes(paths, [&](std::size_t i, const BatchPath& path) {
        first[i] = reinterpret_cast<const float*>(&std::get<BsdfT<float>>(*path.bsdf));
    });
    std::array<Floats, kNumbers> numbers;
    for (std::size_t done = 0; done < kNumbers; done += kRow) {
        const std::size_t k = std::min(done, kNumbers - kRow);
        const auto row = load_columns<kLanes>([&](std::size_t i) { return first[i] + k; });
        std::copy(row.begin(), row.end(), numbers.begin() + static_cast<std::ptrdiff_t>(k));
    }
    return numbers;
}
DiffuseBsdfT<Floats> diffuse_bsdfs(std::span<const BatchPath> paths) {
    const auto n = numbers_of_bsdfs<DiffuseBsdfT>(paths);
    return {{n[0], n[1], n[2]}};
}
DielectricBsdfT<Floats> dielectric_bsdfs(std::span<const BatchPath> paths) {
    const auto n = numbers_of_bsdfs<DielectricBsdfT>(paths);
    return {n[0], {n[1], n[2], n[3]}};
}
MetalBsdfT<Floats> metal_bsdfs(std::span<const BatchPath> paths) {
    const auto n = numbers_of_bsdfs<MetalBsdfT>(paths);
    return {{n[0], n[1], n[2]}, n[3], {n[4], n[5], n[6]}, {n[7], n[8], n[9]}, {n[10], n[11], n[12]}};
}

template <typename BsdfType> class Batch {
public:
    Batch(const RenderPlan& plan, std::span<BatchPath> paths, BatchedSurfaces::Geometry form, const BsdfType& bsdf)
        : plan_(plan), paths_(paths), vertex_(paths, form, bsdf) {
        const auto [r, g, b, refraction] =
            load_four(paths, [](const BatchPath& path) -> const float& { return path.state->throughput.r; });
        path_ = {{r, g, b}, refraction};
    }

    // Draws a light sample for each path. The shadow rays are traced later.
    void add_light_samples(ShadowRays& shadows, RayCounts& counts) {
        store_receivers();
        const BatchLightSamples samples(plan_, paths_, vertex_.point.p);
        const LightLiSampleT<Floats> light = samples.lanes();
        const Color scattered = light_toward_viewer(vertex_, light);
        unsigned lit = samples.valid() & ~lane_bits(is_black(scattered));
        if (lit == 0) return;
        const Floats weight = light_sample_weight(vertex_, light);
        const LaneVectors found(path_.throughput * scattered * (weight / light.pdf)),
            origins(ray_origins(light.wi, lit)), p(vertex_.point.p);
        for (const std::size_t i : SetBits(lit)) {
            ++counts.shadow;
            const LightLiSample sample = samples[i];
            Ray ray{origins.vec(i), sample.wi};
            ray.time = paths_[i].ray->time;
            shadows.add(paths_[i].index, ray, p.vec(i), sample, found.rgb(i));
        }
    }

    // Replaces the ray of each path that continues. All calls are inlined (flatten), because functions take batches
    // through memory.
    [[gnu::flatten]] void leave(int depth, RayCounts& counts) {
        const VertexRandomSamplesT<Floats> u = random_samples();
        const ScatteringT<Floats> next = scatter(vertex_, u, path_);
        unsigned continuing = lane_bits(next.continues);
        if (plan_.russian_roulette && depth > 0) {
            const unsigned survivors = lane_bits(russian_roulette(u.roulette, path_).survives);
            const unsigned used_lanes = (1u << paths_.size()) - 1;
            counts.ended += std::popcount(continuing & ~survivors & used_lanes);
            continuing &= survivors;
        }
        const LaneVectors origins(ray_origins(next.wi, continuing)), directions(next.wi),
            throughputs(path_.throughput);
        const LaneValues pdfs(next.sample->pdf), refractions(path_.refraction);
        for (std::size_t i = 0; i < paths_.size(); ++i) {
            BatchPath& path = paths_[i];
            path.continues = (continuing >> i & 1u) != 0;
            if (!path.continues) continue;
            ++counts.indirect;
            path.ray->origin = origins.vec(i);
            path.ray->direction = directions.vec(i);
            path.ray->t_min = 0;
            path.state->throughput = throughputs.rgb(i);
            path.state->refraction = refractions.values[i];
            path.state->previous_vertex.pdf = pdfs.values[i];
            path.state->previous_vertex.no_light_sample = next.sample->specular || plan_.lights == nullptr;
        }
    }

private:
    // Returns the origins of rays toward wi for the paths of a bit mask, as ray_origin() does.
    LaneVectors ray_origins(const Vec& wi, unsigned rays) const {
        const SurfaceGeometryT<Floats>& point = vertex_.point;
        LaneVectors origins(offset_origin(point, wi));
        const Floats fraction = terminator_fraction(point, wi);
        const unsigned used_lanes = (1u << paths_.size()) - 1;
        unsigned smooth = lane_bits(fraction > Floats(0.0f)) & used_lanes & rays;
        if (smooth == 0) return origins;
        const LaneVectors p(point.p), p_error(point.p_error), ng(point.ng), offsets(point.terminator_offset * fraction);
        for (const std::size_t i : SetBits(smooth)) {
            SurfaceGeometryT<float> own;
            own.p = p.vec(i), own.p_error = p_error.vec(i), own.ng = ng.vec(i);
            origins.set(i, origin_on_smooth_surface(plan_, own, offsets.vec(i), paths_[i].ray->time));
        }
        return origins;
    }
    VertexRandomSamplesT<Floats> random_samples() const {
        const auto [bsdf_x, bsdf_y, light_x, light_y] =
            load_four(paths_, [](const BatchPath& path) -> const float& { return path.random_samples->bsdf.x; });
        const auto [same_y, choice, lobe, roulette] =
            load_four(paths_, [](const BatchPath& path) -> const float& { return path.random_samples->light.y; });
        return {{bsdf_x, bsdf_y}, {light_x, light_y}, choice, lobe, roulette};
    }

    // Sets the light receivers of the paths. Each is also the previous vertex of the next ray, which MIS needs.
    void store_receivers() {
        const LightReceiverT<Floats> receiver = light_receiver(vertex_);
        const LaneVectors p(receiver.p), n(receiver.n);
        // The minimum avoids a GCC 12 warning about an overrun that cannot occur.
        const std::size_t count = std::min(paths_.size(), kLanes);
        for (std::size_t i = 0; i < count; ++i) paths_[i].state->previous_vertex.receiver = {p.vec(i), n.vec(i)};
    }

    const RenderPlan& plan_;
    const std::span<BatchPath> paths_;
    const BatchVertex<BsdfType> vertex_;
    PathThroughputT<Floats> path_;
};

} // namespace

void advance_batch(const RenderPlan& plan, BatchedSurfaces::Kind kind, std::span<BatchPath> paths, int depth,
                   ShadowRays& shadows, RayCounts& counts) {
    const auto advance = [&](const auto& bsdf) {
        Batch batch(plan, paths, kind.geometry, bsdf);
        if (plan.lights != nullptr && !is_specular(kind.bsdf_kind)) batch.add_light_samples(shadows, counts);
        if (depth + 1 < plan.max_depth || plan.hits_find_light) batch.leave(depth, counts);
    };
    switch (kind.bsdf_kind) {
    case BatchedSurfaces::BsdfKind::kDiffuse:
        return advance(diffuse_bsdfs(paths));
    case BatchedSurfaces::BsdfKind::kMetal:
    case BatchedSurfaces::BsdfKind::kMirror:
        return advance(metal_bsdfs(paths));
    case BatchedSurfaces::BsdfKind::kGlass:
        return advance(dielectric_bsdfs(paths));
    }
}

#endif

} // namespace duet::raytrace
